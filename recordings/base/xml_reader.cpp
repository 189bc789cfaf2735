// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/xml_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/in_quotes.h"
#include "core/base/utf8.h"
#include "core/nearest_word.h"
#include "recordings/base/number_text.h"
#include "recordings/base/text_reader.h"

namespace marey::recordings {
namespace {

constexpr std::string_view kXmlBlank = " \t\r\n";
constexpr std::size_t kMaxNotes = 20;

std::string in_brackets(std::string_view name) {
  return std::string("<").append(name).append(">");
}

/// Returns the position after the next `end`, from `at` on.
std::size_t past(std::string_view text, std::size_t at, std::string_view end) {
  const std::size_t found = text.find(end, at);
  return found == std::string_view::npos ? text.size() : found + end.size();
}

/// Returns the position of the bracket that closes the tag beginning at `at`; brackets in
/// quotes are ignored.
std::size_t end_of_tag(std::string_view text, std::size_t at) {
  for (char quote = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      break;
    }
  }
  return at;
}

/// Returns the position after the element whose first bracket is at `at`, in a parsed
/// text.
std::size_t end_of_element(std::string_view text, std::size_t at) {
  for (int depth = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = past(text, at + 4, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      at = past(text, at, "]]>");
    } else if (rest.starts_with("<?")) {
      at = past(text, at, "?>");
    } else {
      const std::size_t end = end_of_tag(text, at);
      const bool closes = rest.starts_with("</");
      const bool is_empty = end < text.size() && text[end - 1] == '/';
      if (closes) --depth;
      if (!closes && !is_empty) ++depth;
      at = std::min(end + 1, text.size());
      if (depth == 0) return at;
    }
    at = std::min(text.find('<', at), text.size());
  }
  return at;
}

std::string_view trimmed_xml(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kXmlBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kXmlBlank) - first + 1);
}

bool is_text(const pugi::xml_node& node) {
  return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const auto next = first_utf8(text);
    if (!next) return false;
    text.remove_prefix(next->bytes);
  }
  return true;
}

XmlReader::XmlReader(std::string_view text, std::string file) : file_(std::move(file)) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  text_ = text;
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
  }
}

int XmlReader::line_at(std::size_t offset) const {
  const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  return static_cast<int>(next - line_starts_.begin());
}

int XmlReader::line(pugi::xml_node node) const {
  return line_at(
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)));
}

void XmlReader::fail_at(std::size_t offset, std::string cause, std::string next) {
  if (mistake_) return;
  mistake_ =
      bad_input(file_and_line(file_, line_at(offset)), std::move(cause), std::move(next));
}

void XmlReader::fail(pugi::xml_node node, std::string cause, std::string next) {
  const auto offset = std::max<std::ptrdiff_t>(node.offset_debug(), 0);
  fail_at(static_cast<std::size_t>(offset), std::move(cause), std::move(next));
}

void XmlReader::note(pugi::xml_node node, std::string_view text) {
  if (notes_.size() >= kMaxNotes) {
    ++notes_left_out_;
    return;
  }
  notes_.push_back(file_and_line(file_, line(node)).append(": ").append(text));
}

std::vector<std::string> XmlReader::notes() const {
  std::vector<std::string> all = notes_;
  if (notes_left_out_ > 0) {
    all.push_back(file_ + ": " + std::to_string(notes_left_out_) +
                  " more notes are left out");
  }
  return all;
}

bool XmlReader::require_text() {
  const auto odd = std::find_if(text_.begin(), text_.end(), [](char c) {
    return is_control(c) && c != '\t' && c != '\r' && c != '\n';
  });
  if (odd != text_.end() || !is_utf8(text_)) {
    fail_at(static_cast<std::size_t>(odd != text_.end() ? odd - text_.begin() : 0),
            "this is not UTF-8 text",
            "name an XML file, or save it as UTF-8");
  }
  return !mistake_;
}

pugi::xml_node XmlReader::root(const char* name) {
  if (!require_text()) return {};
  if (text_.find_first_not_of(" \t\r\n") == std::string::npos) {
    fail_at(0, "the file is empty", "copy or export it again");
    return {};
  }
  if (text_.find('<') == std::string::npos) {
    fail_at(0, "this is not an XML file", "name an XML file");
    return {};
  }
  const pugi::xml_parse_result parsed = xml_.load_buffer(
      text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed) {
    const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0));
    const bool is_cut_off = parsed.status != pugi::status_no_document_element &&
                            text_.find('>', at) == std::string::npos;
    fail_at(at,
            is_cut_off ? "the file ends before its elements do"
                       : std::string("not valid XML: ") + parsed.description(),
            is_cut_off ? "copy the file again, or close what is open"
                       : "correct this line, or copy the file again");
    return {};
  }
  const pugi::xml_node root = xml_.document_element();
  if (std::string_view(root.name()) != name) {
    fail(
        root,
        "this is a file of " + in_brackets(root.name()) + ", not of " + in_brackets(name),
        "name another file");
    return {};
  }
  for (pugi::xml_node next = root.next_sibling(); next; next = next.next_sibling()) {
    if (next.type() != pugi::node_element) continue;
    fail(next,
         in_brackets(next.name()) + " is after the end of " + in_brackets(name),
         "move it inside, or remove it");
    return {};
  }
  return root;
}

