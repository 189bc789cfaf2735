# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0

option(MAREY_UNITY "Compile the sources of a folder in groups" ON)
# clang-tidy reads file by file; the fuzzers compile a choice of files.
if(CMAKE_CXX_CLANG_TIDY OR MAREY_FUZZ)
  set(MAREY_UNITY OFF)
endif()
set(MAREY_UNITY_SIZE 8 CACHE STRING "Sources in one group, at most")

# marey_unite(<target> [<source>...])
#
# Compiles the target's sources in groups of at most MAREY_UNITY_SIZE, each of one folder:
# most of a file's time goes into headers that its neighbours include too. Names in unnamed
# namespaces must therefore be unique within a folder. Sources with compile options of
# their own stay alone; so do the sources named here, whose templates take 10 seconds or
# more (tests/tools/slowest_files.py measures them). Call it after these options are set.
function(marey_unite target)
  if(NOT MAREY_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  get_target_property(here ${target} SOURCE_DIR)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "^(/|\\.\\./)")
  list(SORT sources)
  foreach(source ${sources})
    get_source_file_property(options ${here}/${source} DIRECTORY ${here} COMPILE_OPTIONS)
    if(options OR source IN_LIST ARGN)
      continue()
    endif()
    get_filename_component(folder "${source}" DIRECTORY)
    string(MAKE_C_IDENTIFIER "folder_${folder}" group)
    if(NOT DEFINED count_${group})
      set(count_${group} 0)
    endif()
    math(EXPR number "${count_${group}} / ${MAREY_UNITY_SIZE}")
    math(EXPR count_${group} "${count_${group}} + 1")
    set_source_files_properties(${here}/${source} DIRECTORY ${here} PROPERTIES
      UNITY_GROUP "${group}_${number}")
  endforeach()
  # A class that has a member of an unnamed namespace is suspicious in a header only; g++
  # takes the united sources for headers.
  target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
