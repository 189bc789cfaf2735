# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D ROOT=<source tree> -P packages.cmake
#
# Fails when a CMakeLists.txt asks for a Debian package that ./run does not install (of
# tests and benchmarks: that ./run test does not install), or for a library without naming
# its package. Also when there was nothing to check.
cmake_minimum_required(VERSION 3.25)

# They come with the compiler, and from this source tree.
set(NEEDS_NO_PACKAGE Threads marey)

file(READ ${ROOT}/run text)
if(NOT text MATCHES "BUILD_PACKAGES=\\(([^)]*)\\)")
  message(FATAL_ERROR "run: has no list BUILD_PACKAGES")
endif()
string(REGEX MATCHALL "[^ \t\r\n]+" installed "${CMAKE_MATCH_1}")
if(NOT text MATCHES "TEST_PACKAGES=\\(([^)]*)\\)")
  message(FATAL_ERROR "run: has no list TEST_PACKAGES")
endif()
string(REGEX MATCHALL "[^ \t\r\n]+" installed_for_tests "${CMAKE_MATCH_1}")

set(checked 0)
set(errors "")
file(GLOB lists RELATIVE ${ROOT} ${ROOT}/CMakeLists.txt ${ROOT}/*/CMakeLists.txt
  ${ROOT}/*/*/CMakeLists.txt ${ROOT}/*/*/*/CMakeLists.txt)
list(FILTER lists EXCLUDE REGEX "^(build|out)/")
foreach(list ${lists})
  file(READ ${ROOT}/${list} text)
  string(REGEX REPLACE "#[^\n]*" "" text "${text}")
  string(REGEX MATCHALL "(marey_)?find_package[ \t]*\\([^)]*\\)" calls "${text}")
  foreach(call ${calls})
    math(EXPR checked "${checked}+1")
    string(REGEX REPLACE "^[a-z_]+[ \t]*\\([ \t\r\n]*([A-Za-z0-9_]+).*" "\\1" library
      "${call}")
    if(library IN_LIST NEEDS_NO_PACKAGE)
      continue()
    elseif(NOT call MATCHES "^marey_find_package.*[ \t\r\n]DEBIAN[ \t\r\n]+([a-z0-9.+-]+)")
      string(APPEND errors
        "${list}: ${library} names no package: use marey_find_package( ... DEBIAN ...)\n")
      continue()
    endif()
    set(package ${CMAKE_MATCH_1})
    if(list MATCHES "^(tests|benchmarks)/" AND package IN_LIST installed_for_tests)
      continue()
    elseif(NOT package IN_LIST installed)
      string(APPEND errors
        "${list}: ${package} is not in BUILD_PACKAGES of ./run\n")
    endif()
  endforeach()
endforeach()
if(errors OR checked EQUAL 0)
  message(FATAL_ERROR "${errors}packages checked: ${checked}")
endif()
message(STATUS "packages checked: ${checked}")
