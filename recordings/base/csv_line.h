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

/// Returns the lines of a text one by one and counts them. Lines end with LF or CRLF.
/// Borrows the text.
class CsvLines {
 public:
  explicit CsvLines(std::string_view text) : rest_(text) {}

  /// Returns the next line without its end; nullopt after the last. An empty line at the
  /// very end of the text does not count.
  [[nodiscard]] std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number_;
    return line;
  }

  /// Returns the number of the last line returned, from 1.
  [[nodiscard]] int number() const { return number_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// Returns the fields of one line from left to right, without copies. A field that is
/// missing or of another type makes the line bad; the caller checks once, at the end of
/// the line. marey's tables contain no quotes, so a comma always ends a field.
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

  /// Returns the next field as a finite number that occupies the whole field.
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

  /// Returns true if every field so far was present and valid.
  [[nodiscard]] bool good() const { return good_; }
  /// Returns true after the last field.
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  std::string_view rest_;
  bool good_ = true;
  bool ended_ = false;
};

}  // namespace marey::recordings
