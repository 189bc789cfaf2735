// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Checks of a session that need no decoded video.

#include <optional>
#include <string>

#include "core/base/result.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Checks that the body has the tags that a subject's fit needs: one on the hips, the
/// upper chest and both bones of each limb. Errors (kBadInput): the first segment without
/// a tag.
[[nodiscard]] Status check_worn_segments(const recordings::Session& session);

/// Warns of a segment that has fewer tags than its other side while a neighbour of it has
/// more than its own: one of these may be declared on the wrong segment. Names the
/// segments and the ids. nullopt where both sides have as many, or differ elsewise.
[[nodiscard]] std::optional<std::string> uneven_sides_warning(
    const recordings::Session& session);

/// Checks that every camera has a video in the calibration trial. Errors (kBadInput): the
/// first camera without one. Passes if there is no such trial, or if `marey record` names
/// its videos.
[[nodiscard]] Status check_calibrated_cameras(const recordings::Session& session);

}  // namespace marey::app
