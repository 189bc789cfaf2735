// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: how fast a target moves that has a pose at every instant.

#include <optional>

#include <Eigen/Dense>

#include "calib/rig_model.h"

namespace marey::calib {

/// In the world.
struct Velocity {
  Eigen::Vector3d turn_rad_s;
  Eigen::Vector3d move_m_s;
};

/// From the poses at its neighbouring instants; nullopt where one of these is more than
/// a quarter of a second away, or the pose jumps (a view of a plane that was read the
/// wrong way round).
[[nodiscard]] std::optional<Velocity> velocity_at(const RigidTarget& target,
                                                  int instant,
                                                  double rate_hz);

}  // namespace marey::calib
