// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace marey::app {

/// The colour of that share of a scale, as the report's page has it: 0 is dark blue.
[[nodiscard]] std::string colour(double share);

/// `text` where HTML wants words, in an element or an attribute.
[[nodiscard]] std::string escaped(std::string_view text);

/// snprintf() of up to three numbers. Precondition: fewer than 400 characters.
[[nodiscard]] std::string text_of(const char* format,
                                  double a,
                                  double b = 0.0,
                                  double c = 0.0);

}  // namespace marey::app
