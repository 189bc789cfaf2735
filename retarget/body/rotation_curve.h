// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/gtc/quaternion.hpp>

#include "retarget/body/body_map.h"

namespace marey::retarget {

/// A smooth curve of rotations over normalized arc length 0..1: one section of the spine.
/// Knots ascend strictly; the first is at 0, the last at 1.
struct RotationCurve {
  int count = 0;
  std::array<double, kMaxVertebrae + 1> at{};
  std::array<glm::dquat, kMaxVertebrae + 1> rotation{};

  /// Appends a knot. A knot that is not beyond the last replaces it.
  /// Precondition: fewer than kMaxVertebrae + 1 knots.
  void add(double where, const glm::dquat& value);
};

/// Returns the rotation at `where`, clamped to 0..1: exact at the knots, C1 between them
/// (a cubic Bezier of quaternions with Catmull-Rom tangents: Shoemake, "Animating
/// rotation with quaternion curves", 1985). Allocates nothing.
/// Precondition: at least one knot.
[[nodiscard]] glm::dquat sample(const RotationCurve& curve, double where);

}  // namespace marey::retarget
