# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D OUT=<page.cpp> -D PAGE=<html> -D STYLE=<css> -D SCRIPT=<js|js|...>
#       -D CALIBRATION_PAGE=... -D CALIBRATION_STYLE=... -D CALIBRATION_SCRIPT=...
#       -D MARKERS_PAGE=... -D MARKERS_STYLE=... -D MARKERS_SCRIPT=...
#       -P embed.cmake
#
# Writes the definitions of app/pages/report_page.h. The same files give the same bytes.
cmake_minimum_required(VERSION 3.25)

# Bytes, not string literals: those may be no longer than 65536 characters.
function(add_text function files)
  set(bytes "")
  string(REPLACE "|" ";" files "${files}")
  foreach(file ${files})
    file(READ ${file} hex HEX)
    if(hex STREQUAL "")
      message(FATAL_ERROR "${file}: is empty")
    endif()
    string(APPEND bytes "${hex}")
  endforeach()
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND text
    "\nstd::string_view ${function}() {\n"
    "  static constexpr char kText[] = {\n${bytes}};\n"
    "  return {kText, sizeof(kText)};\n}\n")
  set(text "${text}" PARENT_SCOPE)
endfunction()

set(text "#include \"app/pages/report_page.h\"\n\nnamespace marey::app {\n")
add_text(report_page "${PAGE}")
add_text(report_style "${STYLE}")
add_text(report_script "${SCRIPT}")
add_text(calibration_page "${CALIBRATION_PAGE}")
add_text(calibration_style "${CALIBRATION_STYLE}")
add_text(calibration_script "${CALIBRATION_SCRIPT}")
add_text(markers_page "${MARKERS_PAGE}")
add_text(markers_style "${MARKERS_STYLE}")
add_text(markers_script "${MARKERS_SCRIPT}")
string(APPEND text "\n}  // namespace marey::app\n")
file(WRITE ${OUT} "${text}")
