// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/humanoid.h"
#include "core/motion.h"

namespace marey::app {

/// Place of a joint in a drawing [mm]: to the right of the hips, above the floor.
struct DrawnPoint {
  std::int16_t x = 0;
  std::int16_t y = 0;
};

/// A posture in the order of human_bones(). A bone that the body lacks is at its parent.
using DrawnPose = std::array<DrawnPoint, kHumanBoneCount>;

inline constexpr std::size_t kDrawnPoses = 4;

/// Four postures of a clip, from the middles of its quarters.
struct ClipDrawing {
  std::array<DrawnPose, kDrawnPoses> poses{};
};

/// Draws a motion in normal form without perspective, from a level eye that is 35 degrees
/// to the right of the direction that the body faces in the first posture. Each posture
/// has its hips at x = 0; heights are those in the world. Constant time in frames.
/// Precondition: the motion has poses.
[[nodiscard]] ClipDrawing draw_clip(const Motion& motion);

}  // namespace marey::app
