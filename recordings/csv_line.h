// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace marey::recordings {

/// Takes the lines of a text one by one and counts them. Lines end with LF or CRLF.
/// Borrows the text.
class CsvLines {
 public:
  explicit CsvLines(std::string_view text) : rest_(text) {}

  /// The next line without its end; nullopt after the last. An empty line at the very end
  /// of the text is none.
  [[nodiscard]] std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number_;
    return line;
  }

  /// Of the line taken last, from 1.
  [[nodiscard]] int number() const { return number_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// Takes the fields of one line from left to right, without copies. A field that is not
/// what was asked for, or not there, makes the line bad; the caller looks once, at its
/// end. marey's tables hold no quotes, so that a comma always ends a field.
class CsvFields {
 public:
  explicit CsvFields(std::string_view line) : rest_(line) {}

  [[nodiscard]] std::string_view text() {
    if (ended_) {
      good_ = false;
      return {};
    }
    const std::size_t end = rest_.find(',');
    const std::string_view field = rest_.substr(0, end);
    ended_ = end == std::string_view::npos;
    rest_.remove_prefix(ended_ ? rest_.size() : end + 1);
    return field;
  }

  /// A finite number that fills its field.
  template <class T>
  [[nodiscard]] T number() {
    const std::string_view field = text();
    T value{};
    const char* end = field.data() + field.size();
    const auto [stop, problem] = std::from_chars(field.data(), end, value);
    good_ = good_ && problem == std::errc{} && stop == end;
    if constexpr (std::is_floating_point_v<T>) good_ = good_ && std::isfinite(value);
    return value;
  }

  /// Every field so far was there and right.
  [[nodiscard]] bool good() const { return good_; }
  /// The last field was taken.
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  std::string_view rest_;
  bool good_ = true;
  bool ended_ = false;
};

}  // namespace marey::recordings
