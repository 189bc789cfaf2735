// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "benchmarks/baseline/gauss_newton_baseline.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey {

/// Errors of a posture, computed by the same forward kinematics in double for every
/// solver.
struct PostureMeasure {
  double worst_point_m = 0.0;   ///< The largest error of a goal.
  double mean_point_m = 0.0;    ///< The mean error of the goals that are not planted.
  double planted_m = 0.0;       ///< The largest error of a planted goal.
  double com_m = 0.0;           ///< The horizontal error of the centre of mass.
  double deviation_rad = 0.0;   ///< From the reference: root mean square over joints of
                                ///< the angle of each one's rotation in its parent.
  double displacement_m = 0.0;  ///< From the reference: mean over joints.
};

[[nodiscard]] PostureMeasure measure_posture(const Character& character,
                                             std::span<const PointGoal> goals,
                                             std::span<const glm::dvec3> targets_in_world,
                                             const glm::dvec3& com_in_world,
                                             const Pose& reference,
                                             const Pose& found);

/// Mean distance between the joints of two postures. [m]
[[nodiscard]] double mean_joint_distance_m(const Skeleton& skeleton,
                                           const Pose& a,
                                           const Pose& b);

/// The centre of mass. Precondition: the masses' sum is positive.
[[nodiscard]] glm::dvec3 centre_of_mass(const Character& character, const Pose& pose);

/// Microseconds of a monotonic clock.
[[nodiscard]] double now_us();

/// Returns the processor time of this thread in microseconds. It suits measurements that
/// are long enough for an interruption by other programs. One call takes a large part of
/// a microsecond.
[[nodiscard]] double processor_us();

/// Arithmetic mean; 0 if there are no values.
[[nodiscard]] double mean(std::span<const double> values);

}  // namespace marey
