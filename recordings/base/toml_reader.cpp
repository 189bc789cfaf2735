// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/toml_reader.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <toml++/toml.h>

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/base/nesting.h"
#include "recordings/base/number_text.h"
#include "recordings/base/other_kind.h"

namespace marey::recordings {
namespace {

using Array = std::vector<TomlValue>;
using Table = std::vector<TomlEntry>;

int line_of(const toml::source_region& region, int otherwise) {
  const auto line = static_cast<int>(region.begin.line);
  return line > 0 ? line : otherwise;
}

TomlValue taken_over(const toml::node& node, int parent_line);

Table taken_over(const toml::table& table, int line) {
  struct Placed {
    toml::source_position begin;
    TomlEntry entry;
  };
  std::vector<Placed> placed;
  for (const auto& [key, node] : table) {
    placed.push_back(
        {key.source().begin,
         {std::string(key.str()), taken_over(node, line), line_of(key.source(), line)}});
  }
  // toml++ sorts by name; the order of cameras is the order of the file.
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.begin < b.begin;
  });
  Table entries;
  for (Placed& one : placed) entries.push_back(std::move(one.entry));
  return entries;
}

TomlValue taken_over(const toml::node& node, int parent_line) {
  TomlValue value;
  value.line = line_of(node.source(), parent_line);
  if (const auto* table = node.as_table()) {
    value.content = taken_over(*table, value.line);
  } else if (const auto* array = node.as_array()) {
    Array items;
    for (const toml::node& item : *array) items.push_back(taken_over(item, value.line));
    value.content = std::move(items);
  } else if (const auto* text = node.as_string()) {
    value.content = text->get();
  } else if (const auto* whole = node.as_integer()) {
    value.content = whole->get();
  } else if (const auto* real = node.as_floating_point()) {
    value.content = real->get();
  } else if (const auto* truth = node.as_boolean()) {
    value.content = truth->get();
  }
  return value;
}

/// Returns the number, if it is one and finite.
std::optional<double> as_number(const TomlValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value.content)) {
    return static_cast<double>(*whole);
  }
  const auto* real = std::get_if<double>(&value.content);
  if (real == nullptr || !std::isfinite(*real)) return std::nullopt;
  return *real;
}

std::string page_path(std::string_view page) {
  return "docs/formats/" + std::string(page);
}

std::string as_the_page_shows(std::string_view page) {
  return "write it as " + page_path(page) + " shows";
}

}  // namespace

std::string file_and_line(const std::string& file, int line) {
  std::string text = file;
  text += ':';
  append_exact(text, line);
  return text;
}

Result<TomlDocument> parse_toml(std::string_view text,
                                const std::string& file,
                                std::string_view page) {
  if (const std::string_view other = other_kind(text); !other.empty()) {
    return bad_input(file,
                     "this is " + std::string(other) + ", not a TOML file",
                     "give a .toml file as " + page_path(page) + " describes it");
  }
  if (toml_nests_too_deep(text)) {
    return bad_input(
        file,
        "its tables and lists nest more than " + std::to_string(kMaxNesting) + " deep",
        as_the_page_shows(page));
  }
  try {
    const toml::table table = toml::parse(text, file);
    return TomlDocument{file, TomlValue{taken_over(table, 1), 1}, std::nullopt, page};
  } catch (const toml::parse_error& problem) {
    return bad_input(file_and_line(file, line_of(problem.source(), 1)),
                     "not valid TOML: " + std::string(problem.description()),
                     "correct this line; https://toml.io shows the grammar");
  }
}

TomlReader::TomlReader(TomlDocument& document)
    : TomlReader(document, &document.root, "") {}

TomlReader::TomlReader(TomlDocument& document, const TomlValue* value, std::string name)
    : document_(&document), value_(value), name_(std::move(name)) {
  const Table* table = value_ ? std::get_if<Table>(&value_->content) : nullptr;
  if (table == nullptr) return;
  by_key_.resize(table->size());
  std::iota(by_key_.begin(), by_key_.end(), std::size_t{0});
  // Stable: of equal keys, which YAML may have, the first is used.
  std::stable_sort(by_key_.begin(), by_key_.end(), [&](std::size_t a, std::size_t b) {
    return (*table)[a].key < (*table)[b].key;
  });
}

