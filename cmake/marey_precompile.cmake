# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0

# clang-tidy and the fuzzers' clang do not read what g++ precompiles.
set(MAREY_PRECOMPILES ON)
if(CMAKE_CXX_COMPILER_LAUNCHER OR CMAKE_CXX_CLANG_TIDY OR MAREY_FUZZ
   OR NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  set(MAREY_PRECOMPILES OFF)
endif()
# g++ 12 does not treat precompiled headers as system headers, and reports false warnings in
# std::string (bugs 105329, 105651).
set(MAREY_PRECOMPILED_WARNINGS -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow
                               -Wno-stringop-overread)

# marey_precompile(<target> [<header>...])
#
# Precompiles the headers that nearly every file of a target includes: half of a cold build
# is spent reading the same headers. Does nothing with a compiler cache, which does not
# support precompiled headers; such a build also checks that each file includes the headers
# that it uses.
function(marey_precompile target)
  if(NOT MAREY_PRECOMPILES)
    return()
  endif()
  target_compile_options(${target} PRIVATE ${MAREY_PRECOMPILED_WARNINGS})
  target_precompile_headers(${target} PRIVATE
    <algorithm> <array> <cmath> <cstddef> <cstdint> <cstdio> <filesystem> <functional>
    <limits> <map> <memory> <numbers> <optional> <set> <span> <string> <string_view>
    <system_error> <utility> <variant> <vector>
    <glm/geometric.hpp> <glm/gtc/quaternion.hpp> <glm/mat3x3.hpp> <glm/vec3.hpp>
    ${ARGN})
endfunction()

# marey_reuse_precompiled(<target> <other>): uses the headers that marey_precompile(<other>
# ...) compiled for a target with the same options.
function(marey_reuse_precompiled target other)
  if(NOT MAREY_PRECOMPILES)
    return()
  endif()
  target_compile_options(${target} PRIVATE ${MAREY_PRECOMPILED_WARNINGS})
  target_precompile_headers(${target} REUSE_FROM ${other})
endfunction()
