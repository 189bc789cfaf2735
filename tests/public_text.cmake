# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D ROOT=<checkout> -P public_text.cmake
#
# Fails when a file under version control names a place on one person's machine, or a
# source file lacks its two licence lines. Also when there was nothing to check.
cmake_minimum_required(VERSION 3.25)
find_program(GIT git)
if(NOT GIT OR NOT EXISTS ${ROOT}/.git)
  message("skipped: not a git checkout, or git is missing; apt-get install git")
  return()
endif()

# The checkout may belong to another user, as in containers.
set(GIT_HERE ${GIT} -c safe.directory=* -C ${ROOT})

function(files_of out)
  execute_process(COMMAND ${GIT_HERE} ${ARGN}
    OUTPUT_VARIABLE text ERROR_VARIABLE problem RESULT_VARIABLE result)
  # git grep ends with 1 when it finds nothing.
  if(NOT result MATCHES "^[01]$" OR problem)
    message(FATAL_ERROR "git ${ARGN}: ${result} ${problem}")
  endif()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

files_of(tracked ls-files)
string(REGEX MATCHALL "\n" lines "${tracked}")
list(LENGTH lines count)
if(count EQUAL 0)
  message(FATAL_ERROR "${ROOT}: nothing was checked")
endif()

# Brackets, so that this line does not find itself.
files_of(places grep -nIE "(^|[^A-Za-z0-9_.])/([w]ork|[r]oot|[h]ome/[a-z]+|[t]mp/[a-z])")
if(places)
  message(FATAL_ERROR "names a place on one machine:\n${places}")
endif()

foreach(line "SPDX-FileCopyrightText: The marey authors"
             "SPDX-License-Identifier: Apache-2.0")
  files_of(unlicensed grep -L "${line}" --
    *.h *.hpp *.cpp *.py *.mjs *.js *.ts *.css *.html *.sh *.cmake run */run
    CMakeLists.txt tests/*CMakeLists.txt benchmarks/*CMakeLists.txt)
  if(unlicensed)
    message(FATAL_ERROR "lacks the line ${line}:\n${unlicensed}")
  endif()
endforeach()
message(STATUS "files checked: ${count}")