pugi::xml_node XmlReader::child(pugi::xml_node parent, const char* name) {
  const pugi::xml_node first = parent.child(name);
  if (const pugi::xml_node second = first.next_sibling(name)) {
    fail(second,
         in_brackets(name) + " is given twice, first on line " +
             std::to_string(line(first)),
         "remove one");
  }
  return first;
}

pugi::xml_node XmlReader::need(pugi::xml_node parent, const char* name) {
  const pugi::xml_node found = child(parent, name);
  if (!found && parent) {
    fail(parent, in_brackets(parent.name()) + " has no " + in_brackets(name), "add it");
  }
  return found;
}

std::string XmlReader::text(pugi::xml_node node) {
  std::string whole;
  for (const pugi::xml_node& part : node.children()) {
    if (part.type() == pugi::node_element) {
      fail(part,
           in_brackets(node.name()) + " holds " + in_brackets(part.name()) +
               " instead of a value",
           "write the value alone");
    }
    if (is_text(part)) whole += part.value();
  }
  whole = trimmed_xml(whole);
  if (std::any_of(whole.begin(), whole.end(), is_control) || !is_utf8(whole)) {
    fail(node, in_brackets(node.name()) + " is not one line of text", "correct it");
    return {};
  }
  return whole;
}

std::string XmlReader::name(pugi::xml_node node) {
  std::string found = text(node);
  if (node && found.empty()) {
    fail(node, in_brackets(node.name()) + " is empty", "give it a value");
  }
  return found;
}

double XmlReader::number(pugi::xml_node node, const Limits& limits) {
  if (!node) return 0.0;
  const std::string word = text(node);
  const std::optional<double> value = to_number(word);
  if (!value) {
    fail(node,
         in_brackets(node.name()) + " is " + in_quotes(word) + ", which is not a number",
         "write a number, with a decimal point");
    return 0.0;
  }
  if (*value >= limits.low && *value <= limits.high) return *value;
  std::string cause = in_brackets(node.name()) + " is " + word + ", not between ";
  append_exact(cause, limits.low);
  cause += " and ";
  append_exact(cause, limits.high);
  if (!limits.unit.empty()) cause.append(" ").append(limits.unit);
  fail(node,
       std::move(cause),
       limits.unit.empty() ? "correct the number"
                           : std::string("give it in ").append(limits.unit));
  return 0.0;
}

int XmlReader::integer(pugi::xml_node node, const Limits& limits) {
  const double value = number(node, limits);
  if (value == std::floor(value)) return static_cast<int>(value);
  fail(node, in_brackets(node.name()) + " is not a whole number", "correct the number");
  return 0;
}

void XmlReader::keep_unknown(pugi::xml_node node,
                             std::span<const std::string_view> known,
                             std::vector<std::string>* unknown) {
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    note(node,
         in_brackets(node.name()).append(" has an attribute \"") + attribute.name() +
             "\", which is not kept");
  }
  for (const pugi::xml_node& part : node.children()) {
    if (is_text(part)) {
      fail(node,
           in_brackets(node.name()) + " holds text between its elements",
           "remove the text, or put it into an element");
    }
    if (part.type() != pugi::node_element) continue;
    const std::string_view name = part.name();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    if (unknown) unknown->push_back(verbatim(part));
    std::string text = in_brackets(name) + " is unknown here and is " +
                       (unknown ? "kept as it is" : "not kept");
    const std::string nearest = suggestion(name, known);
    if (nearest.starts_with("perhaps")) text += "; " + nearest;
    note(part, text);
  }
}

std::string XmlReader::verbatim(pugi::xml_node node) const {
  // The parser gives the position of the name; the bracket is directly before it.
  const auto begin = static_cast<std::size_t>(node.offset_debug() - 1);
  return text_.substr(begin, end_of_element(text_, begin) - begin);
}

void append_xml_text(std::string& xml, std::string_view text) {
  for (const char c : text) {
    switch (c) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      default:
        xml += c;
    }
  }
}

}  // namespace marey::recordings
