# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D BUILD=<build folder> -D FIRST=<folder> -D MOVED=<folder> -P install_and_move.cmake
#
# Installs to FIRST, then moves the tree to MOVED. Fails if the package names FIRST.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${FIRST} ${MOVED})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${FIRST}
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${FIRST} ${MOVED})
file(GLOB_RECURSE files ${MOVED}/*.cmake ${MOVED}/*.pc)
list(LENGTH files count)
if(count LESS 4)
  message(FATAL_ERROR "${MOVED}: the package is incomplete: ${files}")
endif()
foreach(file ${files})
  file(READ ${file} text)
  string(FIND "${text}" "${FIRST}" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "${file}: names the folder of the installation")
  endif()
endforeach()
