// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace marey::app {

/// Returns the colour of a share of a scale, from the same map as in the report: 0 is
/// dark blue.
[[nodiscard]] std::string colour(double share);

/// Escapes `text` for the content of an HTML element or attribute.
[[nodiscard]] std::string escaped(std::string_view text);

/// Formats up to three numbers with snprintf(). Precondition: fewer than 400 characters.
[[nodiscard]] std::string text_of(const char* format,
                                  double a,
                                  double b = 0.0,
                                  double c = 0.0);

}  // namespace marey::app
