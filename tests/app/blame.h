// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/app/spoiled_session.h"
#include "tests/support/program/run_program.h"

namespace marey::testing {

/// What an error must say.
struct Blame {
  std::string where;  ///< Part of what stands before the cause: a file's name.
  std::string cause;
  std::string next;
};

/// The lines of a program's standard error that tell errors.
[[nodiscard]] std::vector<std::string> error_lines(const std::string& err);

/// Whether the run ended as a mistake of the user's must, blaming `blame`, with no other
/// results than `kept`, which earlier stages made.
[[nodiscard]] ::testing::AssertionResult declines(
    const SpoiledSession& session,
    const ProgramRun& run,
    const Blame& blame,
    const std::vector<std::string>& kept = {});

}  // namespace marey::testing
