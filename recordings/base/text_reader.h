// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace marey::recordings {

/// Splits a text into words and counts lines. Lines end with LF, CRLF or CR. Borrows the
/// text, which must outlive it.
class TextReader {
 public:
  /// `file` is the name of the text in error messages.
  TextReader(std::string_view text, std::string file);

  /// Returns the next word, on this line or a later one; empty at the end of the text.
  [[nodiscard]] std::string_view word();
  /// Returns word() without consuming it.
  [[nodiscard]] std::string_view peek() const;
  /// Returns the next word of this line; empty if there is none.
  [[nodiscard]] std::string_view word_on_line();
  /// Returns the rest of this line, without surrounding blanks and the line end.
  [[nodiscard]] std::string_view rest_of_line();
  /// Skips blank space and blank lines, up to the next word.
  void skip_blank();

  [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }
  /// Returns the line of the last word read, from 1.
  [[nodiscard]] int line() const { return line_; }
  /// Returns the position for messages: "walk.bvh:212".
  [[nodiscard]] std::string where() const;

 private:
  void skip_line_end();

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Parses the whole of `word` as a finite number, in any locale. nullopt otherwise.
[[nodiscard]] std::optional<double> to_number(std::string_view word);

/// Parses the whole of `word` as an integer. nullopt otherwise.
[[nodiscard]] std::optional<int> to_integer(std::string_view word);

}  // namespace marey::recordings
