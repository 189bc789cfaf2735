// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/query_tokens.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/printable.h"
#include "core/base/utf8.h"

namespace marey::app {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool ends_word(char c) {
  return is_blank(c) || std::string_view("()=!<>~\"").find(c) != std::string_view::npos;
}

/// True inside a character of several bytes.
bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xc0U) == 0x80;
}

/// Returns the place of the first character that no expression has.
std::optional<std::size_t> forbidden_byte(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const auto character = first_utf8(text.substr(at));
    if (!character) return at;
    const bool is_control = character->code < 0x20 || character->code == 0x7f;
    if (is_control && !is_blank(text[at])) return at;
    at += character->bytes;
  }
  return std::nullopt;
}

/// Returns the length of the operator at the beginning of a text; 0: no operator.
std::size_t operator_length(std::string_view text) {
  for (const std::string_view word : {"!=", "<=", ">=", "!~", "=", "<", ">", "~"}) {
    if (text.starts_with(word)) return word.size();
  }
  return 0;
}

/// Reads a text in quotation marks from `at` on, and moves `at` behind it. nullopt: it
/// does not end.
std::optional<std::string> quoted_text(std::string_view expression, std::size_t& at) {
  const char mark = expression[at++];
  std::string out;
  for (; at < expression.size(); ++at) {
    if (expression[at] == mark) {
      ++at;
      return out;
    }
    if (expression[at] == '\\' && at + 1 < expression.size()) ++at;
    out += expression[at];
  }
  return std::nullopt;
}

}  // namespace

Error bad_query(std::string_view expression,
                std::size_t at,
                std::string cause,
                std::string next) {
  constexpr std::size_t kShown = 40;
  at = std::min(at, expression.size());
  const auto before = expression.substr(0, at);
  const auto column = 1 + std::count_if(before.begin(), before.end(), [](char c) {
                        return !continues_character(c);
                      });
  std::size_t first = at - std::min(at, kShown);
  std::size_t last = std::min(expression.size(), at + kShown);
  while (first > 0 && continues_character(expression[first])) --first;
  while (last < expression.size() && continues_character(expression[last])) --last;
  last = std::max(last, at);
  std::string place = first > 0 ? "..." : "";
  place += printable(expression.substr(first, at - first));
  place += '^';
  place += printable(expression.substr(at, last - at));
  if (last < expression.size()) place += "...";
  return bad_usage("expression, column " + std::to_string(column) + " (" + place + ")",
                   std::move(cause),
                   std::move(next));
}

Result<std::vector<QueryToken>> query_tokens(std::string_view expression) {
  using Kind = QueryToken::Kind;
  if (expression.size() > kMaxQueryBytes) {
    return bad_query(expression,
                     kMaxQueryBytes,
                     "it is longer than " + std::to_string(kMaxQueryBytes) + " bytes",
                     "divide it into several queries");
  }
  if (const auto at = forbidden_byte(expression)) {
    return bad_query(
        expression, *at, "a control character, or a byte that is not UTF-8", "remove it");
  }
  std::vector<QueryToken> out;
  std::size_t at = 0;
  while (at < expression.size()) {
    const char c = expression[at];
    const std::size_t begin = at;
    if (is_blank(c)) {
      ++at;
    } else if (c == '(' || c == ')') {
      out.push_back({c == '(' ? Kind::kOpen : Kind::kClose, std::string(1, c), begin});
      ++at;
    } else if (c == '"' || c == '\'') {
      auto text = quoted_text(expression, at);
      if (!text) {
        return bad_query(expression,
                         begin,
                         "the quotation mark is not closed",
                         std::string("add ") + c + " after the text");
      }
      out.push_back({Kind::kQuoted, *std::move(text), begin});
    } else if (const std::size_t length = operator_length(expression.substr(at))) {
      out.push_back({Kind::kOperator, std::string(expression.substr(at, length)), begin});
      at += length;
    } else {
      // A single "!" is a word of its own.
      do ++at;
      while (at < expression.size() && !ends_word(expression[at]));
      out.push_back(
          {Kind::kWord, std::string(expression.substr(begin, at - begin)), begin});
    }
  }
  out.push_back({Kind::kEnd, "", expression.size()});
  return out;
}

}  // namespace marey::app
