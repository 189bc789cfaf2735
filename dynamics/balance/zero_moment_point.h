// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dynamics/push/push_ends.h"
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/time.h"

namespace marey::dynamics {

/// Share of the weight below which a body counts as unloaded.
inline constexpr double kLoadedShare = 0.2;

/// Ground reaction of one frame, from motion alone. Per kilogram of the body.
struct GroundReaction {
  glm::dvec3 force_m_s2{0.0};  ///< Acceleration of the centre of mass plus gravity.
  /// Zero moment point on the floor, X and Z in the world; nullopt while the vertical
  /// force is below 0.2 g (flight).
  std::optional<glm::dvec2> zmp_xz_m{};
};

struct ZmpOptions {
  double gravity_m_s2 = kStandardGravity_m_s2;
  double floor_height_m = 0.0;
  double smoothing_s = 0.12;  ///< Full width of the window of the derivatives.
};

/// Computes the ground reaction of every frame (docs/jumps.md, equation of the zero
/// moment point). Derivatives are those of Savitzky-Golay fits (cubic) over
/// `smoothing_s`; at the ends the window is one-sided (parabola). `momentum_per_kg_m2_s`
/// is the angular momentum about the centre of mass per kilogram; empty: the cart-table
/// model. Linear in frames. Preconditions: rate above 0; both spans have the same length
/// unless the second is empty.
[[nodiscard]] std::vector<GroundReaction> ground_reactions(
    std::span<const glm::dvec3> com_in_world,
    std::span<const glm::dvec3> momentum_per_kg_m2_s,
    FrameRate rate,
    const ZmpOptions& options = {});

}  // namespace marey::dynamics
