# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0

option(MAREY_UNITY "Compile the sources of a folder in groups" ON)
# clang-tidy reads file by file; the fuzzers compile a choice of files.
if(CMAKE_CXX_CLANG_TIDY OR MAREY_FUZZ)
  set(MAREY_UNITY OFF)
endif()
set(MAREY_UNITY_SIZE 8 CACHE STRING "Sources in one group, about")

# marey_unite(<target> [<source>...])
#
# Compiles the target's sources in groups of about MAREY_UNITY_SIZE, each of one folder:
# most of a file's time goes into headers that its neighbours include too. Names in unnamed
# namespaces must therefore be unique within a folder. Sources with compile options of their
# own are compiled alone. The sources named here are, too: their templates take 10 seconds
# or more (tests/tools/slowest_files.py measures them). Call it after these options are set.
function(marey_unite target)
  if(NOT MAREY_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  get_target_property(here ${target} SOURCE_DIR)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "^(/|\\.\\./)")
  list(SORT sources)
  set(groups)
  foreach(source ${sources})
    get_source_file_property(options ${here}/${source} DIRECTORY ${here} COMPILE_OPTIONS)
    if(options OR source IN_LIST ARGN)
      continue()
    endif()
    get_filename_component(folder "${source}" DIRECTORY)
    string(MAKE_C_IDENTIFIER "folder_${folder}" group)
    list(APPEND groups ${group})
    list(APPEND of_${group} ${source})
  endforeach()
  list(REMOVE_DUPLICATES groups)
  foreach(group ${groups})
    set(size ${MAREY_UNITY_SIZE})
    # A group of one or two costs nearly as much as a full one: up to a quarter of a group
    # is shared out among the others.
    list(LENGTH of_${group} count)
    math(EXPR parts "(${count} + ${size} - 1 - ${size} / 4) / ${size}")
    if(parts LESS 1)
      set(parts 1)
    endif()
    set(index 0)
    foreach(source ${of_${group}})
      math(EXPR part "${index} * ${parts} / ${count}")
      math(EXPR index "${index} + 1")
      set_source_files_properties(${here}/${source} DIRECTORY ${here} PROPERTIES
        UNITY_GROUP "${group}_${part}")
    endforeach()
  endforeach()
  # g++ treats the sources of a group as headers, and warns of classes with a member of an
  # unnamed namespace, which is a fault in headers only.
  target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
