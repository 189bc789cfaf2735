// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/momentum/repair_flight.h"

#include <optional>

#include "dynamics/momentum/flight_turn.h"
#include "dynamics/momentum/posed_masses.h"
#include <glm/geometric.hpp>

namespace marey::dynamics {
namespace {

constexpr std::size_t kMinPoses = 4;
constexpr int kMaxSteps = 40;
constexpr double kConverged_rad = 1e-7;

}  // namespace

MomentumRepair keep_angular_momentum(const Skeleton& skeleton,
                                     std::span<const PointMass> masses,
                                     FrameRate rate,
                                     std::span<Pose> poses,
                                     const MomentumOptions& options) {
  MomentumRepair out;
  if (poses.size() < kMinPoses) return out;
  FlightTurn flight(skeleton, masses, rate, poses);
  out.sd_before_kg_m2_s = flight.sd_kg_m2_s();
  out.sd_after_kg_m2_s = out.sd_before_kg_m2_s;
  out.momentum_kg_m2_s = flight.mean_momentum();
  bool converged = false;
  for (int i = 0; i < kMaxSteps && !converged; ++i) {
    const std::optional<double> step_rad = flight.step();
    if (!step_rad) break;
    converged = *step_rad < kConverged_rad;
  }
  out.largest_turn_rad = flight.largest_turn_rad();
  if (!converged || !(out.largest_turn_rad <= options.largest_turn_rad)) return out;
  for (std::size_t k = 1; k + 1 < poses.size(); ++k) {
    Pose& pose = poses[k];
    const glm::dvec3& com = flight.com_in_world(k);
    pose.root_in_world = com + flight.turn(k) * (pose.root_in_world - com);
    pose.parent_from_joint[0] =
        glm::normalize(flight.turn(k) * pose.parent_from_joint[0]);
  }
  out.applied = true;
  out.sd_after_kg_m2_s = flight.sd_kg_m2_s();
  out.momentum_kg_m2_s = flight.mean_momentum();
  out.landing_turn_rad =
      glm::length(quick_rotation_vector(flight.turn(poses.size() - 1)));
  return out;
}

}  // namespace marey::dynamics
