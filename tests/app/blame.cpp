// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/blame.h"

#include <sstream>

namespace marey::testing {

using ::testing::AssertionFailure;
using ::testing::AssertionResult;
using ::testing::AssertionSuccess;

std::vector<std::string> error_lines(const std::string& err) {
  std::vector<std::string> errors;
  std::istringstream lines(err);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("error: ")) errors.push_back(line);
  }
  return errors;
}

AssertionResult declines(const SpoiledSession& session,
                         const ProgramRun& run,
                         const Blame& blame,
                         const std::vector<std::string>& kept) {
  if (run.exit_code != 3) {
    return AssertionFailure() << "exit code " << run.exit_code << "\n" << run.err;
  }
  const auto errors = error_lines(run.err);
  if (errors.size() != 1) {
    return AssertionFailure() << errors.size() << " errors\n" << run.err;
  }
  const std::string& error = errors.front();
  const std::size_t where = error.find(blame.where);
  const std::size_t cause = error.find(blame.cause);
  const std::size_t next = error.find("Next: ");
  if (where == std::string::npos || cause == std::string::npos ||
      next == std::string::npos || error.find(blame.next, next) == std::string::npos) {
    return AssertionFailure() << "expected \"" << blame.where << "\", \"" << blame.cause
                              << "\", \"" << blame.next << "\" in\n"
                              << error;
  }
  if (cause > next || where > next) {
    return AssertionFailure() << "out of order: " << error;
  }
  if (!run.out.empty()) return AssertionFailure() << "printed " << run.out;
  const auto left = session.results();
  if (left != kept) {
    AssertionResult failure = AssertionFailure();
    failure << "left behind:";
    for (const std::string& name : left) failure << " " << name;
    return failure;
  }
  return AssertionSuccess();
}

}  // namespace marey::testing
