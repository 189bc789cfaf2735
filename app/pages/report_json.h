// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/pages/report.h"

namespace marey::app {

/// What report.json holds, before it is written out: the page shows the same figures.
/// Numbers are rounded, keys end in their units. Precondition: every number finite.
[[nodiscard]] nlohmann::ordered_json report_figures(const Report& report);

/// `value` to `decimals` decimals, and never minus zero. Precondition: finite.
[[nodiscard]] double rounded(double value, int decimals);

}  // namespace marey::app
