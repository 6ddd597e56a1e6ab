# cmake -D SOURCE=... -D OUTPUT=... -P Revision.cmake, at every build: writes the git revision as a
# source, and touches it only where the revision changed. "unknown" outside a checkout.
cmake_minimum_required(VERSION 3.25)
set(revision "")
find_program(git git)
if(git)
  file(REAL_PATH ${SOURCE} real_source)
  set(git ${git} -c safe.directory=${real_source} -C ${SOURCE})  # also in a clone of another user
  execute_process(
    COMMAND ${git} rev-parse --show-toplevel
    OUTPUT_VARIABLE toplevel OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(toplevel STREQUAL real_source)
    execute_process(
      COMMAND ${git} describe --always --dirty --abbrev=12 --exclude=*
      OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
endif()
if(revision STREQUAL "")
  set(revision unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "study/version.hpp"

namespace jostle::inline study {

const char* git_revision() { return "${revision}"; }

}  // namespace jostle::inline study
]])
