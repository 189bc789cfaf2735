// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: tests whether the cameras of the floor trial are those of the waved
// trial.

#include <span>

#include "calib/model/board_views.h"
#include "core/base/result.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::calib {

/// Succeeds if one pose of the board explains the views of all calibrated cameras on the
/// floor. The waved views alone fix the relative camera poses. A camera whose floor view
/// disagrees was therefore moved between the trials, or its file is from another camera.
///
/// Errors (kBadInput, naming the videos of `floor`): two files that fit if they are
/// exchanged; otherwise the camera whose view has the largest error. A single floor view
/// always succeeds. Preconditions: cameras and `floor` have the same order; `floor_views`
/// contains tags whose shrinkage was not corrected (a pixel or two, compared with tens of
/// pixels for an exchange).
/// Cost: one planar pose per view; if views disagree, one per view and pair of views.
[[nodiscard]] Status check_floor(std::span<const Camera> cameras,
                                 std::span<const BoardView* const> floor_views,
                                 std::span<const CameraDetections> floor);

}  // namespace marey::calib
