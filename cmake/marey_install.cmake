# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(MAREY_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/marey)
set(MAREY_SAMPLE_DIR ${CMAKE_INSTALL_DATADIR}/marey/samples)

# marey_install_module(<target>): installs the library of a room, and its public headers as
# include/marey/ROOM/name.h: includes are written from the top, "ROOM/name.h".
function(marey_install_module target)
  install(TARGETS ${target} EXPORT marey-targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/marey)
endfunction()

# marey_install_program(): installs the program, the pages that its messages name, and the
# sample session of `marey demo`, which the program finds by its own path
# (app/shell/sample_session.h).
function(marey_install_program)
  install(TARGETS marey RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
    FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/recordings/samples/first-light
    DESTINATION ${MAREY_SAMPLE_DIR})
endfunction()

# marey_install_package(): installs the files for find_package(marey) and `pkg-config
# marey`. Call it after all rooms are added. These files do not contain the folder of the
# installation, so that the installed tree can be moved.
function(marey_install_package)
  install(EXPORT marey-targets NAMESPACE marey:: DESTINATION ${MAREY_PACKAGE_DIR})
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/marey-config.cmake.in
    ${PROJECT_BINARY_DIR}/marey-config.cmake INSTALL_DESTINATION ${MAREY_PACKAGE_DIR})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/marey-config-version.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES
    ${PROJECT_BINARY_DIR}/marey-config.cmake
    ${PROJECT_BINARY_DIR}/marey-config-version.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindCairo.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindFFmpeg.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindLibExif.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindLibZip.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindOpenCV.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindTurboJPEG.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindxxHash.cmake
    DESTINATION ${MAREY_PACKAGE_DIR})
  set(pc_dir ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
  file(RELATIVE_PATH MAREY_PREFIX_FROM_PC ${pc_dir} ${CMAKE_INSTALL_PREFIX})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/marey.pc.in ${PROJECT_BINARY_DIR}/marey.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/marey.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
