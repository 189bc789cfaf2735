// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace marey::app {

/// JSON that no HTML parser can take for markup: `<`, `>` and `&` occur in strings only,
/// and there an escape means the same.
[[nodiscard]] std::string json_in_html(const nlohmann::ordered_json& json);

/// A page of app/report/ with every `{{name}}` replaced by its part. Precondition: every
/// name has one.
[[nodiscard]] std::string fill_page(
    std::string_view page,
    const std::vector<std::pair<std::string_view, std::string>>& parts);

}  // namespace marey::app
