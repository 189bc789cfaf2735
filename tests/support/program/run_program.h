// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace marey::testing {

/// Output and exit code of a program.
struct ProgramRun {
  int exit_code = -1;  ///< 128 + signal when a signal ended it, as shells have it.
  std::string out;     ///< Standard output.
  std::string err;     ///< Standard error.
};

struct RunOptions {
  std::filesystem::path folder;  ///< Working folder; empty: the caller's.
  /// When this text shows on its standard error, the program gets SIGINT, as by Ctrl-C.
  /// Empty: it is left alone.
  std::string interrupt_at;
};

/// Runs `program` with `arguments`, without a shell, and waits for it. Its standard input
/// is empty. Its output goes to files, so that it never blocks on this process.
/// Throws std::runtime_error when it cannot be started.
[[nodiscard]] ProgramRun run_program(const std::filesystem::path& program,
                                     const std::vector<std::string>& arguments,
                                     const RunOptions& options = {});

}  // namespace marey::testing
