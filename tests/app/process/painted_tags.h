// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "core/base/ids.h"
#include "core/camera.h"
#include "core/tag_pattern.h"
#include "core/transform.h"

namespace marey::testing {

/// A tag of tag36h11 in the world.
struct PaintedTag {
  TagId id{};
  double size_m = 0.1;
  RigidTransform world_from_tag;
};

/// Returns the 8-bit picture that `camera` takes of the tags in front of a grey wall.
/// Traces rays through every pixel, with the lens's distortion. Later tags hide earlier
/// ones; a tag that faces away is invisible. Each pixel is the mean of its light, coded
/// with sRGB's curve, with noise of 1.5 grey levels. Equal seeds give equal noise.
[[nodiscard]] cv::Mat paint_tags(const Camera& camera,
                                 const std::vector<PaintedTag>& tags,
                                 unsigned seed);

}  // namespace marey::testing
