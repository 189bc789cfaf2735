// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(InParallel, DoesEveryJobOnceWhateverTheThreads) {
  for (const std::size_t threads : {0u, 1u, 2u, 7u, 100u}) {
    std::vector<int> done(31, 0);
    in_parallel(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    EXPECT_EQ(done, std::vector<int>(31, 1)) << threads << " threads";
  }
}

TEST(InParallel, DoesNothingWhenThereIsNothing) {
  in_parallel(0, 3, [](std::size_t) { FAIL(); });
}

TEST(InParallel, RethrowsTheFirstExceptionAfterAllJobsEnded) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<int> done(16, 0);
    try {
      in_parallel(done.size(), 4, [&](std::size_t i) {
        done[i] = 1;
        if (i == 5 || i == 11) throw std::runtime_error(std::to_string(i));
      });
      FAIL() << "threw nothing";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "5");
    }
    EXPECT_EQ(done, std::vector<int>(16, 1));
  }
}

}  // namespace
}  // namespace marey
