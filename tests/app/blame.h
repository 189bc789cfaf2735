// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/app/spoiled_session.h"
#include "tests/support/program/run_program.h"

namespace marey::testing {

/// The required parts of an error message.
struct Blame {
  std::string where;  ///< Part of the text before "Next: ": a file's name.
  std::string cause;
  std::string next;
};

/// Returns the lines of a program's standard error that begin with "error: ".
[[nodiscard]] std::vector<std::string> error_lines(const std::string& err);

/// Succeeds if the run ends as a mistake of the user requires: exit code 3, one error
/// with the parts of `blame`, and no output. The only results are `kept`, which earlier
/// stages write.
[[nodiscard]] ::testing::AssertionResult declines(
    const SpoiledSession& session,
    const ProgramRun& run,
    const Blame& blame,
    const std::vector<std::string>& kept = {});

}  // namespace marey::testing
