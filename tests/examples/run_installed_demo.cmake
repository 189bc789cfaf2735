# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D INSTALLED=<tree> -D OUT=<folder> -D EARLIER=<results> -P run_installed_demo.cmake
#
# Runs the demo of an installed program. The sample session of the tree gets another
# subject, to see that it is the one that is processed.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${OUT})
file(GLOB detections ${EARLIER}/*/detections)
foreach(found ${detections})
  get_filename_component(trial ${found} DIRECTORY)
  get_filename_component(trial ${trial} NAME)
  file(COPY ${found} DESTINATION ${OUT}/${trial})
endforeach()
set(session ${INSTALLED}/share/marey/samples/first-light/session.toml)
file(READ ${session} text)
string(REPLACE "\"S16\"" "\"Installed\"" text "${text}")
file(WRITE ${session} "${text}")
execute_process(COMMAND ${INSTALLED}/bin/marey demo --out ${OUT}
  OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
file(READ ${OUT}/subject.toml subject)
if(NOT subject MATCHES "Installed")
  message(FATAL_ERROR "the demo processed another sample session: ${said}")
endif()
if(NOT said MATCHES "${INSTALLED}/bin/marey view ${OUT}")
  message(FATAL_ERROR "the demo names another program: ${said}")
endif()
