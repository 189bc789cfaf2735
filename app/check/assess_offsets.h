// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/rig/find_clock_offsets.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/finding.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Compares the time offsets of the session for a trial with the offsets computed from
/// the tags. `seen` has one entry per camera of the session. Returns nullopt if they
/// agree within 4 ms or 6 sigma, or if no offset is observable. Otherwise a poor finding,
/// with the cameras, the differences, whether all offsets have the opposite sign, and the
/// offsets that fit.
[[nodiscard]] std::optional<Finding> assess_offsets(
    const recordings::Session& session,
    const recordings::Trial& trial,
    std::span<const calib::ClockOffset> seen);

/// Computes the offsets from the tags of the trial and calls assess_offsets().
/// `detections` has one entry per camera, corrected for shrinkage. `centre_sigma_m` is
/// the largest sigma of a camera centre [m]: if everything moves in one direction, a
/// wrong camera position has the effect of a delay. Cost: none for a trial without
/// offsets, else some seconds.
[[nodiscard]] std::optional<Finding> assess_trial_offsets(
    const recordings::Session& session,
    const recordings::Trial& trial,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    double centre_sigma_m);

}  // namespace marey::app
