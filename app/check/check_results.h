// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/pages/report.h"
#include "core/base/result.h"

namespace marey::app {

/// What of the results does not show what the cameras saw: figures that only wrong input
/// gives (another session's video, exchanged ids, a camera that was moved), far beyond
/// what lenses, loose tags and fast movement do. Empty when all is well. Each is
/// kQuality, with the trial or camera that it is about.
[[nodiscard]] std::vector<Error> check_results(const Report& report);

/// The part of check_results() about the cameras and the subject.
[[nodiscard]] std::vector<Error> check_rig_and_subject(const Report& report);

/// The part of check_results() about one trial.
[[nodiscard]] std::vector<Error> check_trial_results(const ReportTrial& trial);

}  // namespace marey::app
