// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/motion.h"

namespace marey {

/// Parts of the feet that bear in a frame: left heel, left ball, right heel, right ball.
using FootParts = std::array<std::uint8_t, 4>;

/// The motion of a clip, on its own body: in marey's frame (Y up, at rest in a T-pose
/// that faces +Z), in metres, with the floor at Y = 0 and marked bones (Joint::bone).
struct LibraryMotion {
  Motion motion;
  std::vector<FootParts> contacts;  ///< One per pose.
  /// Uncertainty, [frame][joint]; empty: unknown.
  std::vector<std::vector<JointUncertainty>> uncertainty;
};

}  // namespace marey
