# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0

# Sets viewer_folder, where the page is, and viewer_files, what it is made of: the page of
# live/viewer as npm builds it, or the plain one that says that there is none.
option(MAREY_VIEWER "Build the live page with npm, and build it in" ON)

set(viewer ${CMAKE_CURRENT_SOURCE_DIR}/viewer)
if(NOT MAREY_VIEWER)
  set(viewer_folder ${CMAKE_CURRENT_SOURCE_DIR}/plain)
  set(viewer_files ${viewer_folder}/index.html)
  return()
endif()

set(instead "or leave the page out: cmake -DMAREY_VIEWER=OFF")
find_program(NPM npm)
if(NOT NPM)
  message(FATAL_ERROR
    "npm is missing, which builds the live page. Next: apt-get install nodejs npm; "
    "${instead}.")
endif()

# Node knows only its own list of authorities.
set(npm_env)
set(authorities /etc/ssl/certs/ca-certificates.crt)
if(NOT DEFINED ENV{NODE_EXTRA_CA_CERTS} AND EXISTS ${authorities})
  set(npm_env ${CMAKE_COMMAND} -E env NODE_EXTRA_CA_CERTS=${authorities})
endif()

# What package-lock.json names, once, and again when that changes.
set(lock ${viewer}/package-lock.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${lock})
if(NOT EXISTS ${viewer}/node_modules/.package-lock.json
   OR ${lock} IS_NEWER_THAN ${viewer}/node_modules/.package-lock.json)
  message(STATUS "Fetching what the live page is made of (npm)")
  execute_process(
    COMMAND ${npm_env} ${NPM} ci --no-audit --no-fund --loglevel=error
    WORKING_DIRECTORY ${viewer} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR
      "npm could not fetch what the live page is made of (see above). Next: connect this "
      "machine to a network and configure again; ${instead}.")
  endif()
endif()

file(GLOB_RECURSE viewer_sources CONFIGURE_DEPENDS ${viewer}/src/*)
set(viewer_folder ${viewer}/dist)
set(viewer_files ${viewer_folder}/index.html)
add_custom_command(OUTPUT ${viewer_files}
  COMMAND ${npm_env} ${NPM} run --silent build
  DEPENDS ${viewer_sources} ${lock} ${viewer}/package.json ${viewer}/build.mjs
  WORKING_DIRECTORY ${viewer}
  COMMENT "Building the live page (without npm: -DMAREY_VIEWER=OFF)"
  VERBATIM)
