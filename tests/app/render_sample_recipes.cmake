# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D PROGRAM=<marey> -D RECIPES=<folder> -D MOTION=<motion.npz> -D WORK=<folder>
#       -P render_sample_recipes.cmake
#
# Renders every sample recipe on the motion of the sample session. The recipes name a
# path that does not exist here, so the motion is found by its name in their folder. Then
# renders them again from another folder, with other settings of language and time zone
# and on one processor, and a recipe on many motions: all files must have the same bytes.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/elsewhere)
file(COPY ${MOTION} DESTINATION ${WORK})
file(GLOB recipes ${RECIPES}/*.edit.toml)
list(LENGTH recipes count)
if(count LESS 10)
  message(FATAL_ERROR "${count} recipes in ${RECIPES}, fewer than 10")
endif()

set(other_place ${CMAKE_COMMAND} -E env LC_ALL=de_DE.UTF-8 LANG=tr_TR.UTF-8 TZ=Asia/Kathmandu)
find_program(TASKSET taskset)
if(TASKSET)
  list(APPEND other_place ${TASKSET} -c 0)
endif()

function(run folder)
  execute_process(
    COMMAND ${ARGN} WORKING_DIRECTORY ${folder}
    RESULT_VARIABLE exit ERROR_VARIABLE text OUTPUT_QUIET)
  if(NOT exit EQUAL 0)
    message(FATAL_ERROR "${ARGN}: exit code ${exit}\n${text}")
  endif()
endfunction()

function(expect_same first second)
  file(GLOB_RECURSE names RELATIVE ${first} ${first}/*)
  file(GLOB_RECURSE others RELATIVE ${second} ${second}/*)
  if(NOT names OR NOT names STREQUAL others)
    message(FATAL_ERROR "${first} has ${names}, ${second} has ${others}")
  endif()
  foreach(name ${names})
    file(SHA256 ${first}/${name} before)
    file(SHA256 ${second}/${name} after)
    if(NOT before STREQUAL after)
      message(FATAL_ERROR "${name} has other bytes in ${second} than in ${first}")
    endif()
  endforeach()
endfunction()

foreach(recipe ${recipes})
  get_filename_component(file ${recipe} NAME)
  string(REPLACE ".edit.toml" "" name ${file})
  file(COPY ${recipe} DESTINATION ${WORK})
  run(${WORK} ${PROGRAM} --progress none edit ${file} --out ${name})
  file(GLOB motions ${WORK}/${name}/*.npz)
  if(NOT motions)
    message(FATAL_ERROR "${file}: no motion")
  endif()
  run(${WORK}/elsewhere ${other_place} ${PROGRAM} --progress none edit ../${file} --out ${name})
  expect_same(${WORK}/${name} ${WORK}/elsewhere/${name})
endforeach()

foreach(take one two three four)
  configure_file(${MOTION} ${WORK}/takes/${take}/motion.npz COPYONLY)
endforeach()
set(many --progress none edit trim.edit.toml --each takes/*/motion.npz)
run(${WORK} ${PROGRAM} ${many} --out many)
run(${WORK} ${other_place} ${PROGRAM} ${many} --out elsewhere/many)
expect_same(${WORK}/many ${WORK}/elsewhere/many)
