// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "edit/state/op_report.h"

namespace marey::app {

/// Returns the value of a figure; nullopt: the operation did not measure it.
[[nodiscard]] std::optional<double> figure(const edit::OpReport& report,
                                           std::string_view figure_name);

/// Returns the figures of the operation `jump` as lines for a user: times, height, push,
/// body. Figures that were not measured are left out (docs/formats/jump.md lists all).
[[nodiscard]] std::vector<std::string> jump_lines(const edit::OpReport& report);

}  // namespace marey::app
