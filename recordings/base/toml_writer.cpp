// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/toml_writer.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "recordings/base/number_text.h"

namespace marey::recordings {
namespace {

bool may_stand_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         c == '_' || c == '-';
}

}  // namespace

void TomlWriter::append_quoted(std::string_view value) {
  constexpr std::string_view kHex = "0123456789abcdef";
  text_ += '"';
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      text_ += '\\';
      text_ += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      text_ += "\\u00";
      text_ += kHex[byte / 16];
      text_ += kHex[byte % 16];
    } else {
      text_ += c;
    }
  }
  text_ += '"';
}

void TomlWriter::append_key(std::string_view key) {
  if (!key.empty() && std::all_of(key.begin(), key.end(), may_stand_bare)) {
    text_ += key;
  } else {
    append_quoted(key);
  }
}

void TomlWriter::append_number(double value) {
  MAREY_ASSERT(std::isfinite(value));
  const std::size_t at = text_.size();
  append_exact(text_, value);
  // Without a point or an exponent TOML would make it an integer.
  if (text_.find_first_of(".e", at) == std::string::npos) text_ += ".0";
}

void TomlWriter::append_row(std::span<const double> values) {
  text_ += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text_ += ", ";
    append_number(values[i]);
  }
  text_ += ']';
}

void TomlWriter::start_line(std::string_view key) {
  append_key(key);
  text_ += " = ";
}

void TomlWriter::comment(std::string_view line) {
  text_.append("# ").append(line).append("\n");
}

void TomlWriter::table(std::initializer_list<std::string_view> path) {
  text_ += text_.empty() ? "[" : "\n[";
  for (const std::string_view* part = path.begin(); part != path.end(); ++part) {
    if (part != path.begin()) text_ += '.';
    append_key(*part);
  }
  text_ += "]\n";
}

void TomlWriter::array_table(std::string_view name) {
  text_ += text_.empty() ? "[[" : "\n[[";
  append_key(name);
  text_ += "]]\n";
}

void TomlWriter::text(std::string_view key, std::string_view value) {
  start_line(key);
  append_quoted(value);
  text_ += '\n';
}

void TomlWriter::texts(std::string_view key, std::span<const std::string_view> values) {
  start_line(key);
  text_ += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text_ += ", ";
    append_quoted(values[i]);
  }
  text_ += "]\n";
}

void TomlWriter::boolean(std::string_view key, bool value) {
  start_line(key);
  text_ += value ? "true\n" : "false\n";
}

void TomlWriter::integer(std::string_view key, int value) {
  start_line(key);
  append_exact(text_, value);
  text_ += '\n';
}

void TomlWriter::integers(std::string_view key, std::initializer_list<int> values) {
  start_line(key);
  text_ += '[';
  for (const int* value = values.begin(); value != values.end(); ++value) {
    if (value != values.begin()) text_ += ", ";
    append_exact(text_, *value);
  }
  text_ += "]\n";
}

void TomlWriter::number(std::string_view key, double value) {
  start_line(key);
  append_number(value);
  text_ += '\n';
}

void TomlWriter::numbers(std::string_view key, std::span<const double> values) {
  start_line(key);
  append_row(values);
  text_ += '\n';
}

void TomlWriter::matrix(std::string_view key,
                        std::span<const double> values,
                        std::size_t columns) {
  MAREY_ASSERT(columns > 0 && values.size() % columns == 0);
  start_line(key);
  text_ += '[';
  for (std::size_t at = 0; at < values.size(); at += columns) {
    if (at > 0) text_ += ", ";
    append_row(values.subspan(at, columns));
  }
  text_ += "]\n";
}

void TomlWriter::append_inline(const TomlWriter& keys) {
  text_ += '{';
  // Quoted texts hold no line ends: each line is one key.
  for (std::size_t at = 0; at < keys.text_.size();) {
    const std::size_t end = keys.text_.find('\n', at);
    text_ += at == 0 ? " " : ", ";
    text_.append(keys.text_, at, end - at);
    at = end + 1;
  }
  text_ += " }";
}

void TomlWriter::inline_table(std::string_view key, const TomlWriter& keys) {
  start_line(key);
  append_inline(keys);
  text_ += '\n';
}

void TomlWriter::inline_tables(std::string_view key, std::span<const TomlWriter> rows) {
  start_line(key);
  text_ += '[';
  for (const TomlWriter& row : rows) {
    text_ += "\n  ";
    append_inline(row);
    text_ += ',';
  }
  text_ += rows.empty() ? "]\n" : "\n]\n";
}

}  // namespace marey::recordings
