// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/retarget/retarget_json.h"

namespace marey::app {

/// Returns the page section of `marey retarget` on balance: a table, and a chart over
/// time of the frames in which bodies are above their feet, with `moments` marked.
/// Precondition: the run was measured.
[[nodiscard]] std::string balance_section(const RetargetRun& run,
                                          const std::vector<int>& moments);
/// CSS of the section, in addition to retarget_page()'s.
extern const std::string_view kBalanceStyle;

}  // namespace marey::app
