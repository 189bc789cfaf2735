# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0

# marey_precompile(<target> [<header>...])
#
# Compiles what nearly every file of a target includes once: half of a cold build is
# spent reading the same headers. Not with a compiler cache, which does not know such
# objects again; such a build is also the check that each file includes what it uses.
function(marey_precompile target)
  if(CMAKE_CXX_COMPILER_LAUNCHER OR MAREY_FUZZ)
    return()
  endif()
  # g++ 12 no longer knows precompiled system headers as such, and warns of what it
  # suspects in std::string (bugs 105329, 105651).
  target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict
                         -Wno-stringop-overflow -Wno-stringop-overread)
  target_precompile_headers(${target} PRIVATE
    <algorithm> <array> <cmath> <cstddef> <cstdint> <cstdio> <filesystem> <functional>
    <limits> <map> <memory> <numbers> <optional> <set> <span> <string> <string_view>
    <system_error> <utility> <variant> <vector>
    <glm/geometric.hpp> <glm/gtc/quaternion.hpp> <glm/mat3x3.hpp> <glm/vec3.hpp>
    ${ARGN})
endfunction()

# marey_reuse_precompiled(<target> <other>): what marey_precompile(<other> ...) compiled,
# for a target with the same options.
function(marey_reuse_precompiled target other)
  if(CMAKE_CXX_COMPILER_LAUNCHER OR MAREY_FUZZ)
    return()
  endif()
  target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict
                         -Wno-stringop-overflow -Wno-stringop-overread)
  target_precompile_headers(${target} REUSE_FROM ${other})
endfunction()
