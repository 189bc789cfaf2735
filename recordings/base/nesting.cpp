// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/nesting.h"

#include <algorithm>
#include <vector>

namespace marey::recordings {
namespace {

/// Counts the levels of TOML, character by character, without creating a tree.
class TomlLevels {
 public:
  explicit TomlLevels(std::string_view text) : text_(text) {}

  bool too_deep() {
    while (at_ < text_.size()) {
      step();
      if (header_ + open_ + key_ + dots_ > kMaxNesting) return true;
    }
    return false;
  }

 private:
  void step() {
    const char c = text_[at_];
    if (c == '"' || c == '\'') {
      skip_string(c);
      is_line_start_ = false;
      return;
    }
    ++at_;
    switch (c) {
      case '#':
        at_ = std::min(text_.find('\n', at_), text_.size());
        return;
      case '\n':
        end_value();
        is_line_start_ = true;
        return;
      case ' ':
      case '\t':
      case '\r':
        is_after_blank_ = true;
        return;
      case '.':
        ++dots_;
        is_after_dot_ = true;
        is_after_blank_ = false;
        is_line_start_ = false;
        return;
      case '=':
        key_ = dots_ + 1;
        dots_ = 0;
        break;
      case ',':
        end_value();
        break;
      case '[':
      case '{':
        open(c);
        break;
      case ']':
      case '}':
        close();
        break;
      default:
        // Adjacent words are no key: a table of numbers, for example.
        if (is_after_blank_ && !is_after_dot_) dots_ = 0;
        break;
    }
    is_after_blank_ = false;
    is_after_dot_ = false;
    is_line_start_ = false;
  }

  void end_value() {
    key_ = 0;
    dots_ = 0;
  }

  void open(char bracket) {
    if (bracket == '[' && is_line_start_ && levels_.empty()) {
      in_header_ = true;
      header_ = 0;
      if (at_ < text_.size() && text_[at_] == '[') ++at_;
      return;
    }
    levels_.push_back(key_ + dots_ + 1);
    open_ += levels_.back();
    end_value();
  }

  void close() {
    if (in_header_) {
      in_header_ = false;
      header_ = dots_ + 2;  // One part more than dots; a list of tables has two levels.
    } else if (!levels_.empty()) {
      open_ -= levels_.back();
      levels_.pop_back();
    }
    end_value();
  }

  /// Skips a string of one line, or of several between three quotes.
  void skip_string(char quote) {
    const std::string_view rest = text_.substr(at_);
    const bool is_long = rest.size() >= 3 && rest[1] == quote && rest[2] == quote;
    at_ += is_long ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\\' && quote == '"') {
        ++at_;
      } else if (c == '\n' && !is_long) {
        return;  // A mistake, which the parser reports.
      } else if (c == quote && ends(quote, is_long)) {
        return;
      }
    }
    at_ = std::min(at_, text_.size());
  }

  /// Advances past the end of a string, if it is here.
  bool ends(char quote, bool is_long) {
    if (!is_long) {
      ++at_;
      return true;
    }
    std::size_t quotes = 0;
    while (quotes < 5 && at_ + quotes < text_.size() && text_[at_ + quotes] == quote) {
      ++quotes;
    }
    if (quotes < 3) return false;
    at_ += quotes;  // One or two quotes more than three belong to the text.
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::size_t> levels_;  ///< Per open bracket.
  std::size_t open_ = 0;             ///< Their sum.
  std::size_t header_ = 0;           ///< Level of the current table.
  std::size_t key_ = 0;              ///< Level of the next value's key.
  std::size_t dots_ = 0;             ///< Since the last separator.
  bool in_header_ = false;
  bool is_line_start_ = true;
  bool is_after_blank_ = false;
  bool is_after_dot_ = false;
};

}  // namespace

bool json_nests_too_deep(std::string_view json) {
  std::size_t depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_text) {
      if (c == '\\') ++i;
      if (c == '"') in_text = false;
    } else if (c == '"') {
      in_text = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxNesting) return true;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return false;
}

bool json_has_too_many_keys(std::string_view json) {
  std::vector<std::size_t> keys{0};  // Per open bracket.
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_text) {
      if (c == '\\') ++i;
      if (c == '"') in_text = false;
    } else if (c == '"') {
      in_text = true;
    } else if (c == '[' || c == '{') {
      keys.push_back(0);
    } else if ((c == ']' || c == '}') && keys.size() > 1) {
      keys.pop_back();
    } else if (c == ':' && ++keys.back() > kMaxKeys) {
      return true;
    }
  }
  return false;
}

bool toml_nests_too_deep(std::string_view toml) {
  return TomlLevels(toml).too_deep();
}

}  // namespace marey::recordings
