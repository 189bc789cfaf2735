# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D SOURCE=<examples> -D BUILD=<folder> -D INSTALLED=<tree> -D GENERATOR=<name>
#       -D COMPILER=<c++> -P build_examples.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${BUILD})
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD} -G ${GENERATOR}
          -D CMAKE_PREFIX_PATH=${INSTALLED} -D CMAKE_CXX_COMPILER=${COMPILER}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${BUILD} --parallel 2
  COMMAND_ERROR_IS_FATAL ANY)
