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

/// What `camera` photographs of the tags before a grey wall: rays through every pixel,
/// its lens's distortion included; later tags hide earlier ones, and who faces away is
/// not seen. 8-bit, each pixel the mean of its light, coded by sRGB's curve, with noise
/// of one grey level and a half. The same seed gives the same noise.
[[nodiscard]] cv::Mat paint_tags(const Camera& camera,
                                 const std::vector<PaintedTag>& tags,
                                 unsigned seed);

}  // namespace marey::testing
