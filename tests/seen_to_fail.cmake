# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D CASE=<name> -D SOURCE=<checkout> -D WORK=<scratch folder> -P seen_to_fail.cmake
#
# Checks the guards: each case builds a small source tree without faults, expects its guard
# to pass, plants one fault and expects the guard to fail with the message for that fault.
# tests/CMakeLists.txt registers every case below as a test.
cmake_minimum_required(VERSION 3.25)

set(tree ${WORK}/${CASE})
set(licence "SPDX-FileCopyrightText: The marey authors"
  "SPDX-License-Identifier: Apache-2.0")

function(source file text)
  list(JOIN licence "\n// " lines)
  file(WRITE ${tree}/${file} "// ${lines}\n${text}\n")
endfunction()

function(script file text)
  list(JOIN licence "\n# " lines)
  file(WRITE ${tree}/${file} "# ${lines}\n${text}\n")
endfunction()

function(build_sound_tree)
  file(REMOVE_RECURSE ${tree})
  source(core/point.h "#pragma once
#include <vector>
/// Points of one frame.
struct Cloud { std::vector<double> points; };")
  source(core/point.cpp "#include \"core/point.h\"")
  source(calib/place.h "#include \"core/point.h\"")
  source(calib/residuals.h "#include <ceres/ceres.h>")
  source(calib/place.cpp "#include \"calib/place.h\"\n#include \"calib/residuals.h\"
// Reads one camera only.\nconst char* message = \"the file has no cameras\";")
  source(calib/rig/solve.h "#pragma once")
  source(calib/rig/solve.cpp "#include \"calib/place.h\"\n#include \"calib/rig/solve.h\"")
  source(retarget/motion.h "#pragma once")
  source(retarget/solver.h "#pragma once")
  source(retarget/motion.cpp "#include \"retarget/motion.h\"")
  source(dynamics/body.h "#pragma once")
  source(dynamics/state.h "#pragma once")
  source(dynamics/body.cpp "#include \"dynamics/body.h\"\n#include \"core/point.h\"")
  source(engine/play.h "#include \"retarget/motion.h\"")
  source(engine/play.cpp "#include \"engine/play.h\"\n#include \"dynamics/body.h\"")
  source(library/index.h "#include \"retarget/motion.h\"")
  source(library/index.cpp "#include \"library/index.h\"")
  script(tests/folder_layers.cmake
    "set(core_LAYERS .)\nset(calib_LAYERS . rig)\nset(retarget_LAYERS .)
set(dynamics_LAYERS .)\nset(engine_LAYERS .)\nset(library_LAYERS .)
set(app_LAYERS report)")
  source(app/report/page.cpp "#include \"calib/place.h\"\n#include \"engine/play.h\"")
  source(tests/support/scene.h "#include \"core/point.h\"")
  source(tests/library/index_test.cpp "#include \"library/index.h\"
#include \"retarget/motion.h\"")
  source(tests/calib/place_test.cpp "#include <gtest/gtest.h>
#include \"calib/place.h\"
#include \"tests/support/scene.h\"
TEST(Place, RejectsAnEmptyFile) { EXPECT_TRUE(true) << \"the file has no cameras\"; }")
  source(tests/calib/more_test.cpp "#include \"calib/place.h\"")
  source(examples/place.cpp "#include \"calib/place.h\"")
  script(CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(tree LANGUAGES CXX)
set(CMAKE_CXX_STANDARD 20)
include(\${HELPERS}/marey_add_module.cmake)
marey_find_package(glm 0.9 DEBIAN libglm-dev)
if(EXISTS \${PROJECT_SOURCE_DIR}/core)
  add_subdirectory(core)
endif()")
  script(core/CMakeLists.txt
    "# Points and cameras.\nmarey_add_module(core HEADERS point.h SOURCES point.cpp)")
  script(calib/CMakeLists.txt
    "marey_add_module(calib HEADERS place.h SOURCES place.cpp USES marey::core)")
  script(retarget/CMakeLists.txt
    "marey_add_module(retarget HEADERS motion.h SOURCES motion.cpp)")
  script(dynamics/CMakeLists.txt
    "marey_add_module(dynamics HEADERS body.h SOURCES body.cpp)")
  script(engine/CMakeLists.txt
    "marey_add_module(engine HEADERS play.h SOURCES play.cpp)")
  script(library/CMakeLists.txt
    "marey_add_module(library HEADERS index.h SOURCES index.cpp)")
  script(app/CMakeLists.txt "add_executable(tree report/page.cpp)")
  file(WRITE ${tree}/README.md "see [the app](app/report/page.cpp#there), core/point.h\n")
  script(run "readonly BUILD_PACKAGES=(\n  cmake libglm-dev)
readonly TEST_PACKAGES=(\n  make)")
endfunction()

# Each guard, run on the small tree as ctest runs it on the real tree.
function(run_script script out_result out_text)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -D ROOT=${tree} ${ARGN} -P ${SOURCE}/tests/${script}
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  # Messages are wrapped and indented.
  string(REGEX REPLACE "[ \n]+" " " text "${text}")
  set(${out_result} ${result} PARENT_SCOPE)
  set(${out_text} "${text}" PARENT_SCOPE)
endfunction()

macro(layering out_result out_text)
  run_script(layering.cmake ${out_result} ${out_text})
endmacro()

macro(docs out_result out_text)
  run_script(docs.cmake ${out_result} ${out_text})
endmacro()

macro(packages out_result out_text)
  run_script(packages.cmake ${out_result} ${out_text})
endmacro()

macro(sizes out_result out_text)
  run_script(sizes.cmake ${out_result} ${out_text})
endmacro()

macro(folders out_result out_text)
  run_script(folders.cmake ${out_result} ${out_text})
endmacro()

macro(folders_of_two out_result out_text)
  run_script(folders.cmake ${out_result} ${out_text} -D MAX_MODULES=2)
endmacro()

macro(public_text out_result out_text)
  set(git git -c safe.directory=* -C ${tree})
  execute_process(COMMAND ${git} init -q COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${git} add -A COMMAND_ERROR_IS_FATAL ANY)
  run_script(public_text.cmake ${out_result} ${out_text})
endmacro()

function(language out_result out_text)
  find_program(PYTHON3 python3)
  if(NOT PYTHON3)
    message(FATAL_ERROR "skipped: python3 is missing; apt-get install python3")
  endif()
  # Only here, as other guards expect more files of a room.
  if(NOT EXISTS ${tree}/live)
    source(live/viewer/src/pages/page.ts "show('The recording has no frames.');")
  endif()
  set(kinds headers sources messages pages docs scripts tests test_messages)
  list(JOIN kinds " 0\n" ceilings)
  file(WRITE ${tree}/ceilings.txt "${ceilings} 0\n")
  execute_process(
    COMMAND ${PYTHON3} ${SOURCE}/tests/language_scan.py ${tree} --check ${tree}/ceilings.txt
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  set(${out_result} ${result} PARENT_SCOPE)
  set(${out_text} "${text}" PARENT_SCOPE)
endfunction()

# The same helper and the same script as the project's.
function(headers_stand_alone out_result out_text)
  find_program(PYTHON3 python3)
  if(NOT PYTHON3)
    message(FATAL_ERROR "skipped: python3 is missing; apt-get install python3")
  endif()
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${tree} -B ${tree}/build -D HELPERS=${SOURCE}/cmake
            -D CMAKE_EXPORT_COMPILE_COMMANDS=ON
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  execute_process(
    COMMAND ${PYTHON3} ${SOURCE}/tests/headers_stand_alone.py ${tree}/build
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  set(${out_result} ${result} PARENT_SCOPE)
  set(${out_text} "${text}" PARENT_SCOPE)
endfunction()

# clang-tidy as the preset tidy has it.
function(tidy out_result out_text)
  find_program(CLANG_TIDY clang-tidy)
  if(NOT CLANG_TIDY)
    message(FATAL_ERROR "skipped: clang-tidy is missing; apt-get install clang-tidy")
  endif()
  execute_process(
    COMMAND ${CLANG_TIDY} --quiet --config-file=${SOURCE}/.clang-tidy
            ${tree}/core/point.cpp -- -std=c++20 -I${tree}
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_QUIET)
  set(${out_result} ${result} PARENT_SCOPE)
  set(${out_text} "${text}" PARENT_SCOPE)
endfunction()

# fault(<name> <guard> <file> <what is planted at its end> <what the guard must say>)
set(slash "/")
function(fault name guard file planted says)
  if(NOT name STREQUAL CASE)
    return()
  endif()
  build_sound_tree()
  cmake_language(CALL ${guard} result text)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "the guard fails before anything is planted: ${text}")
  endif()
  file(APPEND ${tree}/${file} "${planted}\n")
  cmake_language(CALL ${guard} result text)
  if(result EQUAL 0 OR NOT text MATCHES "${says}")
    message(FATAL_ERROR "the guard does not say \"${says}\": ${result} ${text}")
  endif()
  set(seen TRUE PARENT_SCOPE)
endfunction()

# emptied(<name> <guard> <files to take away> <what the guard must say>)
function(emptied name guard files says)
  if(NOT name STREQUAL CASE)
    return()
  endif()
  build_sound_tree()
  file(GLOB taken ${files})
  file(REMOVE_RECURSE ${taken})
  cmake_language(CALL ${guard} result text)
  if(result EQUAL 0 OR NOT text MATCHES "${says}")
    message(FATAL_ERROR "the guard does not say \"${says}\": ${result} ${text}")
  endif()
  set(seen TRUE PARENT_SCOPE)
endfunction()

set(seen FALSE)
fault(a_stage_that_includes_a_stage layering calib/place.cpp
  "#include \"capture/frame.h\"" "calib may not include capture")
fault(a_core_that_includes_a_stage layering core/point.cpp
  "#include \"calib/place.h\"" "core may not include calib")
fault(a_stage_that_includes_the_app layering calib/place.cpp
  "#include \"app/page.h\"" "calib may not include app")
fault(a_stage_that_includes_the_second_ring layering calib/place.cpp
  "#include \"engine/play.h\"" "calib may not include engine")
fault(a_core_that_includes_the_second_ring layering core/point.cpp
  "#include \"engine/play.h\"" "core may not include engine")
fault(a_second_ring_outside_its_table layering library/index.cpp
  "#include \"dynamics/body.h\"" "library may not include dynamics")
fault(a_second_ring_that_includes_another_stage layering engine/play.cpp
  "#include \"calib/place.h\"" "engine may not include calib")
fault(a_second_ring_that_includes_the_app layering engine/play.cpp
  "#include \"app/page.h\"" "engine may not include app")
fault(a_second_ring_that_includes_a_private_header layering engine/play.cpp
  "#include \"retarget/solver.h\"" "engine may not include the private retarget/solver.h")
fault(a_second_ring_that_includes_its_like_privately layering engine/play.cpp
  "#include \"dynamics/state.h\"" "engine may not include the private dynamics/state.h")
fault(tests_of_the_second_ring_outside_its_table layering tests/library/index_test.cpp
  "#include \"dynamics/body.h\"" "tests/library may not include dynamics/body.h")
fault(a_second_ring_without_layers folders edit/pose/pose.h
  "#pragma once" "the folder pose is missing in edit_LAYERS")
fault(a_subfolder_that_reaches_out layering app/report/page.cpp
  "#include \"../secret.h\"" "is not written from the top")
fault(a_heavy_library_in_a_public_header layering calib/place.h
  "#include <opencv2/core.hpp>" "heavy and may not be in a public header")
fault(a_private_header_in_a_public_one layering calib/place.h
  "#include \"calib/residuals.h\"" "may not include the private calib/residuals.h")
fault(a_core_that_uses_more_than_glm layering core/point.cpp
  "#include <Eigen/Dense>" "core may not use <Eigen/Dense>")
fault(a_room_that_is_not_listed layering utils/misc.h
  "#pragma once" "utils/: it has C.. files, but is none of the rooms")
fault(a_header_under_another_name layering core/point.hpp
  "#include <Eigen/Dense>" "core/point.hpp: files of this kind may not be here")
fault(a_script_of_the_page_beside_its_sources layering live/viewer/point.ts
  "let point" "live/viewer/point.ts: files of this kind may not be here")
fault(a_script_in_a_room layering core/point.js
  "let point" "core/point.js: files of this kind may not be here")
fault(an_include_in_disguise layering calib/place.cpp
  "#include CAPTURE_HEADER" "calib/place.cpp: the name of this include cannot be read")
fault(a_test_that_includes_another_room layering tests/calib/place_test.cpp
  "#include \"capture/frame.h\"" "tests/calib may not include capture/frame.h")
fault(a_test_that_includes_another_rooms_tests layering tests/calib/place_test.cpp
  "#include \"tests/capture/artist.h\"" "tests/calib may not include tests/capture")
fault(a_shared_scene_that_includes_a_room layering tests/support/scene.h
  "#include \"calib/place.h\"" "tests/support may not include calib/place.h")
fault(a_benchmark_that_includes_tests_of_the_app layering benchmarks/frames.cpp
  "#include \"tests/app/page.h\"" "benchmarks may not include tests/app/page.h")
fault(an_example_that_includes_a_private_header layering examples/place.cpp
  "#include \"calib/residuals.h\"" "calib/residuals.h. is not a public header")
fault(a_folder_that_includes_the_one_above folders calib/place.cpp
  "#include \"calib/rig/solve.h\"" "the folder . may not include calib/rig/solve.h")
fault(a_folder_of_too_many_modules folders_of_two calib/third.h
  "#pragma once" "calib/.: 3 modules are more than 2")
fault(a_test_folder_of_too_many_modules folders_of_two tests/calib/third_test.cpp
  "// Two others stand here: place_test.cpp and more_test.cpp."
  "tests/calib: 3 modules are more than 2")
fault(a_folder_without_a_layer folders calib/plan/plan.h
  "#pragma once" "the folder plan is missing in calib_LAYERS")
fault(modules_that_include_each_other folders calib/residuals.h
  "#include \"calib/place.h\"" "cycle of modules: calib/[a-z]+ -> calib/[a-z]+ -> calib")
fault(a_header_that_does_not_exist folders calib/place.cpp
  "#include \"calib/gone.h\"" "calib/gone.h does not exist")
fault(tests_of_no_room layering tests/utils/misc_test.cpp
  "#include \"core/point.h\"" "tests/utils/: it tests none of the rooms")
fault(a_room_without_public_headers layering live/CMakeLists.txt
  "add_library(live live.cpp)" "live/CMakeLists.txt: no HEADERS found")
fault(a_machine_path public_text README.md
  "see ${slash}home/me/video.mp4" "names a place on one machine")
fault(a_source_without_a_licence public_text core/bare.h
  "#pragma once" "lacks the line SPDX-FileCopyrightText.*core/bare.h")
fault(a_source_with_half_a_licence public_text core/half.h
  "// SPDX-FileCopyrightText: The marey authors" "SPDX-License-Identifier.*core/half.h")
fault(a_list_without_a_licence public_text tests/core/CMakeLists.txt
  "marey_add_tests(core)" "lacks the line SPDX.*tests/core/CMakeLists.txt")
fault(a_script_without_a_licence public_text cmake/bare.cmake
  "set(bare TRUE)" "lacks the line SPDX.*cmake/bare.cmake")
fault(a_page_without_a_licence public_text app/report/page.html
  "<p>" "lacks the line SPDX.*app/report/page.html")
fault(a_header_that_needs_another headers_stand_alone core/point.h
  "inline std::string name;" "point.h does not compile alone.*string")
# The precompiled set of the first include must not bring what the header forgets.
fault(a_header_that_forgets_one_of_its_headers headers_stand_alone core/point.h
  "#include <string>\n#include <vector>\ninline std::optional<std::string> name;"
  "point.h does not compile alone.*optional")
fault(an_installer_that_forgets_a_package packages calib/CMakeLists.txt
  "marey_find_package(Ceres 2.1 DEBIAN libceres-dev)" "libceres-dev is not in")
fault(a_library_without_a_package packages tests/calib/CMakeLists.txt
  "find_package(Ceres 2.1 REQUIRED)" "tests/calib/CMakeLists.txt: Ceres names no package")
fault(a_link_that_leads_nowhere docs README.md
  "see [there](docs/there.md)" "docs/there.md is not there")
fault(a_page_that_names_a_lost_file docs README.md
  "see core/gone.h" "core/gone.h is not there")
fault(a_page_that_names_a_lost_number docs docs/page.md
  "see capture/mp4_gone.h" "capture/mp4_gone.h is not there")
fault(a_page_that_names_a_lost_script docs README.md
  "see app/report/gone.js" "app/report/gone.js is not there")
fault(a_page_that_names_a_lost_shell_script docs README.md
  "see tests/gone.sh" "tests/gone.sh is not there")
fault(a_page_that_names_a_lost_script_without_ending docs README.md
  "call `./gone demo`" "gone is not there")
fault(a_page_that_names_a_lost_module docs README.md
  "see live/viewer/gone.ts" "live/viewer/gone.ts is not there")
fault(a_message_that_names_a_lost_page docs core/point.cpp
  "// docs/gone.md describes it." "docs/gone.md is not there")
fault(an_index_of_few_behaviours docs docs/architecture.md
  "\n## Where is ...\n\n| points | core/point.h |\n" "has 1 rows, fewer than 30")
fault(a_note_that_names_a_lost_file docs recordings/samples/README.md
  "see recordings/gone.cpp" "recordings/gone.cpp is not there")
string(REPEAT "// One line of many.\n" 400 many_lines)
fault(a_file_without_end sizes core/point.cpp
  "${many_lines}" "core/point.cpp: 40[0-9] lines are more than 400")
string(REPEAT "  ++sum;\n" 81 many_statements)
fault(a_function_without_end tidy core/point.cpp
  "int total() {\n  int sum = 0;\n${many_statements}  return sum;\n}"
  "readability-function-size")

# A variable, so that the scan does not find it in this file.
set(idiom nobody)
fault(a_comment_in_idiom language core/point.h
  "/// A point that ${idiom} uses." "error: headers: ")
fault(a_comment_of_a_source_in_idiom language calib/place.cpp
  "// Removes the camera that ${idiom} uses." "error: sources: ")
fault(a_message_in_idiom language calib/place.cpp
  "const char* other = \"${idiom} uses this camera\";" "error: messages: ")
fault(a_text_of_a_page_in_idiom language live/viewer/src/pages/page.ts
  "show(`\${name} is a camera that ` +\n  '${idiom} uses.');" "error: pages: ")
fault(a_shell_of_a_page_in_idiom language live/viewer/src/pages/page.html
  "<p>A camera that ${idiom} uses.</p>" "error: pages: ")
fault(a_page_in_idiom language README.md
  "\nThis is a page that ${idiom} reads." "error: docs: ")
fault(a_note_in_idiom language recordings/samples/README.md
  "This is a sample that ${idiom} uses." "error: docs: ")
fault(a_comment_of_a_script_in_idiom language core/CMakeLists.txt
  "# An option that ${idiom} uses." "error: scripts: ")
fault(a_message_of_a_script_in_idiom language core/CMakeLists.txt
  "message(STATUS \"an option that ${idiom} uses\")" "error: scripts: ")
fault(a_docstring_in_idiom language tests/tools/script.py
  "\"\"\"Removes the option that ${idiom} uses.\"\"\"" "error: scripts: ")
fault(a_name_of_a_test_in_idiom language tests/calib/more_test.cpp
  "TEST(Place, IsForgotten) {}" "error: tests: ")
fault(a_message_of_a_test_in_idiom language tests/calib/more_test.cpp
  "const char* message = \"${idiom} uses this camera\";" "error: test_messages: ")

emptied(an_empty_tree layering "${tree}/*" "nothing was checked")
emptied(a_tree_without_includes folders "${tree}/*" "nothing was checked")
emptied(a_checkout_without_files public_text "${tree}/*" "nothing was checked")
emptied(a_tree_without_pages docs "${tree}/README.md" "names checked: 0")
emptied(a_tree_without_sources sizes "${tree}/*" "files checked: 0")
emptied(a_tree_without_packages packages "${tree}/CMakeLists.txt" "packages checked: 0")
emptied(a_tree_without_sentences language "${tree}/core;${tree}/calib" "error: headers: None")
emptied(a_tree_without_rooms headers_stand_alone "${tree}/core" "headers checked: 0")

if(NOT seen)
  message(FATAL_ERROR "there is no case \"${CASE}\"")
endif()
