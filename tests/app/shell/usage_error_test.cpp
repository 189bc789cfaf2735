// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// A command line that cannot be understood ends with one message: the cause, and the next
// step.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"

namespace marey::testing {
namespace {

/// Expects exit code 2, nothing on standard output, and one message that contains all of
/// `words`.
void expect_usage_error(const std::vector<std::string>& arguments,
                        const std::vector<std::string>& words) {
  const ProgramRun run = run_program(marey::testing::program(), arguments);
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_TRUE(run.err.starts_with("error: ")) << run.err;
  EXPECT_NE(run.err.find(". Next: "), std::string::npos) << run.err;
  for (const std::string& word : words) {
    EXPECT_NE(run.err.find(word), std::string::npos) << word << " in: " << run.err;
  }
}

TEST(UsageError, NamesTheNearestCommandOfAMistypedOne) {
  expect_usage_error({"proces", "session.toml", "--out", "x"},
                     {"proces: there is no such command", "\"process\""});
  expect_usage_error({"--progress", "none", "retargt"}, {"retargt:", "\"retarget\""});
}

TEST(UsageError, NamesAFirstStepWithoutACommand) {
  expect_usage_error({}, {"no command is given", " demo", " --help"});
}

TEST(UsageError, NamesTheNearestOptionOfAMistypedOne) {
  expect_usage_error({"process", "session.toml", "--outt", "x"},
                     {"there is no option --outt", "\"--out\""});
  expect_usage_error({"process", "session.toml", "--out", "x", "--lenss=fisheye"},
                     {"there is no option --lenss", "\"--lens\""});
  expect_usage_error({"--progres", "none", "demo"}, {"--progres", "\"--progress\""});
}

TEST(UsageError, NamesAMissingArgument) {
  expect_usage_error({"process", "session.toml"}, {"--out is missing", "process --help"});
  expect_usage_error({"process", "--out", "x"}, {"SESSION is missing"});
}

TEST(UsageError, AsksToLeaveOneOfTwoOptionsOut) {
  expect_usage_error({"live", "session.toml", "--calibrate", "--record", "x"},
                     {"cannot be used together", "leave one of the two out"});
}

TEST(UsageError, NamesAnOptionWithoutItsValue) {
  expect_usage_error({"process", "session.toml", "--out"}, {"--out", "process --help"});
}

TEST(UsageError, NamesSuperfluousArgumentsInTheirOrder) {
  expect_usage_error({"process", "a b", "c", "d", "--out", "x"}, {"\"c\" \"d\""});
}

TEST(UsageError, NamesAValueThatIsNotAllowed) {
  expect_usage_error({"process", "a", "--out", "x", "--lens", "round"},
                     {"--lens", "round", "process --help"});
}

}  // namespace
}  // namespace marey::testing
