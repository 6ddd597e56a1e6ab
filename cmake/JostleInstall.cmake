# cmake --install gives the program with its manual pages and completions, the libraries with their
# public headers, the scenes, the schema and the documentation, and find_package(jostle). Components,
# which are packages of Debian: jostle, dev, python.
include(CMakePackageConfigHelpers)
get_property(libraries GLOBAL PROPERTY jostle_libraries)

install(TARGETS jostle RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT jostle)
install(DIRECTORY config/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/jostle COMPONENT jostle)
install(FILES ${JOSTLE_SCHEMA} DESTINATION ${CMAKE_INSTALL_DATADIR}/jostle COMPONENT jostle)
install(DIRECTORY ${JOSTLE_MANUAL}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT jostle)
install(FILES ${JOSTLE_MANUAL}/bash/jostle COMPONENT jostle
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
# Debian's zsh looks in one folder for itself and another for packages.
install(FILES ${JOSTLE_MANUAL}/zsh/_jostle COMPONENT zsh
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${JOSTLE_MANUAL}/zsh/_jostle COMPONENT jostle EXCLUDE_FROM_ALL
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT jostle)
install(FILES README.md CITATION.cff report/licences.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT jostle)

install(TARGETS ${libraries} EXPORT jostle ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
include(PublicHeaders)
install(FILES ${JOSTLE_PUBLIC_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/jostle COMPONENT dev)
foreach(header ${JOSTLE_INTERNAL_HEADERS})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/jostle/internal/${folder} COMPONENT dev)
endforeach()
install(EXPORT jostle NAMESPACE jostle:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/jostle
        FILE jostle-targets.cmake COMPONENT dev)
configure_package_config_file(
  cmake/jostle-config.cmake.in ${PROJECT_BINARY_DIR}/jostle-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/jostle)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/jostle-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/jostle-config.cmake
              ${PROJECT_BINARY_DIR}/jostle-config-version.cmake
              cmake/FindVoro.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/jostle COMPONENT dev)

# pip install . makes a wheel of this component and of python/jostle: pyproject.toml.
if(SKBUILD)
  install(TARGETS jostle RUNTIME DESTINATION ${SKBUILD_SCRIPTS_DIR} COMPONENT wheel)
  install(DIRECTORY ${JOSTLE_MANUAL}/man1 DESTINATION ${SKBUILD_DATA_DIR}/share/man COMPONENT wheel)
  install(DIRECTORY config/scenes DESTINATION ${SKBUILD_DATA_DIR}/share/jostle COMPONENT wheel)
  install(FILES ${JOSTLE_SCHEMA} DESTINATION ${SKBUILD_DATA_DIR}/share/jostle COMPONENT wheel)
  install(FILES ${JOSTLE_MANUAL}/bash/jostle COMPONENT wheel
          DESTINATION ${SKBUILD_DATA_DIR}/share/bash-completion/completions)
  install(FILES ${JOSTLE_MANUAL}/zsh/_jostle COMPONENT wheel
          DESTINATION ${SKBUILD_DATA_DIR}/share/zsh/site-functions)
endif()
