// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Checks of a session that need no decoded video.

#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/finding.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Checks that the body has the tags that the fit of a subject needs: at least one on the
/// hips, the upper chest and both bones of each limb. Errors (kBadInput): the first
/// segment without a tag.
[[nodiscard]] Status check_worn_segments(const recordings::Session& session);

/// Returns a fair finding if a segment has fewer tags than its other side while its
/// neighbour has more than the other side of that neighbour: one of these may be declared
/// on the wrong segment. It names the segments and the ids. nullopt if both sides have
/// equally many tags, or differ in another way.
[[nodiscard]] std::optional<Finding> assess_sides(const recordings::Session& session);

/// Checks that every camera has a video in the calibration trial. Errors (kBadInput): the
/// first camera without one. Passes if there is no such trial, or if `marey record` names
/// its videos.
[[nodiscard]] Status check_calibrated_cameras(const recordings::Session& session);

}  // namespace marey::app
