# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D NM=<nm> -D OBJECTS=<objects> -D KERNEL=<file> -D ARCHITECTURE=<xsimd's> \
#       -P lane_symbols.cmake
#
# A kernel for wide vectors contains instructions that not every processor has. An inline
# function exists once in a program: if another object defines it, too, the linker may keep
# the kernel's copy, which then runs on every processor. Therefore the name of each function
# of the kernel must contain its architecture, except the function that creates the kernel.
cmake_minimum_required(VERSION 3.25)

list(FILTER OBJECTS INCLUDE REGEX "/${KERNEL}\\.[a-z.]*o(bj)?$")
list(LENGTH OBJECTS count)
if(NOT count EQUAL 1)
  message(FATAL_ERROR "${KERNEL}: ${count} objects of that name, not one")
endif()
execute_process(COMMAND ${NM} --demangle --defined-only ${OBJECTS}
  OUTPUT_VARIABLE table COMMAND_ERROR_IS_FATAL ANY)
# Square brackets would join a list's elements.
string(REGEX REPLACE "[][;]" "_" table "${table}")
string(REPLACE "\n" ";" table "${table}")

set(own 0)
set(strays "")
foreach(line IN LISTS table)
  # Functions that other objects see or may replace; data carries no instructions.
  if(NOT line MATCHES "^[0-9a-f]+ [TWui] (.*)$")
    continue()
  endif()
  set(name "${CMAKE_MATCH_1}")
  if(name MATCHES "xsimd::${ARCHITECTURE}[^0-9a-z_]")
    math(EXPR own "${own}+1")
  elseif(NOT name MATCHES "^marey::[a-z]+::make_[a-z_]+_kernel\\(")
    string(APPEND strays "  ${name}\n")
  endif()
endforeach()

if(strays)
  message(FATAL_ERROR "${KERNEL}: code of ${ARCHITECTURE} under names that are not its "
    "own; the linker may use it for every processor:\n${strays}"
    "Next: make it a template of the lanes' type, or move it out of the kernel")
endif()
if(own EQUAL 0)
  message(FATAL_ERROR "${KERNEL}: no function of ${ARCHITECTURE} was found")
endif()
message(STATUS "functions of ${KERNEL}'s own: ${own}")
