// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: velocity of a target with a pose at every instant.

#include <optional>

#include <Eigen/Dense>

#include "calib/model/rig_model.h"

namespace marey::calib {

/// In the world.
struct Velocity {
  Eigen::Vector3d turn_rad_s;
  Eigen::Vector3d move_m_s;
};

/// Computes the velocity from the poses at the neighbouring instants. Returns nullopt if
/// one of these is more than a quarter of a second away or the pose jumps (the wrong one
/// of two planar pose solutions).
[[nodiscard]] std::optional<Velocity> velocity_at(const RigidTarget& target,
                                                  int instant,
                                                  double rate_hz);

}  // namespace marey::calib
