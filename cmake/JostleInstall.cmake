# cmake --install gives the program, the libraries with their public headers, the scenes and the schema,
# and find_package(jostle).
include(CMakePackageConfigHelpers)
get_property(libraries GLOBAL PROPERTY jostle_libraries)

install(TARGETS ${libraries} EXPORT jostle ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS jostle RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
include(PublicHeaders)
foreach(header ${JOSTLE_PUBLIC_HEADERS})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/jostle/${folder})
endforeach()
install(DIRECTORY config/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/jostle)
install(FILES config/scene.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/jostle)
install(EXPORT jostle NAMESPACE jostle:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/jostle
        FILE jostle-targets.cmake)

configure_package_config_file(
  cmake/jostle-config.cmake.in ${PROJECT_BINARY_DIR}/jostle-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/jostle)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/jostle-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/jostle-config.cmake
              ${PROJECT_BINARY_DIR}/jostle-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/jostle)
