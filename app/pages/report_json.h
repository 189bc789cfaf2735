// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/pages/report.h"

namespace marey::app {

/// Returns the content of report.json; the page shows the same figures. Numbers are
/// rounded, keys end in their units. Precondition: all numbers are finite.
[[nodiscard]] nlohmann::ordered_json report_json(const Report& report);

/// Rounds `value` to `decimals` decimals; never returns minus zero. Precondition: `value`
/// is finite.
[[nodiscard]] double rounded(double value, int decimals);

}  // namespace marey::app
