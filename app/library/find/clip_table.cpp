// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/clip_table.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string_view>

#include "core/base/printable.h"

namespace marey::app {
namespace {

/// Returns the number of characters of a text in UTF-8.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0U) != 0x80;
  }));
}

}  // namespace

std::string table_text(const std::vector<std::vector<std::string>>& rows) {
  constexpr std::size_t kMaxWidth = 48;
  std::vector<std::size_t> widths(rows.empty() ? 0 : rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      widths[k] = std::max(widths[k], std::min(kMaxWidth, width_of(row[k])));
    }
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) {
      line += printable(row[k]);
      const std::size_t width = width_of(row[k]);
      line.append(2 + widths[k] - std::min(widths[k], width), ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + '\n';
  }
  return out;
}

std::string label_list(const recordings::ClipSummary& clip) {
  std::string out;
  for (const std::string& label : clip.labels) {
    if (!out.empty()) out += ", ";
    out += label;
  }
  return out;
}

nlohmann::ordered_json clip_json(const recordings::ClipSummary& clip) {
  return {{"clip_id", clip.clip_id},
          {"name", clip.name},
          {"seconds", clip.duration_s},
          {"rate_hz", clip.rate_hz},
          {"quality", std::string(name(clip.quality))},
          {"licence", clip.licence},
          {"subject", clip.subject},
          {"split", clip.split},
          {"labels", clip.labels},
          {"found_labels", clip.found_labels}};
}

void print_library_json(const nlohmann::ordered_json& json) {
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  std::printf("%s\n", json.dump(2, ' ', false, kReplace).c_str());
}

}  // namespace marey::app
