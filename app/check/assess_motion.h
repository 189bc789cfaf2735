// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/pages/report.h"
#include "core/finding.h"

namespace marey::app {

/// Detects motion that is impossible for a body, at any residual: a segment that turns by
/// more than 45 rad/s or a joint that travels by more than 25 m/s between two frames in
/// which both are measured. (Fast kicks turn a shank by 35 rad/s, sprints move a foot by
/// 20 m/s.) Below 14.3 Hz no turn can exceed the limit. Returns at most one finding,
/// poor, with the worst step of the first body. Cost: linear in frames.
[[nodiscard]] std::vector<Finding> assess_motion(const ReportTrial& trial);

}  // namespace marey::app
