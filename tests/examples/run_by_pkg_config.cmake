# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D PKG_CONFIG=<program> -D COMPILER=<c++> -D INSTALLED=<tree> -D SOURCE=<example>
#       -D OUT=<program> -D ARGUMENTS=<argument> -D TRUTH=<file> -P run_by_pkg_config.cmake
#
# Compiles an example with the flags of pkg-config, then runs it (run_example.cmake).
cmake_minimum_required(VERSION 3.25)
if(NOT PKG_CONFIG)
  message(FATAL_ERROR "skipped: pkg-config is missing; apt-get install pkgconf")
endif()
file(GLOB_RECURSE package ${INSTALLED}/*/marey.pc)
get_filename_component(folder "${package}" DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${folder})
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs marey
  OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
execute_process(COMMAND ${COMPILER} -std=c++20 ${SOURCE} -o ${OUT} ${flags}
  COMMAND_ERROR_IS_FATAL ANY)
set(EXAMPLE ${OUT})
include(${CMAKE_CURRENT_LIST_DIR}/run_example.cmake)
