// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "core/base/result.h"

namespace marey::app {

/// Returns CLI::Range with a check against NaN, which CLI::Range accepts.
[[nodiscard]] inline CLI::Validator between(double low, double high) {
  const CLI::Range range(low, high);
  return CLI::Validator(
      [range](std::string& word) {
        const bool is_nan = CLI::detail::to_lower(word).find("nan") != std::string::npos;
        return is_nan ? "Value " + word + " is not a number" : range(word);
      },
      range.get_description());
}

/// Upper limit of the magnitude of lengths, times, rates and shares in all commands.
inline constexpr double kMaxNumber = 1e9;

/// Adds a check to every option of `app` and its subcommands that has a floating-point
/// value: the value must be a finite number (not nan, inf, 1e999) of at most
/// kMaxNumber. Other checks of the option remain. Call it after all options are
/// added.
void refuse_absurd_numbers(CLI::App& app);

/// Checks a folder for results before the work begins. Errors (kBadInput): the path, or
/// the nearest existing path above it, is not a folder. A missing folder passes: it is
/// created when results are written.
[[nodiscard]] Status check_out_folder(const std::filesystem::path& out);

}  // namespace marey::app
