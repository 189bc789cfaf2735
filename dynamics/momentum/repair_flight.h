// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::dynamics {

/// Outcome of keep_angular_momentum(). [kg m^2/s] are standard deviations over the flight
/// of the component that varies most, by central differences.
struct MomentumRepair {
  /// False: poses are unchanged, since the turn would exceed the option, or since no turn
  /// was found (somersaults of a whole number of half turns may have none).
  bool applied = false;
  double sd_before_kg_m2_s = 0.0;
  double sd_after_kg_m2_s = 0.0;
  double largest_turn_rad = 0.0;     ///< Rotation added on the way, or needed.
  double landing_turn_rad = 0.0;     ///< Rotation that remains in the last frame.
  glm::dvec3 momentum_kg_m2_s{0.0};  ///< Angular momentum of the repaired flight.
};

struct MomentumOptions {
  double largest_turn_rad = 0.5236;  ///< 30 degrees.
};

/// Turns the body about its centre of mass in each frame of a flight, so that its angular
/// momentum is constant (docs/jumps.md). The first and the last pose keep their rotation,
/// so the landing posture is kept; the centre of mass stays where it is in every frame.
/// `poses` are the frames from the last one that bears to the first one that bears again;
/// the motion of neighbouring frames outside is not used. Changes roots only. Fewer than
/// 4 poses: unchanged. Preconditions: as centroidal_states().
///
/// Newton's method on the rotations of all frames and on the constant momentum, whose
/// equations are the central differences of the turned frames: their momentum is constant
/// to 1e-6 kg m^2/s. The equations leave three unknowns open (an offset between even and
/// odd frames); the smoothest rotation is taken. Linear in frames, 4 to 6 steps; all
/// memory is allocated at the start.
MomentumRepair keep_angular_momentum(const Skeleton& skeleton,
                                     std::span<const PointMass> masses,
                                     FrameRate rate,
                                     std::span<Pose> poses,
                                     const MomentumOptions& options = {});

}  // namespace marey::dynamics
