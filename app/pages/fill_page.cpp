// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/pages/fill_page.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/base/assert.h"

namespace marey::app {

std::string json_in_html(const nlohmann::ordered_json& json) {
  std::string text;
  for (const char c :
       json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) {
    if (c == '<') {
      text += "\\u003c";
    } else if (c == '>') {
      text += "\\u003e";
    } else if (c == '&') {
      text += "\\u0026";
    } else {
      text += c;
    }
  }
  return text;
}

std::string fill_page(
    std::string_view page,
    const std::vector<std::pair<std::string_view, std::string>>& parts) {
  std::string out;
  while (!page.empty()) {
    const std::size_t at = page.find("{{");
    out += page.substr(0, at);
    if (at == std::string_view::npos) break;
    page.remove_prefix(at);
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const auto& p) {
      return page.substr(2).starts_with(p.first) &&
             page.substr(2 + p.first.size()).starts_with("}}");
    });
    MAREY_ASSERT(part != parts.end());
    out += part->second;
    page.remove_prefix(part->first.size() + 4);
  }
  return out;
}

}  // namespace marey::app
