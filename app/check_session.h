// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Checks of a session that need no decoded video.

#include "core/result.h"
#include "recordings/session.h"

namespace marey::app {

/// Checks that the body has the tags that a subject's fit needs: one on the hips, the
/// upper chest and both bones of each limb. Errors (kBadInput): the first segment without
/// a tag.
[[nodiscard]] Status check_worn_segments(const recordings::Session& session);

/// Checks that every camera has a video in the calibration trial. Errors (kBadInput): the
/// first camera without one. Passes if there is no such trial, or if `marey record` names
/// its videos.
[[nodiscard]] Status check_calibrated_cameras(const recordings::Session& session);

}  // namespace marey::app
