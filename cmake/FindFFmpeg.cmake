# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0

# FFmpeg's libraries, which bring no CMake files of their own: FFmpeg::avformat,
# FFmpeg::avcodec, FFmpeg::avutil and FFmpeg::swscale. The version is libavformat's.
find_path(FFmpeg_INCLUDE_DIR libavformat/version.h PATH_SUFFIXES ffmpeg)
set(FFmpeg_LIBRARIES)
foreach(library avformat avcodec avutil swscale)
  find_library(FFmpeg_${library}_LIBRARY ${library})
  list(APPEND FFmpeg_LIBRARIES FFmpeg_${library}_LIBRARY)
  mark_as_advanced(FFmpeg_${library}_LIBRARY)
endforeach()
mark_as_advanced(FFmpeg_INCLUDE_DIR)
if(FFmpeg_INCLUDE_DIR)
  file(GLOB versions ${FFmpeg_INCLUDE_DIR}/libavformat/version*.h)
  foreach(file ${versions})
    file(STRINGS ${file} line REGEX "define +LIBAVFORMAT_VERSION_MAJOR +[0-9]+")
    if(line)
      string(REGEX REPLACE ".*MAJOR +([0-9]+).*" "\\1" FFmpeg_VERSION "${line}")
    endif()
  endforeach()
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(FFmpeg
  REQUIRED_VARS ${FFmpeg_LIBRARIES} FFmpeg_INCLUDE_DIR VERSION_VAR FFmpeg_VERSION)
if(FFmpeg_FOUND)
  foreach(library avformat avcodec avutil swscale)
    if(NOT TARGET FFmpeg::${library})
      add_library(FFmpeg::${library} UNKNOWN IMPORTED GLOBAL)
      set_target_properties(FFmpeg::${library} PROPERTIES
        IMPORTED_LOCATION ${FFmpeg_${library}_LIBRARY}
        INTERFACE_INCLUDE_DIRECTORIES ${FFmpeg_INCLUDE_DIR})
    endif()
  endforeach()
endif()
