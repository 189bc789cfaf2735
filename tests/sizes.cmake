# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D ROOT=<source tree> -P sizes.cmake
#
# Fails when a source file is longer than docs/architecture.md allows. Also when there was
# nothing to check. (Functions are clang-tidy's: readability-function-size.)
cmake_minimum_required(VERSION 3.25)

set(LIMIT 400)
set(FOLDERS core capture calib reconstruct retarget recordings live
  dynamics edit engine library app tests benchmarks cmake)
set(KINDS h cpp js mjs ts py cmake css html)

set(checked 0)
set(errors "")
foreach(folder ${FOLDERS})
  list(TRANSFORM KINDS PREPEND ${ROOT}/${folder}/*. OUTPUT_VARIABLE patterns)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${patterns})
  list(FILTER files EXCLUDE REGEX "/node_modules/|^live/viewer/dist")
  foreach(file ${files})
    file(READ ${ROOT}/${file} text)
    string(REGEX REPLACE "[^\n]" "" ends "${text}")
    string(LENGTH "${ends}" length)
    math(EXPR checked "${checked}+1")
    if(length GREATER LIMIT)
      string(APPEND errors "${file}: ${length} lines are more than ${LIMIT}\n")
    endif()
  endforeach()
endforeach()
if(errors OR checked EQUAL 0)
  message(FATAL_ERROR "${errors}files checked: ${checked}")
endif()
message(STATUS "files checked: ${checked}")
