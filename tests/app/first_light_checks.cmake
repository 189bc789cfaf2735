# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
# Results of the sample session, checked by independent programs.
set(tools ${PROJECT_SOURCE_DIR}/tests/tools)
set(glbs)
foreach(body motion child giant)
  list(APPEND glbs ${first_light}/once/walk/${body}.glb)
endforeach()
list(APPEND glbs ${first_light}/once/walk/child.vrma)
if(NODE)
  add_test(NAME tools/gltf_validator_accepts_first_light
    COMMAND ${NODE} ${tools}/validate_gltf.mjs ${glbs})
else()
  add_test(NAME tools/gltf_validator_accepts_first_light
    COMMAND ${CMAKE_COMMAND} -E echo "skipped: node is missing; apt-get install nodejs")
endif()
foreach(format bvh glb)
  add_test(NAME tools/blender_agrees_on_${format}_first_light
    COMMAND ${CMAKE_COMMAND}
      -D SCRIPT=${tools}/blender_joints.py
      -D MOTION=${first_light}/once/walk/motion.${format}
      -D JOINTS=${first_light}/once/walk/joints.csv -P ${tools}/run_blender.cmake)
endforeach()
set_tests_properties(
  tools/gltf_validator_accepts_first_light
  tools/blender_agrees_on_bvh_first_light
  tools/blender_agrees_on_glb_first_light
  PROPERTIES FIXTURES_REQUIRED sample_once SKIP_REGULAR_EXPRESSION "skipped:")

# The sample recipes of edits, on the motion of the session.
add_test(NAME app/sample_recipes_render
  COMMAND ${CMAKE_COMMAND}
    -D PROGRAM=$<TARGET_FILE:marey>
    -D RECIPES=${PROJECT_SOURCE_DIR}/recordings/samples/edits
    -D MOTION=${first_light}/once/walk/motion.npz
    -D WORK=${first_light}/edits
    -P ${CMAKE_CURRENT_SOURCE_DIR}/render_sample_recipes.cmake)
set_tests_properties(app/sample_recipes_render PROPERTIES
  FIXTURES_REQUIRED sample_once LABELS once)

# The pages on those results, and live, in a browser.
foreach(page first_light edit)
  if(NODE)
    add_test(NAME app/page_of_${page}
      COMMAND ${NODE} ${PROJECT_SOURCE_DIR}/live/viewer/test/run_real.mjs ${page})
  else()
    add_test(NAME app/page_of_${page}
      COMMAND ${CMAKE_COMMAND} -E echo "skipped: node is missing; apt-get install nodejs")
  endif()
  set_tests_properties(app/page_of_${page} PROPERTIES
    FIXTURES_REQUIRED sample_once SKIP_REGULAR_EXPRESSION "skipped:" LABELS once
    PROCESSORS 2 TIMEOUT 300 ENVIRONMENT
    "MAREY_PROGRAM=$<TARGET_FILE:marey>;MAREY_RESULTS=${first_light}/once;MAREY_SESSION=${sample}")
endforeach()
