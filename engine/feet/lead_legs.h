// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "engine/clips/rig.h"
#include "engine/clips/sample_clip.h"
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/engine/blend_posture.h"

namespace marey::engine {

/// A foot of a posture, or a place for it.
struct LedFoot {
  glm::dvec3 ankle_in_world{0.0};
  glm::dquat world_from_t_pose{1.0, 0.0, 0.0, 0.0};
  double stands = 0.0;  ///< Share, 0 to 1, with which the hips are lowered for it.
};

/// Greatest distance by which lead_legs() lowers the hips. [m]
inline constexpr double kMostHipsDrop_m = 0.03;

/// Returns the feet of a posture at a place.
[[nodiscard]] std::array<LedFoot, 2> feet_of_posture(const Rig& rig,
                                                     const RootPlace& root,
                                                     const BlendPosture& posture);

/// Turns, bends and stretches the legs of a posture so that its feet are at the given
/// places. The hips keep their place, except that they are lowered by `drop_share` times
/// what a standing foot needs, at most kMostHipsDrop_m. Feet beyond the reach of their
/// legs (leg_reach_m()) are changed to the nearest places. About 0.3 us.
void lead_legs(const Rig& rig,
               const RootPlace& root,
               double drop_share,
               std::array<LedFoot, 2>& feet,
               BlendPosture& posture);

}  // namespace marey::engine
