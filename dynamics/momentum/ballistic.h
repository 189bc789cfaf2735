// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "dynamics/momentum/repair_flight.h"
#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/base/time.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::dynamics {

/// Returns the frames of a flight between two instants [s] (ComState::time_s of a Jump's
/// take-off and touch-down): from the last frame that bears to the first one that bears
/// again. nullopt: such a frame is outside of the motion, or the instants are not in
/// order. Precondition: rate above 0.
[[nodiscard]] std::optional<FrameRange> flight_frames(double takeoff_s,
                                                      double touchdown_s,
                                                      FrameRate rate,
                                                      std::size_t pose_count);

/// Places of the centre of mass. [m]
struct BallisticEnds {
  glm::dvec3 first_in_world{0.0};  ///< At the first pose.
  glm::dvec3 last_in_world{0.0};   ///< At the last pose.
};

struct BallisticOptions {
  double gravity_m_s2 = 9.81;  ///< Downwards.
  bool keep_momentum = true;   ///< Also make the angular momentum constant.
  MomentumOptions momentum{};
  /// Other ends of the parabola, as that of a Jump has them at these two poses. Then the
  /// first and the last pose are displaced too, by some millimetres, and the caller
  /// continues that displacement into the support.
  std::optional<BallisticEnds> ends{};
};

struct BallisticReport {
  bool applied = false;  ///< False: fewer than 3 poses.
  /// Displacement of the centre of mass, of all poses.
  double moved_rms_m = 0.0;
  double moved_max_m = 0.0;
  /// Velocity of the parabola at the first and at the last pose.
  glm::dvec3 first_velocity_m_s{0.0};
  glm::dvec3 last_velocity_m_s{0.0};
  MomentumRepair momentum{};
};

/// Makes a captured flight a free fall: moves the root of each pose so that the centre of
/// mass is on the parabola with that gravity through its places in the first and the last
/// pose, then keep_angular_momentum(). Without BallisticOptions::ends the first and the
/// last pose stay to the bit, so the feet on the floor do not move and nothing outside of
/// the flight changes. The
/// duration stays: a capture that falls with another acceleration gets another velocity
/// at take-off and landing (by half the difference times the duration). The centre of
/// mass is on the parabola to 1e-9 m.
///
/// `poses` are the frames from the last one that bears to the first one that bears again:
/// flight_frames(). Linear in frames. Preconditions: as centroidal_states(); gravity is
/// finite.
BallisticReport make_ballistic(const Skeleton& skeleton,
                               std::span<const PointMass> masses,
                               FrameRate rate,
                               std::span<Pose> poses,
                               const BallisticOptions& options = {});

}  // namespace marey::dynamics
