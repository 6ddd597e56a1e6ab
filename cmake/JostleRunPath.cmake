# The installed program finds shared libraries where they were when it was linked: below a prefix of
# Spack, conda or a module system as well. Debian keeps a second name of HDF5 in a folder that the
# linker needs and the program does not: packages must not name it.
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
foreach(library IN LISTS HDF5_C_LIBRARIES HDF5_HL_LIBRARIES HDF5_C_HL_LIBRARIES)
  get_filename_component(folder "${library}" DIRECTORY)
  if(folder MATCHES "^/usr/lib")
    list(APPEND CMAKE_PLATFORM_IMPLICIT_LINK_DIRECTORIES ${folder})
  endif()
endforeach()
list(REMOVE_DUPLICATES CMAKE_PLATFORM_IMPLICIT_LINK_DIRECTORIES)
