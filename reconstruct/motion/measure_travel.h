// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/body.h"
#include "core/detection.h"

namespace marey::reconstruct {

/// Measures the travel of the body's tags across the pictures of a trial. Tag sizes give
/// the scale, so no calibration is needed.
/// In four fifths of its frames a tag is within its travel of its median place. Returns
/// the upper quartile over tags [m]: 0.02 m for a body that stands still, 0.2 m and more
/// for one that walks or moves every joint. Returns nullopt if fewer than six tags are
/// seen in five frames of one camera. Linear in frames.
[[nodiscard]] std::optional<double> measure_travel(
    std::span<const CameraDetections> detections, std::span<const TagOnSegment> tags);

}  // namespace marey::reconstruct
