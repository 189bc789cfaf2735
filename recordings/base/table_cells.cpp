// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/table_cells.h"

#include <algorithm>

#include "core/base/lower_case.h"

namespace marey::recordings {
namespace {

constexpr std::string_view kCellBlank = " \t\f\v\r\n";

}  // namespace

LineReader::LineReader(std::string_view text) : text_(text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

std::optional<std::string_view> LineReader::next() {
  if (at_ >= text_.size()) return std::nullopt;
  const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
  const std::string_view line = text_.substr(at_, end - at_);
  at_ = end;
  if (at_ < text_.size()) {
    const bool pair =
        text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n';
    at_ += pair ? 2 : 1;
  }
  ++line_;
  return line;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kCellBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kCellBlank) - begin + 1);
}

CellMark cell_mark(std::string_view line) {
  for (const CellMark mark : {CellMark::kTab, CellMark::kSemicolon, CellMark::kComma}) {
    if (line.find(static_cast<char>(mark)) != std::string_view::npos) return mark;
  }
  return CellMark::kBlanks;
}

void split_cells(std::string_view line,
                 CellMark mark,
                 std::vector<std::string_view>& cells) {
  cells.clear();
  if (mark != CellMark::kBlanks) {
    for (std::size_t at = 0; at <= line.size();) {
      const std::size_t end =
          std::min(line.find(static_cast<char>(mark), at), line.size());
      cells.push_back(trimmed(line.substr(at, end - at)));
      at = end + 1;
    }
    return;
  }
  for (std::size_t at = 0; at < line.size();) {
    at = std::min(line.find_first_not_of(kCellBlank, at), line.size());
    const std::size_t end = std::min(line.find_first_of(kCellBlank, at), line.size());
    if (end > at) cells.push_back(line.substr(at, end - at));
    at = end;
  }
}

bool is_missing(std::string_view cell) {
  if (cell.empty()) return true;
  if (cell.front() == '-' || cell.front() == '+') cell.remove_prefix(1);
  // 1.#QNAN, 1.#IND, 1.#INF: old C runtimes on Windows.
  if (cell.starts_with("1.#")) return true;
  if (cell.size() < 3 || cell.size() > 9) return false;
  std::string_view word = cell.substr(0, 3);
  const auto is = [&](std::string_view name) {
    return std::equal(word.begin(), word.end(), name.begin(), [](char a, char b) {
      return lower_case(a) == b;
    });
  };
  // "nan(ind)", "Infinity".
  const bool ends = cell.size() == 3 || cell[3] == '(' || cell[3] == 'i';
  return ends && (is("nan") || is("inf"));
}

}  // namespace marey::recordings
