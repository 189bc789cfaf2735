// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>

#include "core/camera.h"

namespace marey::recordings {

/// The rotation of a matrix, row after row; nullopt when it is none. What was rounded to
/// four digits still is.
[[nodiscard]] std::optional<glm::dquat> rotation_of_rows(std::span<const double, 9> rows);

/// Takes focal lengths and centre from [fx, 0, cx, 0, fy, cy, 0, 0, 1]. False, with
/// `intrinsics` untouched, when `rows` has another form.
[[nodiscard]] bool set_pinhole(std::span<const double, 9> rows, Intrinsics& intrinsics);

/// Takes the terms in OpenCV's order: none, 4 or 5 (Brown and Conrady), 8 (rational), or
/// up to 14 of which those after the eighth are zero; 4 of a fisheye. False otherwise.
[[nodiscard]] bool set_distortion(std::span<const double> terms,
                                  bool is_fisheye,
                                  Intrinsics& intrinsics);

/// Cameras of a room or a hall stand nearer to their world's origin; a file in
/// millimetres has them beyond. [m]
inline constexpr double kFarthest = 100.0;

}  // namespace marey::recordings
