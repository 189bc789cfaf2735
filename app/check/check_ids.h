// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/check/match_times.h"
#include "core/base/result.h"
#include "core/detection.h"
#include "core/finding.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Checks that the tags seen on a body, and next to an AprilGrid that is waved, are
/// listed in the session. `found` has the name of the trial as key. Cost: linear in the
/// detections.
///
/// Errors (kBadInput): listed tags that are never seen while unlisted tags of the family
/// are often seen, that is, mistyped ids. Unlisted tags alone, and tags that move with
/// the board and do not belong to it, are fair findings. Passes without a check
/// if the session has several tag families (only listed tags are detected then) or no
/// range-of-motion trial.
[[nodiscard]] Status check_ids(
    const recordings::Session& session,
    const std::map<std::string, std::vector<CameraDetections>>& found,
    std::vector<Finding>& findings);

}  // namespace marey::app
