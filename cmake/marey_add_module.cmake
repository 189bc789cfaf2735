# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0

include(${CMAKE_CURRENT_LIST_DIR}/marey_install.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/marey_precompile.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/marey_unity.cmake)

# marey_add_module(<name> HEADERS ... SOURCES ... [USES public...] [HIDES private...]
#                  [READS private...] [PRECOMPILES header...] [ALONE source...])
#
# Adds one room. HEADERS are public: each must compile alone (the target
# all_verify_interface_header_sets checks it) and include no heavy library
# (tests/layering.cmake). USES are libraries of the public headers; HIDES are libraries of
# the .cpp files and the private headers only. READS are private header-only libraries: a
# program that links the installed room does not need them. PRECOMPILES: see
# marey_precompile(); ALONE: see marey_unite(). The room is installed
# (cmake/marey_install.cmake).
function(marey_add_module name)
  cmake_parse_arguments(M "" "" "HEADERS;SOURCES;USES;HIDES;READS;PRECOMPILES;ALONE" ${ARGN})
  add_library(marey_${name} STATIC ${M_SOURCES})
  add_library(marey::${name} ALIAS marey_${name})
  target_sources(marey_${name} PUBLIC
    FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${M_HEADERS})
  target_link_libraries(marey_${name} PUBLIC ${M_USES} PRIVATE ${M_HIDES})
  list(TRANSFORM M_READS REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
  target_link_libraries(marey_${name} PRIVATE ${M_READS})
  set_target_properties(marey_${name} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON
                                                   EXPORT_NAME ${name})
  marey_install_module(marey_${name})
  marey_precompile(marey_${name} ${M_PRECOMPILES})
  marey_unite(marey_${name} ${M_ALONE})
endfunction()

# marey_find_package(<package> <version> DEBIAN <package that brings it> [COMPONENTS ...])
#
# Calls find_package() and, if the package is missing, fails with the next step.
macro(marey_find_package package version)
  cmake_parse_arguments(MAREY_FIND "" "DEBIAN" "COMPONENTS" ${ARGN})
  find_package(${package} ${version} QUIET COMPONENTS ${MAREY_FIND_COMPONENTS})
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR
      "${package} ${version} is missing or incomplete. Next: apt-get install "
      "${MAREY_FIND_DEBIAN}; or ./run setup, which installs all that building needs.")
  endif()
endmacro()
