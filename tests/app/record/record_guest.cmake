# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
# The recorder, with cameras of a real kernel.
#
# As tests/capture/CMakeLists.txt has it for the cameras alone. A static program again, for
# which FFmpeg's, TurboJPEG's and SQLite's static libraries exist, and the codecs' do not.
find_library(MAREY_STATIC_AVFORMAT libavformat.a)
find_library(MAREY_STATIC_AVCODEC libavcodec.a)
find_library(MAREY_STATIC_AVUTIL libavutil.a)
find_library(MAREY_STATIC_SWRESAMPLE libswresample.a)
find_library(MAREY_STATIC_SQLITE libsqlite3.a)
find_library(MAREY_STATIC_TURBOJPEG libturbojpeg.a)
find_library(MAREY_STATIC_Z libz.a)
if(NOT MAREY_SANITIZE AND MAREY_STATIC_AVFORMAT AND MAREY_STATIC_AVCODEC AND
   MAREY_STATIC_AVUTIL AND MAREY_STATIC_SWRESAMPLE AND MAREY_STATIC_SQLITE AND
   MAREY_STATIC_TURBOJPEG AND MAREY_STATIC_Z)
  set(rooms ${PROJECT_SOURCE_DIR})
  add_executable(record_guest
    record/absent_libraries.cpp
    record/record_guest.cpp
    ../support/program/vivid.cpp
    ${rooms}/app/record/camera_recorder.cpp
    ${rooms}/capture/feeds/device_feed.cpp
    ${rooms}/app/record/frame_queue.cpp
    ${rooms}/app/record/record_take.cpp
    ${rooms}/capture/sync/group_frames.cpp
    ${rooms}/core/base/input_file.cpp
    ${rooms}/recordings/takes/jpeg_encoder.cpp
    ${rooms}/recordings/takes/mjpg_video.cpp
    ${rooms}/recordings/base/sqlite.cpp
    ${rooms}/recordings/takes/take_file_read.cpp
    ${rooms}/recordings/takes/take_file_write.cpp
    ${rooms}/recordings/takes/video_times.cpp)
  target_include_directories(record_guest PRIVATE ${PROJECT_SOURCE_DIR})
  target_include_directories(record_guest SYSTEM PRIVATE ${FFmpeg_INCLUDE_DIR})
  target_link_libraries(record_guest PRIVATE marey::v4l2
    ${MAREY_STATIC_AVFORMAT} ${MAREY_STATIC_AVCODEC} ${MAREY_STATIC_SWRESAMPLE}
    ${MAREY_STATIC_AVUTIL} ${MAREY_STATIC_SQLITE} ${MAREY_STATIC_TURBOJPEG}
    ${MAREY_STATIC_Z} m)
  target_link_options(record_guest PRIVATE
    -static -s -fuse-ld=bfd LINKER:--unresolved-symbols=ignore-all,--no-warnings)
  add_test(NAME app/RecordInAMachine
    COMMAND ${PROJECT_SOURCE_DIR}/tests/capture/run_v4l2_guest.sh
            $<TARGET_FILE:record_guest> ${MAREY_GUEST_KERNEL}
            ${CMAKE_CURRENT_BINARY_DIR}/machine)
  set_tests_properties(app/RecordInAMachine PROPERTIES
    SKIP_REGULAR_EXPRESSION "skipped:" TIMEOUT 300 LABELS once)
endif()
