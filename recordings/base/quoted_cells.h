// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace marey::recordings {

/// A cell of a comma-separated table (RFC 4180), without its quotes.
struct QuotedCell {
  std::string text;
  std::size_t column = 1;  ///< Place of its first byte in the line, from 1.
};

/// Splits a line of a comma-separated table. A cell in quotes may contain commas, and
/// quotes as "". Blanks belong to the cells. Returns the column of a quote that is not
/// closed on this line, or of text after a closing quote; 0 if the line is correct.
/// Linear.
[[nodiscard]] std::size_t split_quoted(std::string_view line,
                                       std::vector<QuotedCell>& cells);

/// Appends a cell, in quotes if a comma, a quote, a blank at an end or a line end
/// requires them. split_quoted() returns the same text, if it has no line ends.
void append_quoted(std::string& text, std::string_view cell);

}  // namespace marey::recordings
