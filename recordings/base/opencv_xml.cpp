// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/opencv_xml.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "recordings/base/yaml_reader.h"

namespace marey::recordings {
namespace {

/// Starts of the lines, for repeated lookups.
class Lines {
 public:
  explicit Lines(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') ends_.push_back(static_cast<std::ptrdiff_t>(i));
    }
  }
  [[nodiscard]] int at(std::ptrdiff_t offset) const {
    const auto before = std::lower_bound(ends_.begin(), ends_.end(), offset);
    return 1 + static_cast<int>(before - ends_.begin());
  }

 private:
  std::vector<std::ptrdiff_t> ends_;
};

std::vector<TomlValue> words_of(std::string_view text, int line) {
  constexpr std::string_view kBlank = " \t\r\n";
  std::vector<TomlValue> words;
  for (std::size_t at = text.find_first_not_of(kBlank); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlank, at), text.size());
    words.push_back(value_of_word(text.substr(at, end - at), line));
    at = text.find_first_not_of(kBlank, end);
  }
  return words;
}

/// Returns a list for OpenCV's lists: unnamed elements "_", several words, or matrix
/// data.
TomlValue value_of(const pugi::xml_node& node, const Lines& lines, int depth) {
  constexpr int kMaxDepth = 32;
  TomlValue value;
  value.line = lines.at(node.offset_debug());
  std::vector<TomlValue> items;
  std::vector<TomlEntry> entries;
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() != pugi::node_element || depth > kMaxDepth) continue;
    TomlValue inner = value_of(child, lines, depth + 1);
    const int line = inner.line;
    if (std::string_view(child.name()) == "_") {
      items.push_back(std::move(inner));
    } else {
      entries.push_back({child.name(), std::move(inner), line});
    }
  }
  if (!entries.empty()) {
    value.content = std::move(entries);
  } else if (!items.empty()) {
    value.content = std::move(items);
  } else {
    std::vector<TomlValue> words = words_of(node.child_value(), value.line);
    const bool is_list = words.size() != 1 || std::string_view(node.name()) == "data";
    value.content = is_list ? TomlValue{std::move(words)}.content : words[0].content;
  }
  return value;
}

}  // namespace

Result<TomlDocument> parse_opencv_xml(std::string_view text, const std::string& file) {
  const Lines lines(text);
  pugi::xml_document xml;
  const pugi::xml_parse_result parsed = xml.load_buffer(text.data(), text.size());
  if (!parsed) {
    return bad_input(file_and_line(file, lines.at(parsed.offset)),
                     std::string("not valid XML: ") + parsed.description(),
                     "correct this line, or copy the file again");
  }
  const pugi::xml_node root = xml.child("opencv_storage");
  if (!root) {
    return bad_input(file_and_line(file, 1),
                     "has no <opencv_storage>",
                     "name a calibration that OpenCV wrote");
  }
  TomlValue tree = value_of(root, lines, 0);
  if (!std::holds_alternative<std::vector<TomlEntry>>(tree.content)) {
    tree.content = std::vector<TomlEntry>();
  }
  return TomlDocument{file, std::move(tree), std::nullopt, "calibration.md"};
}

}  // namespace marey::recordings
