# Called by cpack before it packs a package, in CPACK_TEMPORARY_DIRECTORY, one folder
# per component: adds changelogs, compresses them and the manual pages, and gives every file the
# time SOURCE_DATE_EPOCH.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  message(FATAL_ERROR "SOURCE_DATE_EPOCH is not set: ./dev package sets it to the time of the commit")
endif()
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # of SOURCE_DATE_EPOCH
set(packages_of_jostle jostle)
set(packages_of_dev libjostle-dev)
set(packages_of_python python3-jostle)

foreach(component ${CPACK_COMPONENTS_ALL})
  set(name ${packages_of_${component}})
  set(usr ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr)
  set(doc ${usr}/share/doc/${name})
  file(MAKE_DIRECTORY ${doc})
  file(COPY ${CPACK_JOSTLE_SOURCE_DIR}/packages/debian/copyright DESTINATION ${doc}
       FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  file(WRITE ${doc}/changelog.Debian
       "jostle (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
       "  * Packages of jostle ${CPACK_PACKAGE_VERSION}; its changes are in changelog.gz.\n\n"
       " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  file(COPY_FILE ${CPACK_JOSTLE_SOURCE_DIR}/CHANGELOG.md ${doc}/changelog)
  file(GLOB to_compress ${doc}/changelog* ${usr}/share/man/man1/*.1)
  execute_process(COMMAND gzip -9nf ${to_compress} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND chmod -R u=rwX,go=rX ${usr} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND find ${usr} -exec touch -h -d @$ENV{SOURCE_DATE_EPOCH} {} +
                  COMMAND_ERROR_IS_FATAL ANY)
endforeach()
