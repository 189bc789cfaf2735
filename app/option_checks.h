// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

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

}  // namespace marey::app
