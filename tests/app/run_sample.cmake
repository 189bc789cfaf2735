# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D MAREY=... -D SESSION=... -D STAGES=track+solve -D ROOT=... -D RUN=NAME
#       [-D CACHE_OF=NAME] -P run_sample.cmake
# Results go to ROOT/RUN, the output of each stage to ROOT/RUN.STAGE.out and .err, avatars
# to ROOT/avatars. CACHE_OF names a run whose detections are copied, with their file times.
cmake_minimum_required(VERSION 3.25)
string(REPLACE "+" ";" stages "${STAGES}")
file(REMOVE_RECURSE ${ROOT}/${RUN})
file(MAKE_DIRECTORY ${ROOT}/${RUN})

if(CACHE_OF)
  file(GLOB caches ${ROOT}/${CACHE_OF}/*/detections)
  foreach(cache ${caches})
    file(RELATIVE_PATH place ${ROOT}/${CACHE_OF} ${cache})
    get_filename_component(trial ${place} DIRECTORY)
    file(COPY ${cache} DESTINATION ${ROOT}/${RUN}/${trial})
  endforeach()
else()
  foreach(body "child --height 1.1 --head-ratio 1.35" "giant --height 2.4 --arm-ratio 1.25")
    separate_arguments(words UNIX_COMMAND ${body})
    list(POP_FRONT words name)
    execute_process(COMMAND ${MAREY} mannequin ${words} --out ${ROOT}/avatars/${name}.glb
      COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endif()

foreach(stage ${stages})
  set(avatars)
  if(stage MATCHES "process|solve")
    set(avatars --avatar ${ROOT}/avatars/child.glb --avatar ${ROOT}/avatars/giant.glb)
  endif()
  execute_process(
    COMMAND ${MAREY} ${stage} ${SESSION} --out ${ROOT}/${RUN} ${avatars} --json
            --progress json
    OUTPUT_FILE ${ROOT}/${RUN}.${stage}.out ERROR_FILE ${ROOT}/${RUN}.${stage}.err
    RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    file(READ ${ROOT}/${RUN}.${stage}.err said)
    message(FATAL_ERROR "${said}\nmarey ${stage} ended with ${result}")
  endif()
endforeach()
