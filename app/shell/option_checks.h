// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "core/base/result.h"

namespace marey::app {

/// CLI::Range, which lets pass what is no number.
[[nodiscard]] inline CLI::Validator between(double low, double high) {
  const CLI::Range range(low, high);
  return CLI::Validator(
      [range](std::string& word) {
        const bool is_nan = CLI::detail::to_lower(word).find("nan") != std::string::npos;
        return is_nan ? "Value " + word + " is no number" : range(word);
      },
      range.get_description());
}

/// Beyond this no length, time, rate or share of any command makes sense.
inline constexpr double kLargestNumber = 1e9;

/// Refuses, for every option of `app` and of its subcommands that takes a floating-point
/// number, words that are no number (nan), not finite (inf, 1e999) or absurd (beyond
/// kLargestNumber), whatever else the option checks. Call it once all options are added.
void refuse_absurd_numbers(CLI::App& app);

/// Checks a folder for results before the work begins. Error (kBadInput): it, or what
/// should hold it, is there and is not a folder. A folder that is missing is no error:
/// it is made when results are written.
[[nodiscard]] Status check_out_folder(const std::filesystem::path& out);

}  // namespace marey::app
