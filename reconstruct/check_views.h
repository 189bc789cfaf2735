// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/result.h"

namespace marey::reconstruct {

/// Whether a trial's videos, the calibration and the tags' sizes belong together, judged
/// by tags that two cameras see at once.
///
/// Errors (kBadInput), `where` the videos or "[[tags.tag]]": two cameras' files swapped
/// (found by trying every swap); cameras that do not agree whichever way (moved since the
/// calibration, or videos that do not start together); tags whose printed size is not the
/// declared one; all tags off alike, which is the board's size or all of theirs.
/// Trials in which hardly any tag is seen twice pass: there is nothing to judge.
/// `detections` holds one entry per camera of `cameras`, in order. Linear in frames, up
/// to a few hundred of them.
[[nodiscard]] Status check_views(std::span<const Camera> cameras,
                                 std::span<const CameraDetections> detections,
                                 std::span<const TagOnSegment> tags);

}  // namespace marey::reconstruct
