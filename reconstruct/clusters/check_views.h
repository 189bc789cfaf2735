// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::reconstruct {

/// Checks that a trial's videos, the calibration and the tags' sizes belong together,
/// using tags that two cameras see at once.
/// Errors (kBadInput), `where` the videos or "[[tags.tag]]": two cameras' files exchanged
/// (found by trying every swap); cameras that do not agree under any swap (moved since
/// the calibration, or videos that do not start together); tags whose printed size is not
/// the declared one; all tags off by the same factor, which means the board's size or all
/// of theirs is wrong. Trials in which hardly any tag is seen twice pass, for lack of
/// data. `detections` holds one entry per camera of `cameras`, in order. Linear in
/// frames, up to a few hundred of them.
[[nodiscard]] Status check_views(std::span<const Camera> cameras,
                                 std::span<const CameraDetections> detections,
                                 std::span<const TagOnSegment> tags);

}  // namespace marey::reconstruct
