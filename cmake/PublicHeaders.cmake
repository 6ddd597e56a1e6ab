# The public headers are those of sdk/jostle: #include <jostle/run.hpp>. What they include, from header to
# header, is installed under jostle/internal and may change in every version.
file(GLOB JOSTLE_PUBLIC_HEADERS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/sdk/jostle/*.hpp)

# jostle_included(RESULT HEADER ...): every header of the project that these include, with the headers that it
# includes; names from the root of the sources.
function(jostle_included result)
  set(waiting ${ARGN})
  set(found)
  while(waiting)
    list(POP_FRONT waiting header)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
    file(STRINGS ${header} lines REGEX "^#include \"")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" name ${line})
      if(NOT name IN_LIST found)
        list(APPEND found ${name})
        list(APPEND waiting ${PROJECT_SOURCE_DIR}/${name})
      endif()
    endforeach()
  endwhile()
  set(${result} ${found} PARENT_SCOPE)
endfunction()
jostle_included(JOSTLE_INTERNAL_HEADERS ${JOSTLE_PUBLIC_HEADERS})
