// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/detection.h"
#include "core/finding.h"
#include "recordings/session/session.h"

// Checks that trials show the motion of their `kind`: standing, or the range of motion.

namespace marey::app {

/// Checks that the subject of the static trial stands still. `found` has the name of the
/// trial as key. Errors (kBadInput): the subject walks or moves its limbs; the error
/// names the first other trial in which it stands still, if any. Passes without a static
/// trial, or if too few tags are seen in it. Cost: measure_travel() of each trial.
[[nodiscard]] Status check_standing(
    const recordings::Session& session,
    const std::map<std::string, std::vector<CameraDetections>>& found);

/// Returns a fair finding if the subject walks through the room in the range-of-motion
/// trial and stays in one place in another motion, as their videos may be exchanged. Uses
/// the tags on hips and chest; nullopt also if there are fewer than six of them. Cost: as
/// check_standing().
[[nodiscard]] std::optional<Finding> assess_range_of_motion(
    const recordings::Session& session,
    const std::map<std::string, std::vector<CameraDetections>>& found);

}  // namespace marey::app
