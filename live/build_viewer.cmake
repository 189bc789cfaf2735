# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0

# Sets viewer_folder, where the served page is, and viewer_files, its files; and for
# app/pages the global properties MAREY_REPORT_PARTS (functions of app/pages/report_page.h,
# each with its files) and MAREY_REPORT_FILES: as npm builds them in live/viewer, or plain
# pages that state that these are left out.
option(MAREY_VIEWER "Build the served page and the reports with npm, and build them in" ON)

set(kinds report calibration markers library_check)
# set_report_parts(PAGES <folder> STYLE <file> ... [SCRIPTS <folder>]): without scripts, all
# kinds have the page report.html.
function(set_report_parts)
  cmake_parse_arguments(R "" "PAGES;SCRIPTS" "STYLE" ${ARGN})
  set(parts "")
  set(files ${R_STYLE})
  foreach(kind ${kinds})
    set(page ${R_PAGES}/${kind}.html)
    set(style ${R_SCRIPTS}/${kind}.css)
    set(script ${R_SCRIPTS}/${kind}.js)
    if(NOT R_SCRIPTS)
      set(page ${R_PAGES}/report.html)
      set(style "")
      set(script "")
    endif()
    if(kind STREQUAL report)
      set(style ${R_STYLE})
    endif()
    list(APPEND files ${page} ${style} ${script})
    foreach(part page style script)
      list(JOIN ${part} "|" joined)
      list(APPEND parts "${kind}_${part}|${joined}")
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES files)
  list(JOIN parts " " parts)
  set_property(GLOBAL PROPERTY MAREY_REPORT_PARTS "${parts}")
  set_property(GLOBAL PROPERTY MAREY_REPORT_FILES "${files}")
endfunction()

set(viewer ${CMAKE_CURRENT_SOURCE_DIR}/viewer)
set(plain_styles colours.css basics.css report.css)
if(NOT MAREY_VIEWER)
  set(viewer_folder ${CMAKE_CURRENT_SOURCE_DIR}/plain)
  set(viewer_files ${viewer_folder}/index.html)
  list(TRANSFORM plain_styles PREPEND ${viewer}/src/styles/)
  set_report_parts(PAGES ${viewer_folder} STYLE ${plain_styles})
  return()
endif()

set(instead "or leave the pages out: cmake -DMAREY_VIEWER=OFF")
find_program(NPM npm)
if(NOT NPM)
  message(FATAL_ERROR
    "npm is missing, which builds the pages. Next: apt-get install nodejs npm; "
    "${instead}.")
endif()

# Node uses only its built-in list of certificate authorities.
set(npm_env)
set(authorities /etc/ssl/certs/ca-certificates.crt)
if(NOT DEFINED ENV{NODE_EXTRA_CA_CERTS} AND EXISTS ${authorities})
  set(npm_env ${CMAKE_COMMAND} -E env NODE_EXTRA_CA_CERTS=${authorities})
endif()

# Installs the packages of package-lock.json once, and again when it changes.
set(lock ${viewer}/package-lock.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${lock})
if(NOT EXISTS ${viewer}/node_modules/.package-lock.json
   OR ${lock} IS_NEWER_THAN ${viewer}/node_modules/.package-lock.json)
  message(STATUS "Fetching the packages of the live page (npm)")
  execute_process(
    COMMAND ${npm_env} ${NPM} ci --no-audit --no-fund --loglevel=error
    WORKING_DIRECTORY ${viewer} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR
      "npm could not fetch the packages of the live page (see above). Next: connect this "
      "machine to a network and configure again; ${instead}.")
  endif()
endif()

file(GLOB_RECURSE viewer_sources CONFIGURE_DEPENDS ${viewer}/src/*)
set(viewer_folder ${viewer}/dist/served)
set(viewer_files index.html icon.svg page.css page.js)
list(TRANSFORM viewer_files PREPEND ${viewer_folder}/)
set_report_parts(PAGES ${viewer}/dist/reports SCRIPTS ${viewer}/dist/reports
  STYLE ${viewer}/dist/reports/report.css)
get_property(report_files GLOBAL PROPERTY MAREY_REPORT_FILES)
add_custom_command(OUTPUT ${viewer_files} ${report_files}
  COMMAND ${npm_env} ${NPM} run --silent build
  DEPENDS ${viewer_sources} ${lock} ${viewer}/package.json ${viewer}/build.mjs
  WORKING_DIRECTORY ${viewer}
  COMMENT "Building the served page and the reports (without npm: -DMAREY_VIEWER=OFF)"
  VERBATIM)
add_custom_target(marey_viewer DEPENDS ${viewer_files} ${report_files})
