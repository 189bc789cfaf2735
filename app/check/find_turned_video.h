// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::app {

/// Searches for a video that is turned by 180 degrees, in a trial in which
/// reconstruct::check_views() fails. Returns kBadInput with the first video that makes
/// check_views() succeed when it is turned; nullopt if there is none. `detections` has
/// one entry per camera, corrected for shrinkage. Cost: that of check_views() for each
/// camera.
[[nodiscard]] std::optional<Error> find_turned_video(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    std::span<const TagOnSegment> tags);

}  // namespace marey::app
