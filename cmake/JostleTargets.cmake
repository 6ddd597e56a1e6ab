# Options of every jostle library. Numbers must be the same on every machine: no contraction of
# a * b + c into one rounding, no value-changing optimisation.
add_library(jostle_options INTERFACE)
target_compile_features(jostle_options INTERFACE cxx_std_20)
# -Wshadow for g++ alone: clang also reports a local variable that has the name of another source's constant, and
# sources of a folder are one unit.
# Intel's compiler takes fast mathematics for granted.
target_compile_options(jostle_options INTERFACE -Wall -Wextra -Wpedantic $<$<CXX_COMPILER_ID:GNU>:-Wshadow>
                                                $<$<CXX_COMPILER_ID:IntelLLVM>:-fp-model=precise> -ffp-contract=off)
# Assertions name their sources from the root: the same bytes, whatever folder this is built in. A
# compiler cache may hand paths on as seen from the folder of the build.
file(RELATIVE_PATH root_from_build ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR})
target_compile_options(
  jostle_options INTERFACE $<$<CONFIG:Release>:-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=
                           -fmacro-prefix-map=${root_from_build}=>)
# The trial loop joins conditions with | where a branch would cost.
target_compile_options(jostle_options
                       INTERFACE $<$<CXX_COMPILER_ID:Clang,AppleClang,IntelLLVM>:-Wno-bitwise-instead-of-logical>)
# The twins of intrinsics, and of calls that only Linux has, are then used here as well.
if(JOSTLE_PORTABLE)
  target_compile_definitions(jostle_options INTERFACE JOSTLE_PORTABLE)
endif()
# A compiler that is newer than those that were tried has new warnings: they must not stop a build.
if(JOSTLE_WARNINGS_AS_ERRORS AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 17)
  target_compile_options(jostle_options INTERFACE -Werror)
endif()

# Code that is not performance-critical (scenes, files, commands, text, tests) is compiled with -O1
# where users build: this takes half the time of -O3. Numbers are the same at every level.
add_library(jostle_not_hot INTERFACE)
target_compile_options(jostle_not_hot INTERFACE $<$<CONFIG:Release>:-O1>)

# jostle_precompile(TARGET GROUP [HEADER ...]): what nearly every source includes is parsed once for the
# targets of a group, all compiled alike; the first of them names the headers. Sources name what they
# use all the same: the preset dev and other compilers build without.
function(jostle_precompile target group)
  if(CMAKE_DISABLE_PRECOMPILE_HEADERS OR NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  # GCC forgets that precompiled headers are the system's, and 12 warns of its own strings.
  target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow
                                           -Wno-stringop-overread)
  get_property(first GLOBAL PROPERTY jostle_precompiled_${group})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
    set_property(GLOBAL PROPERTY jostle_precompiled_${group} ${target})
  endif()
endfunction()
set(JOSTLE_COMMON_HEADERS <algorithm> <array> <chrono> <cmath> <functional> <map> <memory> <numeric>
                          <optional> <span> <string> <variant> <vector>)

# jostle_unify(TARGET SOURCES ...): the sources of each folder are compiled as one unit, because most of the
# compilers' time goes into the headers that they share. Generated sources stay apart.
function(jostle_unify target)
  foreach(source ${ARGN})
    if(source MATCHES "^[^/$]")
      get_filename_component(folder ${source} DIRECTORY)
      string(MAKE_C_IDENTIFIER "unit_${folder}" unit)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${unit})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# jostle_sources(TARGET GROUP "SEPARATE" SOURCES ...): compiles the sources of a library, with the precompiled headers of
# a group; those of the list SEPARATE as units of their own.
function(jostle_sources target group separate)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:jostle_options>)
  target_include_directories(
    ${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/sdk>
                     $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                     $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/jostle/internal>)
  if(group STREQUAL not_hot)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:jostle_not_hot>)
    jostle_precompile(${target} not_hot ${JOSTLE_COMMON_HEADERS} <filesystem> <fmt/format.h>)
  elseif(group STREQUAL hot_eigen)
    jostle_precompile(${target} hot_eigen ${JOSTLE_COMMON_HEADERS} <Eigen/Core>)
  else()
    jostle_precompile(${target} hot ${JOSTLE_COMMON_HEADERS})
  endif()
  set(together ${ARGN})
  if(separate)
    list(REMOVE_ITEM together ${separate})
  endif()
  jostle_unify(${target} ${together})
endfunction()

# jostle_library(engine [NOT_HOT] [FIRST_RUN a.cpp ...] SOURCES b.cpp ... [SEPARATE c.cpp ...] PUBLIC jostle_x ...
# PRIVATE ...): one folder, one library, installed as jostle::engine. FIRST_RUN sources are those that running a scene
# needs: they are units of their own, also in jostle_engine_first_run, which is not installed, for the program of a
# first run (cli). Sources of both lists that SEPARATE names too hold the loops that runs spend their time in: each is a
# unit of its own, so that the compiler's limits on inlining see that loop alone. Link only what the arrows allow: engine
# <- structure <- ensemble; config and results use those; study joins them, and cli is its command line.
function(jostle_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "NOT_HOT" "" "FIRST_RUN;SOURCES;SEPARATE;PUBLIC;PRIVATE")
  set(group hot)
  if(arg_NOT_HOT)
    set(group not_hot)
  endif()
  foreach(source ${arg_SEPARATE})
    if(NOT source IN_LIST arg_SOURCES AND NOT source IN_LIST arg_FIRST_RUN)
      message(FATAL_ERROR "jostle_library(${name}): ${source} is SEPARATE, and not among the sources")
    endif()
  endforeach()
  set(all_sources ${arg_SOURCES})
  if(arg_FIRST_RUN)
    set(first_run jostle_${name}_first_run)
    add_library(${first_run} STATIC EXCLUDE_FROM_ALL ${arg_FIRST_RUN})
    foreach(library ${arg_PUBLIC})
      if(TARGET ${library}_first_run)
        set(library ${library}_first_run)
      endif()
      target_link_libraries(${first_run} PUBLIC ${library})
    endforeach()
    target_link_libraries(${first_run} PRIVATE ${arg_PRIVATE})
    jostle_sources(${first_run} ${group} "${arg_SEPARATE}" ${arg_FIRST_RUN})
    list(APPEND all_sources $<TARGET_OBJECTS:${first_run}>)
  endif()
  if(group STREQUAL hot AND (Eigen3::Eigen IN_LIST arg_PUBLIC OR jostle_fitting IN_LIST arg_PUBLIC))
    set(group hot_eigen)
  endif()
  add_library(jostle_${name} STATIC ${all_sources})
  add_library(jostle::${name} ALIAS jostle_${name})
  set_target_properties(jostle_${name} PROPERTIES EXPORT_NAME ${name})
  target_link_libraries(jostle_${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  jostle_sources(jostle_${name} ${group} "${arg_SEPARATE}" ${arg_SOURCES})
  set_property(GLOBAL APPEND PROPERTY jostle_libraries jostle_${name})
endfunction()
