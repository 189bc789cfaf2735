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

/// For a trial in which reconstruct::check_views() fails: finds the one video whose turn
/// by 180 degrees makes it succeed, and returns it as kBadInput. nullopt if there is
/// none. Detections one per camera, shrinkage taken off. Cost: that of check_views() for
/// each camera.
[[nodiscard]] std::optional<Error> find_turned_video(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    std::span<const TagOnSegment> tags);

}  // namespace marey::app
