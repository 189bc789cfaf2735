// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::testing {

/// Zero moment point of one frame, computed by code that shares nothing with
/// dynamics/balance.
struct JudgedZmp {
  double vertical_force_g = 0.0;  ///< Over the weight.
  glm::dvec2 p_xz_m{0.0};
  /// Distance outside of the support; 0 inside. nullopt: no foot bears.
  std::optional<double> outside_m{};
};

/// Judges all frames by the balance of moments about the centre of mass: the derivative
/// of the angular momentum is the moment of the ground reaction at the zero moment point.
/// Derivatives are those of cubic least squares over `window_s`, by Gaussian elimination;
/// near the ends of parabolas. A point is outside of soles if it sees their corners
/// within half a turn. Preconditions: the map, masses and contacts are those of the
/// motion, which has at least five frames; its gravity is 9.81 m/s^2.
[[nodiscard]] std::vector<JudgedZmp> judge_zmp(const Motion& motion,
                                               const retarget::BodyMap& map,
                                               std::span<const PointMass> masses,
                                               const Contacts& contacts,
                                               double floor_height_m,
                                               double window_s = 0.12);

}  // namespace marey::testing
