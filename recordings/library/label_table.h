// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "recordings/base/quoted_cells.h"
#include "recordings/base/table_cells.h"

namespace marey::recordings {

/// Reads a table of labels/ line by line. Stores the first mistake, with file, line and
/// column; cells read after it are empty. Borrows the text.
class LabelTable {
 public:
  /// `header` has the titles of the columns. Mistakes: the text has other titles, or
  /// none.
  LabelTable(std::string_view text,
             std::string file,
             std::span<const std::string_view> header);

  /// Moves to the next line that is not blank. Returns false after the last one, or after
  /// a mistake: a quote that is not closed, another number of cells, bytes that are not
  /// text.
  [[nodiscard]] bool next();
  /// Returns the number of the line, from 1.
  [[nodiscard]] int line() const { return lines_.line(); }

  /// Returns a cell of the line without blanks around it.
  [[nodiscard]] std::string text(std::size_t column) const;
  /// Returns text(). Mistake: it is empty.
  [[nodiscard]] std::string required(std::size_t column);
  /// Returns a number; nullopt if the cell is empty. Mistakes: not a number, out of
  /// range.
  [[nodiscard]] std::optional<double> number(std::size_t column, double min, double max);

  void fail(std::size_t column, std::string cause, std::string next_step);
  [[nodiscard]] const std::optional<Error>& mistake() const { return mistake_; }

 private:
  void fail_at(std::string place, std::string cause, std::string next_step);
  void read_header();
  [[nodiscard]] std::string header_line() const;

  LineReader lines_;
  std::string file_;
  std::span<const std::string_view> header_;
  std::vector<QuotedCell> cells_;
  std::optional<Error> mistake_ = std::nullopt;
};

}  // namespace marey::recordings
