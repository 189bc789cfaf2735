// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>

namespace marey {

[[noreturn]] inline void assert_failed(const char* claim, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: contract broken: %s\n", file, line, claim);
  std::abort();
}

}  // namespace marey

/// Stops the program, in every build, if a caller violates a precondition. The claim
/// should be O(1).
#define MAREY_ASSERT(claim) \
  ((claim) ? static_cast<void>(0) : ::marey::assert_failed(#claim, __FILE__, __LINE__))
