// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/pages/report.h"
#include "core/finding.h"

namespace marey::app {

/// Detects results that contradict the videos: figures that only wrong input causes (the
/// video of another session, exchanged ids, a moved camera) and that are far beyond the
/// effect of lenses, loose tags and fast movement. Returns an empty vector if all is
/// well. Each finding is poor and names its trial or camera.
[[nodiscard]] std::vector<Finding> assess_results(const Report& report);

/// Returns the part of assess_results() about the cameras and the subject.
[[nodiscard]] std::vector<Finding> assess_rig_and_subject(const Report& report);

/// Returns the part of assess_results() about one trial.
[[nodiscard]] std::vector<Finding> assess_trial_results(const ReportTrial& trial);

}  // namespace marey::app
