// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/markers/marker_trials.h"
#include "core/base/result.h"
#include "core/finding.h"
#include "reconstruct/markers/body_stature.h"
#include "reconstruct/markers/compare_trials.h"

namespace marey::app {

/// Returns the unit in which lengths that were read as `per_metre` would be `scale` times
/// shorter: "in" for (100, 0.394). nullopt: no unit fits.
[[nodiscard]] std::optional<std::string> unit_by_scale(double per_metre, double scale);

/// Checks that all trials have one unit. Errors (kBadInput): the first trial with another
/// one, with the unit of its numbers. `geometry` is compare_trials() of the trials.
[[nodiscard]] Status check_units(std::span<const MarkerTrial> trials,
                                 std::span<const reconstruct::TrialGeometry> geometry);

/// Returns kBadInput for a stature that no human has, with the unit that gives an adult's
/// stature. `stature_m` is estimate_stature() of all trials.
[[nodiscard]] Status check_size(std::span<const MarkerTrial> trials, double stature_m);

/// Returns a poor finding for a stature below that of walking children, unless the
/// stature is the given one. An adult's lengths in inches that were read as centimetres
/// give such a stature.
[[nodiscard]] std::optional<Finding> assess_small_stature(
    std::span<const MarkerTrial> trials,
    const reconstruct::MeasuredStature& measured,
    std::optional<double> given_m);

/// Returns a poor finding, with the file and the correction, for each trial whose
/// left and right are exchanged, or in which the body lies or hangs head down along an
/// axis that the markers do not confirm as up.
[[nodiscard]] std::vector<Finding> assess_sides_and_axes(
    std::span<const MarkerTrial> trials,
    std::span<const reconstruct::TrialGeometry> geometry);

/// Returns a fair finding for each trial in which the body always lies or hangs head
/// down, and the file or its markers confirm the up axis.
[[nodiscard]] std::vector<Finding> assess_lying(
    std::span<const MarkerTrial> trials,
    std::span<const reconstruct::TrialGeometry> geometry);

}  // namespace marey::app
