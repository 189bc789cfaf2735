// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/com/com_plan.h"
#include "retarget/com/leg_over_foot.h"

namespace marey::retarget {

/// Result of one frame, measured by forward kinematics of the pose.
struct ClosedFrame {
  double com_error_m = 0.0;
  double foot_error_m = 0.0;   ///< Largest, of feet with hold = 1, heel as raised.
  double raised_heel_m = 0.0;  ///< Largest rise of an ankle by rotation.
  double short_leg_m = 0.0;    ///< Largest length by which a leg is too short.
  int evaluations = 0;         ///< Postures of the legs that were tried.
};

/// Moves the root of a posture until its centre of mass is at a target, with the feet at
/// their places. Owns its working memory: close() allocates only if `out` has another
/// number of joints.
class ComCloser {
 public:
  /// Precondition: as follow_com(); the parts of `body` outlive the object.
  explicit ComCloser(const ComFollower& body);

  /// Precondition: the reference has the skeleton's joints. `out` may be the reference.
  ClosedFrame close(const Pose& reference,
                    const glm::dvec3& com_in_world,
                    const std::array<FootGoal, 2>& feet,
                    Pose& out);

 private:
  struct Try {
    std::array<AnkleOverFoot, 2> ankles;
    std::array<LegOverFoot, 2> legs;
    glm::dvec3 com_in_world{0.0};
    double short_leg_m = 0.0;  ///< Before the root gave way.
    double gave_way_m = 0.0;   ///< Distance by which the root gave way.
  };

  void start_frame(const Pose& reference, const std::array<FootGoal, 2>& feet);
  void try_at(glm::dvec3& moved_m, Try& out) const;
  glm::dvec3 find_root(const glm::dvec3& com_in_world, Try& last, int& evaluations);
  void measure(const glm::dvec3& com_in_world, const Pose& pose, ClosedFrame& out);

  ComFollower body_;
  std::array<StandingLeg, 2> legs_;
  std::vector<std::size_t> part_of_mass_;  ///< 0: not a leg's; else 1 + 4 side + part.
  double mass_kg_ = 0.0;
  std::vector<RigidTransform> world_from_joint_;
  std::vector<RigidTransform> closed_from_joint_;
  double other_mass_kg_ = 0.0;
  glm::dvec3 other_moment_{0.0};
  glm::dvec3 com_of_reference_{0.0};
};

}  // namespace marey::retarget
