# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# libexif: the target LibExif::exif. It brings no CMake files of its own.
find_path(LibExif_INCLUDE_DIR libexif/exif-data.h)
find_library(LibExif_LIBRARY exif)
mark_as_advanced(LibExif_INCLUDE_DIR LibExif_LIBRARY)
find_file(LibExif_PKG_CONFIG libexif.pc PATH_SUFFIXES pkgconfig
  HINTS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE} /usr/lib NO_CACHE)
if(LibExif_PKG_CONFIG)
  file(STRINGS ${LibExif_PKG_CONFIG} line REGEX "^Version:")
  string(REGEX REPLACE "^Version: *" "" LibExif_VERSION "${line}")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LibExif
  REQUIRED_VARS LibExif_LIBRARY LibExif_INCLUDE_DIR
  VERSION_VAR LibExif_VERSION)
if(LibExif_FOUND AND NOT TARGET LibExif::exif)
  add_library(LibExif::exif UNKNOWN IMPORTED GLOBAL)
  set_target_properties(LibExif::exif PROPERTIES
    IMPORTED_LOCATION ${LibExif_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${LibExif_INCLUDE_DIR})
endif()
