// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>

#include "core/camera.h"

namespace marey::recordings {

/// Returns the rotation of a matrix given row after row; nullopt if it is none. Matrices
/// rounded to four digits are accepted.
[[nodiscard]] std::optional<glm::dquat> rotation_of_rows(std::span<const double, 9> rows);

/// Sets focal lengths and centre from [fx, 0, cx, 0, fy, cy, 0, 0, 1]. Returns false and
/// leaves `intrinsics` unchanged if `rows` has another form.
[[nodiscard]] bool set_pinhole(std::span<const double, 9> rows, Intrinsics& intrinsics);

/// Sets the distortion terms, in OpenCV's order: none, 4 or 5 (Brown and Conrady), 8
/// (rational), or up to 14 of which those after the eighth are zero; 4 for a fisheye.
/// Returns false otherwise.
[[nodiscard]] bool set_distortion(std::span<const double> terms,
                                  bool is_fisheye,
                                  Intrinsics& intrinsics);

/// Maximum distance of a camera from its world's origin. Cameras in a room or hall are
/// nearer; those of a file in millimetres are farther. [m]
inline constexpr double kMaxCameraDistance_m = 100.0;

}  // namespace marey::recordings
