// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace marey::app {

/// Returns the command of a POSIX shell that runs `words`: words with characters other
/// than letters, digits and _-./=:,+@% are quoted.
[[nodiscard]] std::string shell_command(const std::vector<std::string>& words);

/// The name by which the user called the program. Messages name commands as
/// `marey COMMAND`; before a message is printed, written_into() replaces the name, so
/// that a printed command can be pasted into the shell from which the program was called.
class ProgramName {
 public:
  /// Messages keep the name `marey`.
  ProgramName() = default;
  /// `called` is the program as the user called it, argv[0]; empty: `marey`. `commands`
  /// are the words that may follow it: the names of commands, and "--help".
  ProgramName(const std::string& called, std::vector<std::string> commands);

  /// Returns `text` in which each `marey COMMAND` at the beginning, or after a space, a
  /// quotation mark or an opening parenthesis, names the program as it was called.
  [[nodiscard]] std::string written_into(const std::string& text) const;

 private:
  [[nodiscard]] bool is_command(const std::string& text, std::size_t begin) const;

  std::string called_ = "marey";
  std::vector<std::string> commands_;
};

}  // namespace marey::app
