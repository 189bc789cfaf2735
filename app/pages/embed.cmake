# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D OUT=<page.cpp> -D "PARTS=<function>|<file>|... <function>|<file> ..."
#       -P embed.cmake
#
# Writes the definitions of app/pages/report_page.h: functions that return the text of their
# files. The same files give the same bytes.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/../../live/embed_file.cmake)

set(symbols "")
set(functions "")
string(REPLACE " " ";" PARTS "${PARTS}")
foreach(part ${PARTS})
  string(REPLACE "|" ";" files "${part}")
  list(POP_FRONT files function)
  set(symbol marey_embedded_${function})
  embed_file(${symbol} symbols ${files})
  string(APPEND functions
    "\nstd::string_view ${function}() {\n  return {${symbol}, ${symbol}_end};\n}\n")
endforeach()
file(WRITE ${OUT} "#include \"app/pages/report_page.h\"
${symbols}
namespace marey::app {
${functions}
}  // namespace marey::app
")
