// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "benchmarks/baseline/gauss_newton_baseline.h"
#include "core/character.h"
#include "core/pose.h"

namespace marey {

/// A scene like the thesis' (Kulpa 2005, figure 4.23, published without numbers): a
/// person of 1.75 m stands at ease. The wrists and the right ankle have targets, and the
/// left foot is planted.
struct StandingScene {
  Character character;
  Pose reference;
  std::vector<PointGoal> goals;  ///< Right wrist, left wrist, right ankle, left ankle.
  glm::dvec3 com_in_world{0.0};  ///< Centre of mass of the reference.

  using Targets = std::array<glm::dvec3, 4>;
  Targets near{};         ///< The limbs suffice.
  Targets far{};          ///< The whole body can reach them.
  Targets unreachable{};  ///< Far from each other; none can be reached.
};

[[nodiscard]] StandingScene standing_scene();

}  // namespace marey
