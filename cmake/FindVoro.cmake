# Finds voro++, which has no CMake package of its own in most distributions: the target voro::voro.
find_path(Voro_INCLUDE_DIR voro++/voro++.hh)
find_library(Voro_LIBRARY voro++)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  Voro REQUIRED_VARS Voro_LIBRARY Voro_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "voro++/voro++.hh and libvoro++ are sought below CMAKE_PREFIX_PATH")
if(Voro_FOUND AND NOT TARGET voro::voro)
  add_library(voro::voro UNKNOWN IMPORTED)
  set_target_properties(voro::voro PROPERTIES IMPORTED_LOCATION ${Voro_LIBRARY}
                                              INTERFACE_INCLUDE_DIRECTORIES ${Voro_INCLUDE_DIR})
endif()
mark_as_advanced(Voro_INCLUDE_DIR Voro_LIBRARY)
