// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace marey::recordings {

/// Takes lines off a text and knows their numbers. Lines end with LF, CRLF or CR.
class LineReader {
 public:
  explicit LineReader(std::string_view text);

  /// The next line without its end; nullopt after the last one.
  [[nodiscard]] std::optional<std::string_view> next();
  /// Of the line read last, from 1.
  [[nodiscard]] int line() const { return line_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
};

[[nodiscard]] std::string_view trimmed(std::string_view text);

/// What parts the cells of a file: tabs, but other programs save it with other marks.
/// Blanks, of which many are as one, leave no cell empty.
enum class CellMark : char { kTab = '\t', kComma = ',', kSemicolon = ';', kBlanks = ' ' };

/// The mark that `line`, which has several cells, is parted by.
[[nodiscard]] CellMark cell_mark(std::string_view line);

/// The cells of a line into `cells`, without blanks around them.
void split_cells(std::string_view line,
                 CellMark mark,
                 std::vector<std::string_view>& cells);

/// Whether a cell says that nothing was seen: it is blank, or a NaN or infinity in one of
/// the spellings of C, Matlab and Windows.
[[nodiscard]] bool is_missing(std::string_view cell);

}  // namespace marey::recordings
