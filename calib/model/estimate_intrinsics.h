// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "calib/model/board_views.h"
#include "core/camera.h"
#include "core/transform.h"

namespace marey::calib {

/// Estimates one camera's intrinsics from its views of a flat board. At most 40 views are
/// selected, spread over image position, distance and tilt. Uses OpenCV's implementation
/// of Zhang's method, and cv::fisheye for fisheyes. Bundle adjustment refines the result.
/// The rational model starts with Brown and Conrady's terms.
///
/// Returns nullopt if the views do not determine the lens: fewer than four with six tags
/// (or a dozen points), or all of them frontal, so that focal length and distance are
/// ambiguous.
[[nodiscard]] std::optional<Intrinsics> estimate_intrinsics(
    std::span<const BoardView* const> views,
    int width_px,
    int height_px,
    LensModel lens = LensModel::kBrownConrady);

/// Returns the board's pose in the frame of a camera with known intrinsics: the better of
/// the two planar solutions. Returns nullopt if the board would be behind the camera or
/// fewer than six corners are seen.
[[nodiscard]] std::optional<RigidTransform> camera_from_board(
    const Intrinsics& intrinsics, const BoardView& view);

}  // namespace marey::calib
