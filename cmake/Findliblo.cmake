# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# liblo: the target liblo::liblo. It brings no CMake package of its own, and its headers do
# not contain its version.
find_path(liblo_INCLUDE_DIR lo/lo.h)
find_library(liblo_LIBRARY lo)
mark_as_advanced(liblo_INCLUDE_DIR liblo_LIBRARY)
find_file(liblo_PKG_CONFIG liblo.pc PATH_SUFFIXES pkgconfig
  HINTS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE} /usr/lib NO_CACHE)
if(liblo_PKG_CONFIG)
  file(STRINGS ${liblo_PKG_CONFIG} line REGEX "^Version:")
  string(REGEX REPLACE "^Version: *" "" liblo_VERSION "${line}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(liblo
  REQUIRED_VARS liblo_LIBRARY liblo_INCLUDE_DIR
  VERSION_VAR liblo_VERSION)
if(liblo_FOUND AND NOT TARGET liblo::liblo)
  add_library(liblo::liblo UNKNOWN IMPORTED GLOBAL)
  set_target_properties(liblo::liblo PROPERTIES
    IMPORTED_LOCATION ${liblo_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${liblo_INCLUDE_DIR})
endif()
