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

#include "core/base/result.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings {

/// Returns true if `text` is UTF-8 (RFC 3629): no overlong forms, no surrogates.
[[nodiscard]] bool is_utf8(std::string_view text);

/// Reads the elements of an XML text by their expected types. As with TomlReader, the
/// first mistake is stored and every value read after it is empty or zero: check
/// mistake() once, at the end.
class XmlReader {
 public:
  /// Copies the text. `file` is its name in messages.
  XmlReader(std::string_view text, std::string file);

  /// Parses the text and returns its only element, `name`; null after a mistake: no XML,
  /// not UTF-8, another element, or more than one.
  [[nodiscard]] pugi::xml_node root(const char* name);

  /// Returns the only child of this name; null if there is none. Two are a mistake.
  [[nodiscard]] pugi::xml_node child(pugi::xml_node parent, const char* name);
  /// Returns child(). A missing child is a mistake.
  [[nodiscard]] pugi::xml_node need(pugi::xml_node parent, const char* name);

  /// Returns the text of the element without surrounding blanks: one line of UTF-8. Child
  /// elements are a mistake. Empty for a null node.
  [[nodiscard]] std::string text(pugi::xml_node node);
  /// Returns text(). An empty one is a mistake.
  [[nodiscard]] std::string name(pugi::xml_node node);
  /// Returns a finite number within `limits`. 0 for a null node.
  [[nodiscard]] double number(pugi::xml_node node, const Limits& limits);
  [[nodiscard]] int integer(pugi::xml_node node, const Limits& limits);

  /// Handles the content other than the children `known`. Elements are appended to
  /// `unknown` as written in the file, or dropped if it is null; attributes are dropped.
  /// Each adds a note. Text between the elements is a mistake.
  void keep_unknown(pugi::xml_node node,
                    std::span<const std::string_view> known,
                    std::vector<std::string>* unknown);
  /// Returns the element as written in the file, from its first bracket to its last.
  [[nodiscard]] std::string verbatim(pugi::xml_node node) const;

  /// Stores a mistake at the line of `node`, unless there is one already.
  void fail(pugi::xml_node node, std::string cause, std::string next);
  void note(pugi::xml_node node, std::string_view text);
  [[nodiscard]] int line(pugi::xml_node node) const;

  [[nodiscard]] const std::optional<Error>& mistake() const { return mistake_; }
  /// Returns the notes in order of detection; the last one counts the omitted ones.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  [[nodiscard]] bool require_text();
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

/// Appends `text` with XML's reserved characters written as entities.
void append_xml_text(std::string& xml, std::string_view text);

}  // namespace marey::recordings
