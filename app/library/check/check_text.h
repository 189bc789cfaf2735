// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/library/check/library_check.h"

namespace marey::app {

/// Returns the result of a check as lines of text: totals, figures with warnings or
/// failures, kinds of problems, the worst clips with their problems, sources that gave
/// nothing. At most `max_clips` clips and as many sources; the rest is counted.
[[nodiscard]] std::vector<std::string> check_lines(const LibraryCheck& check,
                                                   std::size_t max_clips);

/// Returns a number with at most four digits, as the text and the page show it.
[[nodiscard]] std::string short_number(double value);

}  // namespace marey::app
