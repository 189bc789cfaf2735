# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D ROOT=<source tree> -P docs.cmake
#
# Fails when README.md, a page of docs/ or a README of samples and test data links to, or
# names, a file of the tree that does not exist; when a source names a page that does not
# exist; when the index "Where is" has fewer than 30 rows. Also when there was nothing to
# check.
cmake_minimum_required(VERSION 3.25)

set(checked 0)
set(errors "")

macro(want path page)
  math(EXPR checked "${checked}+1")
  if(NOT EXISTS "${path}")
    string(APPEND errors "${page}: ${path} is not there\n")
  endif()
endmacro()

# Longer endings first: the first that fits is taken.
set(rooms "core|capture|calib|reconstruct|retarget|recordings|live|dynamics|edit|engine|library|app")
set(endings "html|hpp|h|cpp|cmake|css|json|js|mjs|py|sh|toml|ts|txt|md")

file(GLOB pages ${ROOT}/*.md)
file(GLOB_RECURSE docs ${ROOT}/docs/*.md)
list(APPEND pages ${docs})
file(GLOB_RECURSE notes ${ROOT}/recordings/*.md ${ROOT}/tests/*.md ${ROOT}/benchmarks/*.md)
list(FILTER notes EXCLUDE REGEX "/node_modules/")
foreach(page ${pages} ${notes})
  get_filename_component(folder ${page} DIRECTORY)
  file(READ ${page} text)
  # Brackets and semicolons mean something to CMake's lists.
  string(REPLACE ";" "," text "${text}")
  string(REPLACE "](" "LINK=" text "${text}")
  string(REGEX REPLACE "[][]" " " text "${text}")
  string(REGEX MATCHALL "LINK=[^)#: ]+[)#]" links "${text}")
  list(TRANSFORM links REPLACE "LINK=([^)#]+).*" "\\1")
  foreach(link ${links})
    want(${folder}/${link} ${page})
  endforeach()
  # Sources are named from the top: core/camera.h. A link was looked at above.
  string(REGEX REPLACE "LINK=[^)]*[)]" " " text "${text}")
  string(REGEX MATCHALL
    "(${rooms}|tests|benchmarks|examples|docs|cmake)/[A-Za-z0-9_./-]*[A-Za-z0-9_]\\.(${endings})"
    sources "${text}")
  foreach(source ${sources})
    want(${ROOT}/${source} ${page})
  endforeach()
  # Scripts of the top folder have no ending: ./run.
  string(REGEX MATCHALL "[\n `(][.]/[a-z_]+" scripts "${text}")
  foreach(script ${scripts})
    string(REGEX REPLACE "^.[.]/" "" script "${script}")
    want(${ROOT}/${script} ${page})
  endforeach()
endforeach()

# Pages that comments and messages name.
foreach(room core capture calib reconstruct retarget recordings live dynamics edit engine library app)
  file(GLOB_RECURSE sources ${ROOT}/${room}/*.h ${ROOT}/${room}/*.cpp)
  foreach(source ${sources})
    file(STRINGS ${source} lines REGEX "\\.md\"|docs/")
    string(REGEX MATCHALL "docs/[a-z_/]+\\.md" named "${lines}")
    # The page of a TOML file is an argument of its parser.
    string(REGEX MATCHALL "parse_toml[^\"]+\"[a-z_]+\\.md" parsed "${lines}")
    list(TRANSFORM parsed REPLACE "[^\"]+\"" "docs/formats/")
    foreach(page ${named} ${parsed})
      want(${ROOT}/${page} ${source})
    endforeach()
  endforeach()
endforeach()

# The index of behaviours.
if(EXISTS ${ROOT}/docs/architecture.md)
  file(READ ${ROOT}/docs/architecture.md text)
  string(REGEX REPLACE "[][;]" " " text "${text}")
  string(FIND "${text}" "\n## Where is" begin)
  if(NOT begin EQUAL -1)
    string(SUBSTRING "${text}" ${begin} -1 text)
    string(REGEX REPLACE "^.## Where is" "" text "${text}")
    string(REGEX REPLACE "\n## .*" "" text "${text}")
  else()
    set(text "")
  endif()
  string(REGEX MATCHALL "\n[|] [^\n]*/[^\n]*[|]" rows "${text}")
  list(LENGTH rows count)
  if(count LESS 30)
    string(APPEND errors "docs/architecture.md: \"Where is\" has ${count} rows, fewer than 30\n")
  endif()
endif()

if(errors OR checked EQUAL 0)
  message(FATAL_ERROR "${errors}names checked: ${checked}")
endif()
message(STATUS "names checked: ${checked}")
