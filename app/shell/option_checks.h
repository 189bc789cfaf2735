// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/base/result.h"

namespace marey::app {

// Checks of the values of options. Each has the form of its value as its description, for
// the help, and returns a cause that follows the option's name: "must be a number from
// 0.3 to 10, not 99".

/// Accepts numbers from `low` to `high`; not NaN, which CLI::Range accepts.
[[nodiscard]] CLI::Validator between(double low, double high);
/// Accepts whole numbers from `low` to `high`.
[[nodiscard]] CLI::Validator whole_between(long low, long high);
/// Accepts 0, and whole numbers from `low` to `high`.
[[nodiscard]] CLI::Validator zero_or_between(long low, long high);
/// Accepts one of `words`. Precondition: `words` not empty.
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> words);

/// Returns one_of() for the keys of a map from words to values.
template <class Map>
[[nodiscard]] CLI::Validator one_of_keys(const Map& map) {
  std::vector<std::string> words;
  for (const auto& [word, value] : map) words.push_back(word);
  return one_of(std::move(words));
}

/// Upper limit of the magnitude of lengths, times, rates and shares in all commands.
inline constexpr double kMaxNumber = 1e9;

/// Adds a check to every option of `app` and its subcommands that has a number as its
/// value: the value must be a number, and a finite one (not nan, inf, 1e999) of at most
/// kMaxNumber. Other checks of the option remain. Call it after all options are
/// added.
void refuse_absurd_numbers(CLI::App& app);

/// A fault in the arguments of a command that CLI11 does not check. Thrown by callbacks
/// of options and commands; usage_error() makes an Error of it.
class RejectedArguments : public CLI::ValidationError {
 public:
  RejectedArguments(const std::string& cause, std::string next)
      : CLI::ValidationError(cause), next_(std::move(next)) {}
  [[nodiscard]] const std::string& next() const { return next_; }

 private:
  std::string next_;
};

/// Help of the program: a blank follows the colon between the type of an option and the
/// form of its value.
class PlainHelp : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override;
};

/// Checks a folder for results before the work begins. Errors (kBadInput): the path, or
/// the nearest existing path above it, is not a folder. A missing folder passes: it is
/// created when results are written.
[[nodiscard]] Status check_out_folder(const std::filesystem::path& out);

/// Checks the file of a result before the work begins. Errors (kBadInput): the path is a
/// folder.
[[nodiscard]] Status check_out_file(const std::filesystem::path& out);

}  // namespace marey::app
