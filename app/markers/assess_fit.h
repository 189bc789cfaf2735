// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/markers/fit_labels.h"
#include "app/markers/marker_trials.h"
#include "core/finding.h"

namespace marey::app {

/// Checks that the body reproduces the markers. Empty: no fault. Each finding is poor,
/// with the trial's file: left and right exchanged; markers far off the body (all, those
/// of one segment, or a single one); a given stature that the markers contradict; frames
/// in which the body is unknown. Or it is kBadInput: a trial with too few of the body's
/// markers.
/// `subject` may be null: an earlier fit was used. `stature_m` is the given stature.
[[nodiscard]] std::vector<Finding> assess_fit(std::span<const MarkerTrial> trials,
                                              const LabelledFit* subject,
                                              const Body& body,
                                              std::optional<double> stature_m);

/// Returns the share of the frames with any marker in which the body is solved; 0 for a
/// trial that is not solved.
[[nodiscard]] double share_solved(const MarkerTrial& trial);

}  // namespace marey::app
