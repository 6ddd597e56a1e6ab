# Cross-builds for 64-bit ARM with Debian's compiler. JOSTLE_SYSROOT is a Debian of that architecture with the
# packages of packages/run.txt and the C++ libraries of packages/test.txt; what is built runs under qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(JOSTLE_SYSROOT "" CACHE PATH "The other architecture's Debian")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES JOSTLE_SYSROOT)
set(CMAKE_SYSROOT ${JOSTLE_SYSROOT})
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L ${JOSTLE_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# HDF5's wrapper of the compiler, which FindHDF5 asks where the library is, belongs to the other architecture.
set(hdf5_libraries ${JOSTLE_SYSROOT}/usr/lib/aarch64-linux-gnu/hdf5/serial)
set(HDF5_C_COMPILER_EXECUTABLE ${CMAKE_BINARY_DIR}/aarch64-h5cc CACHE FILEPATH "HDF5's wrapper")
if(NOT EXISTS ${HDF5_C_COMPILER_EXECUTABLE})
  file(WRITE ${HDF5_C_COMPILER_EXECUTABLE} "#!/bin/sh
set -- aarch64-linux-gnu-gcc \"$@\" --sysroot=${JOSTLE_SYSROOT} -I${JOSTLE_SYSROOT}/usr/include/hdf5/serial \
-L${hdf5_libraries} ${hdf5_libraries}/libhdf5_hl.so ${hdf5_libraries}/libhdf5.so
[ \"$2\" != -show ] || { shift 2; echo aarch64-linux-gnu-gcc \"$@\"; exit; }
exec \"$@\"
")
  file(CHMOD ${HDF5_C_COMPILER_EXECUTABLE} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
endif()
