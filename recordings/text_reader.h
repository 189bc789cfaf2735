// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace marey::recordings {

/// Reads words off a text and knows on which line it is. Lines end with LF, CRLF or CR.
/// Borrows the text, which must outlive it.
class TextReader {
 public:
  /// `file` is what error messages call the text.
  TextReader(std::string_view text, std::string file);

  /// The next word, on this line or a later one; empty at the end of the text.
  [[nodiscard]] std::string_view word();
  /// word(), without taking it.
  [[nodiscard]] std::string_view peek() const;
  /// The next word of this line; empty when the line has no more.
  [[nodiscard]] std::string_view word_on_line();
  /// What is left of this line, without blanks around it and without the line end.
  [[nodiscard]] std::string_view rest_of_line();
  /// Skips blank space and blank lines, up to the next word.
  void skip_blank();

  [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }
  /// Line of the word read last, from 1.
  [[nodiscard]] int line() const { return line_; }
  /// "walk.bvh:212"
  [[nodiscard]] std::string where() const;

 private:
  void skip_line_end();

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// The whole of `word` as a finite number, whatever the locale. nullopt otherwise.
[[nodiscard]] std::optional<double> to_number(std::string_view word);

/// The whole of `word` as an integer. nullopt otherwise.
[[nodiscard]] std::optional<int> to_integer(std::string_view word);

/// The word as messages show it: "word", quotes included, cut after 200 bytes.
[[nodiscard]] std::string in_quotes(std::string_view word);

}  // namespace marey::recordings
