# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D ROOT=<source tree> -P packages.cmake
#
# Fails when a CMakeLists.txt asks for a Debian package that ./run does not install. Also
# when there was nothing to check.
cmake_minimum_required(VERSION 3.25)

file(READ ${ROOT}/run text)
if(NOT text MATCHES "BUILD_PACKAGES=\\(([^)]*)\\)")
  message(FATAL_ERROR "run: has no list BUILD_PACKAGES")
endif()
string(REGEX MATCHALL "[^ \t\r\n]+" installed "${CMAKE_MATCH_1}")

set(checked 0)
set(errors "")
file(GLOB lists RELATIVE ${ROOT} ${ROOT}/CMakeLists.txt ${ROOT}/*/CMakeLists.txt
  ${ROOT}/*/*/CMakeLists.txt)
foreach(list ${lists})
  file(STRINGS ${ROOT}/${list} lines REGEX "DEBIAN")
  foreach(line ${lines})
    string(REGEX REPLACE ".*DEBIAN[ \t]+([a-z0-9.+-]+).*" "\\1" package "${line}")
    math(EXPR checked "${checked}+1")
    if(NOT package IN_LIST installed)
      string(APPEND errors "${list}: ${package} is not in BUILD_PACKAGES of ./run\n")
    endif()
  endforeach()
endforeach()
if(errors OR checked EQUAL 0)
  message(FATAL_ERROR "${errors}packages checked: ${checked}")
endif()
message(STATUS "packages checked: ${checked}")
