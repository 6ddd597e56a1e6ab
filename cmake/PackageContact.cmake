# Included by cpack: whom the packages name as their maintainer, with the address that Debian requires.
# CITATION.cff may state the authors' address. Without one the maintainer is who makes the packages: by
# Debian's variables DEBFULLNAME and DEBEMAIL, else the author of the last commit.
if(CPACK_JOSTLE_ADDRESS)
  set(CPACK_PACKAGE_CONTACT "${CPACK_JOSTLE_AUTHORS} <${CPACK_JOSTLE_ADDRESS}>")
elseif(NOT "$ENV{DEBEMAIL}" STREQUAL "")
  set(maintainer "$ENV{DEBFULLNAME}")
  if(maintainer STREQUAL "")
    set(maintainer "${CPACK_JOSTLE_AUTHORS}")
  endif()
  set(CPACK_PACKAGE_CONTACT "${maintainer} <$ENV{DEBEMAIL}>")
else()
  execute_process(COMMAND git -C ${CPACK_JOSTLE_SOURCE_DIR} log -1 "--format=%an <%ae>"
                  OUTPUT_VARIABLE CPACK_PACKAGE_CONTACT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT CPACK_PACKAGE_CONTACT MATCHES "<.+@.+>$")
  message(FATAL_ERROR "The packages have no maintainer's address: set the environment variable DEBEMAIL, or "
                      "state email: below an author in CITATION.cff")
endif()
