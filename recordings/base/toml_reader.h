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
#include <utility>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "recordings/base/text_reader.h"

namespace marey::recordings {

struct TomlEntry;

/// A value of a TOML file; monostate is a date or a time, which marey does not use.
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
  int line = 1;  ///< Line of the key.
};

/// A parsed file, and the first mistake found by its readers.
struct TomlDocument {
  std::string file;  ///< Its name in error messages.
  TomlValue root;    ///< A table.
  std::optional<Error> mistake;
  /// The page of docs/formats that describes such files.
  std::string_view page = "README.md";
};

/// Parses `text`. `page` is the page of docs/formats that describes such files; error
/// messages name it. Errors (kBadInput): not TOML, with the line, or with the kind of
/// file that it is instead.
[[nodiscard]] Result<TomlDocument> parse_toml(std::string_view text,
                                              const std::string& file,
                                              std::string_view page = "README.md");

/// Allowed range of a number. Both ends included.
struct Limits {
  double low = 0.0;
  double high = 0.0;
  std::string_view unit = "";  ///< The unit in messages: "m".
};

/// Reads one table of a document. A mistake is stored in the document, and every value
/// read after it is empty or zero. A caller therefore checks `document.mistake` once, at
/// the end, or before a wrong value would do harm. Only the first mistake is stored. The
/// document must not be moved. Cost: a sort of the table's keys at construction,
/// logarithmic in them for each value.
class TomlReader {
 public:
  /// Reads the whole file.
  explicit TomlReader(TomlDocument& document);

  /// Checks the keys. Mistake: the table has a key that is not one of `keys`.
  void allow(std::span<const std::string_view> keys);
  void allow(std::initializer_list<std::string_view> keys) {
    allow(std::span(keys.begin(), keys.size()));
  }

  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] bool is_table(std::string_view key) const;
  [[nodiscard]] bool is_text(std::string_view key) const;
  /// Returns every key, in the order of the file.
  [[nodiscard]] std::vector<std::string> keys() const;

  // Each returns the value of `key`. Mistakes: the key is missing, of another type, out
  // of its limits. Numbers are finite; an integer is accepted as a number.
  [[nodiscard]] std::string text(std::string_view key);
  [[nodiscard]] bool boolean(std::string_view key);
  [[nodiscard]] double number(std::string_view key, const Limits& limits);
  [[nodiscard]] int integer(std::string_view key, const Limits& limits);
  /// Returns an array of texts of any length.
  [[nodiscard]] std::vector<std::string> texts(std::string_view key);
  /// Returns an array of numbers. Mistake: their number is not `count`.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count);
  /// Returns an array of `rows` arrays of `columns` numbers, row after row.
  [[nodiscard]] std::vector<double> matrix(std::string_view key,
                                           std::size_t rows,
                                           std::size_t columns);
  /// Returns the number of values of the array `key`; 0 if it is not an array.
  [[nodiscard]] std::size_t count(std::string_view key) const;
  /// Returns true if `key` is an array whose first value is an array.
  [[nodiscard]] bool is_matrix(std::string_view key) const;
  [[nodiscard]] TomlReader table(std::string_view key);
  /// Returns the tables of [[key]]; empty if the key is missing.
  [[nodiscard]] std::vector<TomlReader> tables(std::string_view key);

  /// Changes the table's name in messages: "filter@1" instead of "[[op]]".
  void set_name(std::string name) { name_ = std::move(name); }
  /// Stores a mistake found by the caller, at the line of `key`, or at the table's if it
  /// has no such key.
  void fail(std::string_view key, std::string cause, std::string next);
  /// Returns true if no mistake was found so far, anywhere in the document.
  [[nodiscard]] bool ok() const { return !document_->mistake; }
  /// Returns the line of `key`, or the table's if it has no such key.
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
  const TomlValue* value_;           ///< Null after a mistake.
  std::vector<std::size_t> by_key_;  ///< Entries in the order of their keys.
  std::string name_;                 ///< "[subject]"; empty for the root.
};

/// Returns "session.toml:12".
[[nodiscard]] std::string file_and_line(const std::string& file, int line);

}  // namespace marey::recordings
