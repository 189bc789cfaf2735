// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: whether the cameras of the floor trial are those of the waved one.

#include <span>

#include "calib/board_views.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/result.h"

namespace marey::calib {

/// Done when one place of the board explains what all calibrated cameras see of it on the
/// floor. The waved views alone fix the cameras relative to each other, so a camera whose
/// floor view disagrees was moved in between, or its file is another camera's.
///
/// Errors (kBadInput, naming the videos of `floor`): two files that fit the other way
/// round; else the camera whose view is furthest off. Says nothing of a single floor
/// view. Precondition: cameras and `floor` in one order, `floor_views` of tags whose
/// shrinkage was not taken off (a pixel or two against the tens that a swap makes).
/// Cost: one planar pose per view; where they disagree, one per view and pair of views.
[[nodiscard]] Status check_floor(std::span<const Camera> cameras,
                                 std::span<const BoardView* const> floor_views,
                                 std::span<const CameraDetections> floor);

}  // namespace marey::calib
