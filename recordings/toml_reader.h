// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/result.h"
#include "recordings/text_reader.h"

namespace marey::recordings {

struct TomlEntry;

/// A value of a TOML file; monostate is a date or a time, which marey never asks for.
/// Tables keep the order of the file.
struct TomlValue {
  std::variant<std::monostate,
               bool,
               std::int64_t,
               double,
               std::string,
               std::vector<TomlValue>,
               std::vector<TomlEntry>>
      content;
  int line = 1;
};

struct TomlEntry {
  std::string key;
  TomlValue value;
  int line = 1;  ///< Of the key.
};

/// A parsed file, and the first mistake that its readers found in it.
struct TomlDocument {
  std::string file;  ///< What error messages call it.
  TomlValue root;    ///< A table.
  std::optional<Error> mistake;
};

/// Parses `text`. Errors: not TOML, with the line.
[[nodiscard]] Result<TomlDocument> parse_toml(std::string_view text,
                                              const std::string& file);

/// What a number may be. Both ends included.
struct Limits {
  double low = 0.0;
  double high = 0.0;
  std::string_view unit = "";  ///< As messages should say it: "m".
};

/// Reads one table of a document. A mistake is kept in the document and everything read
/// after it is empty or zero, so that a caller reads on and looks at
/// `document.mistake` once, at the end, or where a wrong value would do harm. Of several
/// mistakes the first met counts. The document must stay in place. Cost: a sort of the
/// table's keys to make one, their logarithm for each value.
class TomlReader {
 public:
  /// The whole file.
  explicit TomlReader(TomlDocument& document);

  /// Mistake: the table has a key that is not one of `keys`.
  void allow(std::span<const std::string_view> keys);
  void allow(std::initializer_list<std::string_view> keys) {
    allow(std::span(keys.begin(), keys.size()));
  }

  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] bool is_table(std::string_view key) const;
  /// Every key, in the order of the file.
  [[nodiscard]] std::vector<std::string> keys() const;

  // Each takes the value of `key`. Mistakes: the key is missing, of another type, out of
  // its limits. Numbers are finite; a number without a point is as good as one with.
  [[nodiscard]] std::string text(std::string_view key);
  [[nodiscard]] bool boolean(std::string_view key);
  [[nodiscard]] double number(std::string_view key, const Limits& limits);
  [[nodiscard]] int integer(std::string_view key, const Limits& limits);
  /// An array of numbers. Mistake: not `count` of them.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count);
  /// An array of `rows` arrays of `columns` numbers, row after row.
  [[nodiscard]] std::vector<double> matrix(std::string_view key,
                                           std::size_t rows,
                                           std::size_t columns);
  /// How many values the array `key` has; 0 when it is not an array.
  [[nodiscard]] std::size_t count(std::string_view key) const;
  /// `key` is an array whose first value is an array.
  [[nodiscard]] bool is_matrix(std::string_view key) const;
  [[nodiscard]] TomlReader table(std::string_view key);
  /// [[key]]. Empty when the key is missing.
  [[nodiscard]] std::vector<TomlReader> tables(std::string_view key);

  /// A mistake that only the caller could find, at the line of `key`, or at the table's
  /// when it has no such key.
  void fail(std::string_view key, std::string cause, std::string next);
  /// No mistake so far, anywhere in the document.
  [[nodiscard]] bool ok() const { return !document_->mistake; }
  /// The line of `key`, or the table's when it has no such key.
  [[nodiscard]] int line(std::string_view key = "") const;

 private:
  TomlReader(TomlDocument& document, const TomlValue* value, std::string name);

  [[nodiscard]] const TomlEntry* entry(std::string_view key) const;
  [[nodiscard]] const TomlValue* find(std::string_view key) const;
  [[nodiscard]] const TomlValue* require(std::string_view key);
  template <class T>
  [[nodiscard]] const T* require_as(std::string_view key, std::string_view type);
  void append_numbers(std::string_view key,
                      const TomlValue& array,
                      std::size_t count,
                      std::vector<double>& out);

  TomlDocument* document_;
  const TomlValue* value_;  ///< Null below a mistake.
  std::vector<std::size_t> by_key_;  ///< Entries in the order of their keys.
  std::string name_;        ///< "[subject]"; empty for the root.
};

/// "session.toml:12"
[[nodiscard]] std::string file_and_line(const std::string& file, int line);

}  // namespace marey::recordings
