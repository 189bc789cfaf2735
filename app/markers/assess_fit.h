// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/markers/fit_labels.h"
#include "app/markers/marker_trials.h"
#include "core/base/result.h"

namespace marey::app {

/// Whether the body shows what the markers did. Empty when all is well. Each is kQuality
/// with the trial's file: left and right exchanged, markers far off the body (all, those
/// of one segment, or one alone), a given stature that the markers contradict, frames in
/// which the body is not known; or
/// kBadInput: a trial without enough markers of the body's.
/// `subject` may be null: an earlier fit was used. `stature_m` is the given one.
[[nodiscard]] std::vector<Error> assess_fit(std::span<const MarkerTrial> trials,
                                            const SubjectFit* subject,
                                            const Body& body,
                                            std::optional<double> stature_m);

/// The share of the frames that show any marker in which the body is known; 0 of a trial
/// that is not solved.
[[nodiscard]] double share_solved(const MarkerTrial& trial);

}  // namespace marey::app
