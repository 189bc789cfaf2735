// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/quoted_cells.h"

#include <algorithm>

namespace marey::recordings {

std::size_t split_quoted(std::string_view line, std::vector<QuotedCell>& cells) {
  cells.clear();
  std::size_t at = 0;
  while (true) {
    QuotedCell& cell = cells.emplace_back();
    cell.column = at + 1;
    if (at < line.size() && line[at] == '"') {
      for (++at;; ++at) {
        if (at >= line.size()) return cell.column;
        if (line[at] == '"') {
          const bool is_doubled = at + 1 < line.size() && line[at + 1] == '"';
          ++at;
          if (!is_doubled) break;
        }
        cell.text += line[at];
      }
      if (at < line.size() && line[at] != ',') return at + 1;
    } else {
      const std::size_t end = std::min(line.find(',', at), line.size());
      cell.text = line.substr(at, end - at);
      at = end;
    }
    if (at >= line.size()) return 0;
    ++at;
  }
}

void append_quoted(std::string& text, std::string_view cell) {
  const bool has_blank_end = !cell.empty() && (cell.front() == ' ' || cell.back() == ' ');
  if (!has_blank_end && cell.find_first_of(",\"\r\n") == std::string_view::npos) {
    text += cell;
    return;
  }
  text += '"';
  for (const char c : cell) {
    if (c == '"') text += '"';
    text += c;
  }
  text += '"';
}

}  // namespace marey::recordings
