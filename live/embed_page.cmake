# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D OUT=<page.cpp> -D FOLDER=<folder of the page> -D GZIP=<gzip> -P embed_page.cmake
#
# Writes the definition of live/web/page_embedded.h: every file of the folder, gzipped, under
# its own name, index.html under "/". The same files give the same bytes.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/embed_file.cmake)

set(TYPE_html "text/html; charset=utf-8")
set(TYPE_js "text/javascript; charset=utf-8")
set(TYPE_css "text/css; charset=utf-8")
set(TYPE_svg "image/svg+xml")
set(TYPE_wasm "application/wasm")

file(GLOB names RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT names)
if(NOT "index.html" IN_LIST names)
  message(FATAL_ERROR "${FOLDER}: holds no index.html")
endif()

set(symbols "")
set(entries "")
set(count 0)
foreach(name ${names})
  string(REGEX REPLACE "^.*\\." "" kind "${name}")
  if(NOT DEFINED TYPE_${kind})
    continue()  # Source maps and the like.
  endif()
  # Without a name and a time in its head, gzip's bytes follow from the file's alone.
  set(gz ${OUT}.${count}.gz)
  execute_process(COMMAND ${GZIP} -9 -n -c ${FOLDER}/${name}
    OUTPUT_FILE ${gz} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${FOLDER}/${name}: gzip failed: ${failed}")
  endif()
  file(SHA256 ${gz} hash)
  string(SUBSTRING ${hash} 0 16 hash)
  set(symbol marey_page_${count})
  embed_file(${symbol} symbols ${gz})
  string(REGEX REPLACE "^index\\.html$" "" path "${name}")
  string(APPEND entries "      entry(\"/${path}\", \"${TYPE_${kind}}\", "
    "{${symbol}, ${symbol}_end}, \"\\\"${hash}\\\"\"),\n")
  math(EXPR count "${count}+1")
endforeach()

file(WRITE ${OUT} "#include \"live/web/page_embedded.h\"

#include <string_view>
${symbols}
namespace marey::live {
namespace {

WebContent entry(const char* path,
                 const char* type,
                 std::string_view bytes,
                 const char* etag) {
  return {path, type, std::make_shared<const std::string>(bytes), true, etag};
}

}  // namespace

std::vector<WebContent> embedded_page() {
  return {
${entries}  };
}

}  // namespace marey::live
")
