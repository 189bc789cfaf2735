// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace marey::app {

/// Returns JSON that contains no markup for an HTML parser: `<`, `>` and `&` occur in
/// strings only, and are replaced by escapes with the same meaning.
[[nodiscard]] std::string json_in_html(const nlohmann::ordered_json& json);

/// Replaces every `{{name}}` of a page of app/pages/report_page.h by its part.
/// Precondition: every name has a part.
[[nodiscard]] std::string fill_page(
    std::string_view page,
    const std::vector<std::pair<std::string_view, std::string>>& parts);

}  // namespace marey::app
