# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D EXAMPLE=<program> -D ARGUMENTS=<a|b|...> -D TRUTH=<file> -P run_example.cmake
#
# Runs an example. Each line "KEY LOWEST HIGHEST" of TRUTH must have a line "KEY VALUE" of
# its output. Arguments: "@FILE" stands for the arguments in FILE, and "WITH:PROGRAM ..."
# runs another example at the same time.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/check_truth.cmake)

string(REPLACE "|" ";" words "${ARGUMENTS}")
set(arguments)
set(other)
set(list arguments)
get_filename_component(folder ${EXAMPLE} DIRECTORY)
foreach(word ${words})
  if(word MATCHES "^@(.*)")
    file(STRINGS ${CMAKE_MATCH_1} line)
    string(REPLACE "|" ";" word "${line}")
  elseif(word MATCHES "^WITH:(.*)")
    set(list other)
    set(word COMMAND ${folder}/${CMAKE_MATCH_1})
  endif()
  list(APPEND ${list} ${word})
endforeach()
# The output is that of the last command.
execute_process(${other} COMMAND ${EXAMPLE} ${arguments}
  OUTPUT_VARIABLE said RESULTS_VARIABLE results)
foreach(result ${results})
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${EXAMPLE} ended with ${results}: ${said}")
  endif()
endforeach()
check_truth("${said}" ${TRUTH})
