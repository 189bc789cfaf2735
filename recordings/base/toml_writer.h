// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace marey::recordings {

/// Builds the text of a TOML file, line by line. Numbers are read back as the same
/// doubles; they must be finite.
class TomlWriter {
 public:
  /// Writes "# ...". Precondition: one line.
  void comment(std::string_view line);
  /// Writes "[outer.name]" after a blank line; each part is quoted if necessary.
  void table(std::initializer_list<std::string_view> path);
  /// Writes "[[name]]" after a blank line; the name is quoted if necessary.
  void array_table(std::string_view name);

  // Not overloaded, to prevent conversions of a bool or an int to a number.
  void text(std::string_view key, std::string_view value);
  /// Writes an array of texts.
  void texts(std::string_view key, std::span<const std::string_view> values);
  void boolean(std::string_view key, bool value);
  void integer(std::string_view key, int value);
  void integers(std::string_view key, std::initializer_list<int> values);
  void number(std::string_view key, double value);
  void numbers(std::string_view key, std::span<const double> values);
  void numbers(std::string_view key, std::initializer_list<double> values) {
    numbers(key, std::span(values.begin(), values.size()));
  }
  /// Writes an array of rows of `columns` numbers. Precondition: `values` are whole rows.
  void matrix(std::string_view key, std::span<const double> values, std::size_t columns);

  /// Writes an inline table: {a = 1, b = 2}. Precondition: `keys` holds lines of keys
  /// only, no tables.
  void inline_table(std::string_view key, const TomlWriter& keys);
  /// Writes an array of inline tables, a line for each. Precondition: the rows hold lines
  /// of keys only, no tables.
  void inline_tables(std::string_view key, std::span<const TomlWriter> rows);

  [[nodiscard]] const std::string& str() const { return text_; }

 private:
  void start_line(std::string_view key);
  void append_number(double value);
  void append_row(std::span<const double> values);
  void append_key(std::string_view key);
  void append_quoted(std::string_view value);
  void append_inline(const TomlWriter& keys);

  std::string text_;
};

}  // namespace marey::recordings
