// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace marey::recordings {

/// Reads the lines of a text and counts them. Lines end with LF, CRLF or CR.
class LineReader {
 public:
  explicit LineReader(std::string_view text);

  /// Returns the next line without its end; nullopt after the last one.
  [[nodiscard]] std::optional<std::string_view> next();
  /// Returns the number of the last line read, from 1.
  [[nodiscard]] int line() const { return line_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
};

[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Separator of a file's cells: tabs by the standard, other marks from other programs.
/// Several blanks count as one, so they leave no cell empty.
enum class CellMark : char { kTab = '\t', kComma = ',', kSemicolon = ';', kBlanks = ' ' };

/// Detects the separator of `line`. Precondition: it has several cells.
[[nodiscard]] CellMark cell_mark(std::string_view line);

/// Splits a line into `cells`, without blanks around them.
void split_cells(std::string_view line,
                 CellMark mark,
                 std::vector<std::string_view>& cells);

/// Returns true if a cell means "not seen": it is blank, or a NaN or infinity in one of
/// the spellings of C, Matlab and Windows.
[[nodiscard]] bool is_missing(std::string_view cell);

}  // namespace marey::recordings
