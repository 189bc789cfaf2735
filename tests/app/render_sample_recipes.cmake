# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D PROGRAM=<marey> -D RECIPES=<folder> -D MOTION=<motion.npz> -D WORK=<folder>
#       -P render_sample_recipes.cmake
#
# Renders every sample recipe on the motion of the sample session. The recipes name a
# path that does not exist here, so the motion is found by its name in their folder.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
file(COPY ${MOTION} DESTINATION ${WORK})
file(GLOB recipes ${RECIPES}/*.edit.toml)
list(LENGTH recipes count)
if(count LESS 10)
  message(FATAL_ERROR "${count} recipes in ${RECIPES}, fewer than 10")
endif()
foreach(recipe ${recipes})
  get_filename_component(file ${recipe} NAME)
  string(REPLACE ".edit.toml" "" name ${file})
  file(COPY ${recipe} DESTINATION ${WORK})
  execute_process(
    COMMAND ${PROGRAM} --progress none edit ${WORK}/${file} --out ${WORK}/${name}
    RESULT_VARIABLE exit ERROR_VARIABLE text)
  file(GLOB motions ${WORK}/${name}/*.npz)
  if(NOT exit EQUAL 0 OR NOT motions)
    message(FATAL_ERROR "${file}: exit code ${exit}, results: ${motions}\n${text}")
  endif()
endforeach()
