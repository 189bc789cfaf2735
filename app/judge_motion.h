// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/report.h"
#include "core/result.h"

namespace marey::app {

/// What of a trial's solved motion no body does, whatever its residuals are: segments
/// that turn by more than 45 rad/s, joints that travel by more than 25 m/s, from one
/// frame to the next and measured in both. (Fast kicks turn a shank by 35 rad/s, sprints
/// move a foot by 20 m/s.) One entry per trial, kQuality, with the worst segment or joint
/// and its frames; empty when all is well. Cost: linear in frames.
[[nodiscard]] std::vector<Error> judge_motion(const ReportTrial& trial);

}  // namespace marey::app
