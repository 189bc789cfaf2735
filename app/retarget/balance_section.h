// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/retarget/retarget_figures.h"

namespace marey::app {

/// Whether bodies are above their feet, for the page of `marey retarget`: a table, and
/// when, over time, `moments` marked. Precondition: the run was measured.
[[nodiscard]] std::string balance_section(const RetargetRun& run,
                                          const std::vector<int>& moments);
/// What it looks like, over retarget_page()'s own.
extern const std::string_view kBalanceStyle;

}  // namespace marey::app