const TomlEntry* TomlReader::entry(std::string_view key) const {
  const Table* table = value_ ? std::get_if<Table>(&value_->content) : nullptr;
  if (table == nullptr) return nullptr;
  const auto at = std::lower_bound(
      by_key_.begin(), by_key_.end(), key, [&](std::size_t i, std::string_view wanted) {
        return (*table)[i].key < wanted;
      });
  if (at == by_key_.end() || (*table)[*at].key != key) return nullptr;
  return &(*table)[*at];
}

const TomlValue* TomlReader::find(std::string_view key) const {
  const TomlEntry* found = entry(key);
  return found ? &found->value : nullptr;
}

bool TomlReader::is_table(std::string_view key) const {
  const TomlValue* value = find(key);
  return value != nullptr && std::holds_alternative<Table>(value->content);
}

bool TomlReader::is_text(std::string_view key) const {
  const TomlValue* value = find(key);
  return value != nullptr && std::holds_alternative<std::string>(value->content);
}

int TomlReader::line(std::string_view key) const {
  if (const TomlEntry* found = entry(key)) return found->line;
  const bool is_table = value_ && std::holds_alternative<Table>(value_->content);
  return is_table ? value_->line : 1;
}

void TomlReader::fail(std::string_view key, std::string cause, std::string next) {
  if (!ok()) return;
  document_->mistake = bad_input(
      file_and_line(document_->file, line(key)), std::move(cause), std::move(next));
}

void TomlReader::allow(std::span<const std::string_view> keys) {
  for (const std::string& key : this->keys()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string cause = "unknown key " + in_quotes(key);
    if (!name_.empty()) cause.append(" in ").append(name_);
    fail(key, std::move(cause), suggestion(key, keys));
    return;
  }
}

std::vector<std::string> TomlReader::keys() const {
  std::vector<std::string> names;
  const Table* table = value_ ? std::get_if<Table>(&value_->content) : nullptr;
  if (table == nullptr) return names;
  for (const TomlEntry& entry : *table) names.push_back(entry.key);
  return names;
}

const TomlValue* TomlReader::require(std::string_view key) {
  if (!ok()) return nullptr;
  const TomlValue* value = find(key);
  if (value == nullptr) {
    std::string cause = "the key " + in_quotes(key) + " is missing";
    if (!name_.empty()) cause.append(" in ").append(name_);
    fail("", std::move(cause), "add it; " + page_path(document_->page) + " describes it");
  }
  return value;
}

template <class T>
const T* TomlReader::require_as(std::string_view key, std::string_view type) {
  const TomlValue* value = require(key);
  if (value == nullptr) return nullptr;
  const T* content = std::get_if<T>(&value->content);
  if (content == nullptr) {
    fail(key,
         (in_quotes(key) + " must be ").append(type),
         as_the_page_shows(document_->page));
  }
  return content;
}

std::string TomlReader::text(std::string_view key) {
  const auto* text = require_as<std::string>(key, "text in quotes");
  return text ? *text : std::string();
}

bool TomlReader::boolean(std::string_view key) {
  const auto* truth = require_as<bool>(key, "true or false");
  return truth != nullptr && *truth;
}

double TomlReader::number(std::string_view key, const Limits& limits) {
  const TomlValue* value = require(key);
  if (value == nullptr) return 0.0;
  const std::optional<double> number = as_number(*value);
  if (!number) {
    const bool is_real = std::holds_alternative<double>(value->content);
    fail(key,
         in_quotes(key) +
             (is_real ? " must be a number that is finite" : " must be a number"),
         as_the_page_shows(document_->page));
    return 0.0;
  }
  if (*number >= limits.low && *number <= limits.high) return *number;
  std::string cause = in_quotes(key) + " is ";
  append_exact(cause, *number);
  cause += ", not between ";
  append_exact(cause, limits.low);
  cause += " and ";
  append_exact(cause, limits.high);
  if (!limits.unit.empty()) cause.append(" ").append(limits.unit);
  fail(key,
       std::move(cause),
       limits.unit.empty() ? "correct the number"
                           : std::string("give it in ").append(limits.unit));
  return 0.0;
}

