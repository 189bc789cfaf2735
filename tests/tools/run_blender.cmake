# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D SCRIPT=... -D MOTION=... -D JOINTS=... [-D UNIT=...] -P run_blender.cmake
# Compares the joint places that Blender and marey compute for a motion. Prints `skipped:`
# if Blender is missing.
cmake_minimum_required(VERSION 3.25)
if(NOT DEFINED UNIT)
  set(UNIT 0.01)
endif()
find_program(BLENDER blender)
if(NOT BLENDER)
  message("skipped: Blender is missing; apt-get install blender python3-numpy")
  return()
endif()
execute_process(
  COMMAND ${BLENDER} -b --factory-startup --python-exit-code 1 --python ${SCRIPT}
          -- ${MOTION} --compare ${JOINTS} --unit ${UNIT}
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
message("${output}")
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${MOTION}: Blender disagrees, exit ${result}")
endif()
