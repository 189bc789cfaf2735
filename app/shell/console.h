// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "app/shell/exit_codes.h"
#include "app/shell/program_name.h"
#include "core/base/progress.h"
#include "core/base/result.h"

namespace marey::app {

enum class ProgressStyle {
  kAuto,   ///< A bar on a terminal, lines otherwise.
  kJson,   ///< One JSON object a line; warnings and errors too.
  kQuiet,  ///< None.
  kKept,   ///< Nothing is printed: kept_warnings() returns the warnings.
};

/// Writes messages and progress to standard error. Standard output is for data.
/// Commands in messages name the program as it was called, except in JSON.
/// Thread-safe: worker threads of one stage may report at the same time.
class Console {
 public:
  explicit Console(ProgressStyle style, ProgramName name = {});

  /// Returns a progress callback for one stage; `label` has one or two words.
  [[nodiscard]] Progress stage(const std::string& label);
  void say(const std::string& text);
  void warn(const std::string& text);
  /// Returns the warnings of ProgressStyle::kKept, in their order.
  [[nodiscard]] std::vector<std::string> kept_warnings() const;
  /// Prints the error and returns its exit code.
  Exit fail(const Error& error);
  /// Returns `text` with the program's name as it was called.
  [[nodiscard]] std::string as_called(const std::string& text) const;

 private:
  using Clock = std::chrono::steady_clock;
  void show(const std::string& label, int done, int total, Clock::time_point start);
  void clear_bar();

  ProgressStyle style_;
  ProgramName name_;
  bool terminal_ = false;
  bool bar_shown_ = false;
  Clock::time_point last_shown_{};
  std::vector<std::string> kept_;
  mutable std::mutex mutex_;
};

}  // namespace marey::app