int TomlReader::integer(std::string_view key, const Limits& limits) {
  const double value = number(key, limits);
  if (value == std::floor(value)) return static_cast<int>(value);
  fail(key, in_quotes(key) + " must be a whole number", "correct the number");
  return 0;
}

std::size_t TomlReader::count(std::string_view key) const {
  const TomlValue* value = find(key);
  const Array* array = value ? std::get_if<Array>(&value->content) : nullptr;
  return array ? array->size() : 0;
}

bool TomlReader::is_matrix(std::string_view key) const {
  const TomlValue* value = find(key);
  const Array* array = value ? std::get_if<Array>(&value->content) : nullptr;
  return array != nullptr && !array->empty() &&
         std::holds_alternative<Array>(array->front().content);
}

void TomlReader::append_numbers(std::string_view key,
                                const TomlValue& value,
                                std::size_t count,
                                std::vector<double>& out) {
  const Array* array = std::get_if<Array>(&value.content);
  const std::size_t start = out.size();
  if (array != nullptr && array->size() == count) {
    for (const TomlValue& item : *array) {
      const std::optional<double> number = as_number(item);
      if (!number) break;
      out.push_back(*number);
    }
  }
  if (out.size() == start + count) return;
  std::string cause = in_quotes(key) + " must be an array of ";
  append_exact(cause, static_cast<int>(count));
  fail(key, cause + " numbers", as_the_page_shows(document_->page));
  out.resize(start + count);
}

std::vector<std::string> TomlReader::texts(std::string_view key) {
  std::vector<std::string> values;
  const auto* array = require_as<Array>(key, "a list of texts in quotes");
  if (array == nullptr) return values;
  for (const TomlValue& item : *array) {
    if (const auto* text = std::get_if<std::string>(&item.content)) {
      values.push_back(*text);
    } else {
      fail(key,
           in_quotes(key) + " must be a list of texts in quotes",
           as_the_page_shows(document_->page));
    }
  }
  return values;
}

std::vector<double> TomlReader::numbers(std::string_view key, std::size_t count) {
  std::vector<double> values;
  if (const TomlValue* array = require(key)) append_numbers(key, *array, count, values);
  values.resize(count);
  return values;
}

std::vector<double> TomlReader::matrix(std::string_view key,
                                       std::size_t rows,
                                       std::size_t columns) {
  std::vector<double> values;
  if (const auto* array = require_as<Array>(key, "an array of rows")) {
    if (array->size() != rows) {
      fail(key,
           in_quotes(key) + " has the wrong number of rows",
           as_the_page_shows(document_->page));
    }
    for (const TomlValue& row : *array) append_numbers(key, row, columns, values);
  }
  values.resize(rows * columns);
  return values;
}

TomlReader TomlReader::table(std::string_view key) {
  const std::string name = name_.empty() ? std::string("[").append(key).append("]")
                                         : std::string(key).append(" of ").append(name_);
  const bool is_table = require_as<Table>(key, "a table") != nullptr;
  return {*document_, is_table ? find(key) : nullptr, name};
}

std::vector<TomlReader> TomlReader::tables(std::string_view key) {
  std::vector<TomlReader> readers;
  if (!has(key)) return readers;
  const auto* array = require_as<Array>(key, "a list of tables, each under [[...]]");
  if (array == nullptr) return readers;
  for (const TomlValue& item : *array) {
    if (!std::holds_alternative<Table>(item.content)) {
      fail(key,
           in_quotes(key) + " must hold tables only",
           as_the_page_shows(document_->page));
    }
    readers.push_back({*document_, &item, std::string("[[").append(key).append("]]")});
  }
  return readers;
}

}  // namespace marey::recordings
