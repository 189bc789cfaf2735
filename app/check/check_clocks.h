// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/rig/find_clock_offsets.h"
#include "core/base/result.h"
#include "core/camera.h"
#include "core/detection.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Compares the time offsets that a session gives for a trial with those that the tags
/// show. `seen` one entry per camera of the session. Returns nullopt where they agree
/// within 4 ms or 6 sigma, or no offset is observable; else kQuality, with the
/// cameras, by how much, whether all have the other sign, and the offsets that fit.
[[nodiscard]] std::optional<Error> assess_offsets(
    const recordings::Session& session,
    const recordings::Trial& trial,
    std::span<const calib::ClockOffset> seen);

/// The same, from the trial's tags: `detections` one entry per camera, shrinkage taken
/// off; `centre_sigma_m` is the largest of the cameras' centres [m]: where everything
/// moves one way, a misplaced camera looks late. Costs nothing for a trial without
/// offsets, else some seconds.
[[nodiscard]] std::optional<Error> check_offsets(
    const recordings::Session& session,
    const recordings::Trial& trial,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    double centre_sigma_m);

}  // namespace marey::app
