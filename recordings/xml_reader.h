// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "core/result.h"
#include "recordings/toml_reader.h"

namespace marey::recordings {

/// Whether `text` is UTF-8 (RFC 3629): no overlong forms, no surrogates.
[[nodiscard]] bool is_utf8(std::string_view text);

/// Reads the elements of an XML text by what they should hold. As with TomlReader, the
/// first mistake is kept and everything read after it is empty or zero: read on, and
/// look at mistake() once.
class XmlReader {
 public:
  /// `file` is what messages call the text, which is copied.
  XmlReader(std::string_view text, std::string file);

  /// Parses the text. Its one element, `name`; null after a mistake: no XML, not UTF-8,
  /// another element, or more than one.
  [[nodiscard]] pugi::xml_node root(const char* name);

  /// The only child of this name; null when there is none. Two are a mistake.
  [[nodiscard]] pugi::xml_node child(pugi::xml_node parent, const char* name);
  /// child(); none is a mistake.
  [[nodiscard]] pugi::xml_node need(pugi::xml_node parent, const char* name);

  /// What the element says, blanks at both ends taken away: one line of UTF-8. Elements
  /// in it are a mistake. Empty for a null node.
  [[nodiscard]] std::string text(pugi::xml_node node);
  /// text(); an empty one is a mistake.
  [[nodiscard]] std::string name(pugi::xml_node node);
  /// A finite number within `limits`. 0 for a null node.
  [[nodiscard]] double number(pugi::xml_node node, const Limits& limits);
  [[nodiscard]] int integer(pugi::xml_node node, const Limits& limits);

  /// What else the element holds than the children `known`: elements are appended to
  /// `unknown` as the file writes them, or not kept when it is null; attributes are not
  /// kept; each with a note. Text between the elements is a mistake.
  void keep_unknown(pugi::xml_node node,
                    std::span<const std::string_view> known,
                    std::vector<std::string>* unknown);
  /// The element as the file writes it, from its first bracket to its last.
  [[nodiscard]] std::string verbatim(pugi::xml_node node) const;

  /// Keeps a mistake at the line of `node`, unless there is one already.
  void fail(pugi::xml_node node, std::string cause, std::string next);
  void note(pugi::xml_node node, std::string_view text);
  [[nodiscard]] int line(pugi::xml_node node) const;

  [[nodiscard]] const std::optional<Error>& mistake() const { return mistake_; }
  /// Told in the order in which they were met; the last says how many more there are.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  [[nodiscard]] bool check_bytes();
  [[nodiscard]] int line_at(std::size_t offset) const;
  void fail_at(std::size_t offset, std::string cause, std::string next);

  std::string text_;
  std::string file_;
  std::vector<std::size_t> line_starts_;
  pugi::xml_document xml_;
  std::optional<Error> mistake_;
  std::vector<std::string> notes_;
  std::size_t notes_left_out_ = 0;
};

/// Appends `text` with what XML reserves written as entities.
void append_xml_text(std::string& xml, std::string_view text);

}  // namespace marey::recordings
