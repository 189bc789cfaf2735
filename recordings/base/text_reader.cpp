// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/text_reader.h"

#include <charconv>
#include <cmath>
#include <utility>

#include "core/base/in_quotes.h"

namespace marey::recordings {
namespace {

constexpr std::string_view kBlank = " \t\f\v";
constexpr std::string_view kBlankOrEnd = " \t\f\v\r\n";
constexpr std::string_view kLineEnd = "\r\n";

template <class T>
std::optional<T> whole_number(std::string_view word) {
  // from_chars() does not accept a plus sign, which some exporters write.
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  T value{};
  const char* end = word.data() + word.size();
  const auto [stop, problem] = std::from_chars(word.data(), end, value);
  if (problem != std::errc{} || stop != end || word.empty()) return std::nullopt;
  return value;
}

}  // namespace

TextReader::TextReader(std::string_view text, std::string file)
    : text_(text), file_(std::move(file)) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

void TextReader::skip_line_end() {
  if (at_end()) return;
  if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
  ++at_;
  ++line_;
}

void TextReader::skip_blank() {
  while (!at_end()) {
    at_ = std::min(text_.find_first_not_of(kBlank, at_), text_.size());
    if (at_end() || kLineEnd.find(text_[at_]) == std::string_view::npos) return;
    skip_line_end();
  }
}

std::string_view TextReader::word() {
  skip_blank();
  return word_on_line();
}

std::string_view TextReader::peek() const {
  TextReader ahead(*this);
  return ahead.word();
}

std::string_view TextReader::word_on_line() {
  at_ = std::min(text_.find_first_not_of(kBlank, at_), text_.size());
  const std::size_t end = std::min(text_.find_first_of(kBlankOrEnd, at_), text_.size());
  const std::string_view found = text_.substr(at_, end - at_);
  at_ = end;
  return found;
}

std::string_view TextReader::rest_of_line() {
  at_ = std::min(text_.find_first_not_of(kBlank, at_), text_.size());
  const std::size_t end = std::min(text_.find_first_of(kLineEnd, at_), text_.size());
  std::string_view found = text_.substr(at_, end - at_);
  at_ = end;
  while (!found.empty() && kBlank.find(found.back()) != std::string_view::npos) {
    found.remove_suffix(1);
  }
  return found;
}

std::string TextReader::where() const {
  return file_ + ":" + std::to_string(line_);
}

std::optional<double> to_number(std::string_view word) {
  const auto value = whole_number<double>(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<int> to_integer(std::string_view word) {
  return whole_number<int>(word);
}

}  // namespace marey::recordings
