// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/yaml_reader.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace marey::recordings {
namespace {

/// Limits far above any calibration: references can make a short file endless.
constexpr int kMaxDepth = 32;
constexpr int kMaxValues = 1000000;

class YamlTree {
 public:
  /// Converts a node; nullopt: too deep or too large.
  std::optional<TomlValue> taken_over(const YAML::Node& node,
                                      int parent_line,
                                      int depth) {
    if (depth > kMaxDepth || ++values_ > kMaxValues) return std::nullopt;
    TomlValue value;
    value.line = node.Mark().line >= 0 ? node.Mark().line + 1 : parent_line;
    if (node.IsMap()) {
      std::vector<TomlEntry> entries;
      for (const auto& entry : node) {
        const YAML::Node& key = entry.first;
        auto inner = taken_over(entry.second, value.line, depth + 1);
        if (!inner) return std::nullopt;
        const int line = key.Mark().line >= 0 ? key.Mark().line + 1 : value.line;
        entries.push_back({key.Scalar(), std::move(*inner), line});
      }
      value.content = std::move(entries);
    } else if (node.IsSequence()) {
      std::vector<TomlValue> items;
      for (const YAML::Node& item : node) {
        auto inner = taken_over(item, value.line, depth + 1);
        if (!inner) return std::nullopt;
        items.push_back(std::move(*inner));
      }
      value.content = std::move(items);
    } else if (node.IsScalar()) {
      // Quoted words have the tag "!".
      if (node.Tag() == "!") {
        value.content = node.Scalar();
      } else {
        value = value_of_word(node.Scalar(), value.line);
      }
    }
    return value;
  }

 private:
  int values_ = 0;
};

/// OpenCV begins with "%YAML:1.0", which is not a valid directive; it is replaced by
/// blanks, so that lines keep their numbers.
std::string without_directive(std::string_view text) {
  std::string blanked(text);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (blanked.starts_with(kByteOrderMark)) blanked.erase(0, kByteOrderMark.size());
  if (!blanked.starts_with("%YAML")) return blanked;
  const std::size_t end = std::min(blanked.find_first_of("\r\n"), blanked.size());
  std::fill_n(blanked.begin(), end, ' ');
  return blanked;
}

}  // namespace

TomlValue value_of_word(std::string_view word, int line) {
  TomlValue value{std::string(word), line};
  if (word == "true" || word == "True") value.content = true;
  if (word == "false" || word == "False") value.content = false;
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  std::int64_t whole = 0;
  if (const auto [at, ec] = std::from_chars(word.data(), end, whole);
      ec == std::errc() && at == end) {
    value.content = whole;
    return value;
  }
  double real = 0.0;
  if (const auto [at, ec] = std::from_chars(word.data(), end, real);
      ec == std::errc() && at == end && !word.empty()) {
    value.content = real;
  }
  return value;
}

Result<TomlDocument> parse_yaml(std::string_view text, const std::string& file) {
  try {
    const YAML::Node root = YAML::Load(without_directive(text));
    if (!root.IsMap()) {
      return bad_input(file_and_line(file, 1),
                       "not a map of keys and values",
                       "name a calibration that OpenCV, Kalibr or TagSLAM wrote");
    }
    auto tree = YamlTree().taken_over(root, 1, 0);
    if (!tree) {
      return bad_input(file,
                       "its lists or references have no end",
                       "write the numbers out, without & and *");
    }
    return TomlDocument{file, std::move(*tree), std::nullopt, "calibration.md"};
  } catch (const YAML::Exception& problem) {
    return bad_input(file_and_line(file, std::max(0, problem.mark.line) + 1),
                     "not valid YAML: " + problem.msg,
                     "correct this line; https://yaml.org shows the grammar");
  }
}

}  // namespace marey::recordings
