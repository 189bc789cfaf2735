// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/posture_measures.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include <glm/geometric.hpp>

#include "core/transform.h"

namespace marey {
namespace {

glm::dvec3 centre_of(const std::vector<PointMass>& masses,
                     std::span<const RigidTransform> world_from_joint) {
  glm::dvec3 moment{0.0};
  double mass_kg = 0.0;
  for (const PointMass& m : masses) {
    moment += m.mass_kg * (world_from_joint[index(m.joint)] * m.p_in_joint);
    mass_kg += m.mass_kg;
  }
  return moment / mass_kg;
}

}  // namespace

PostureMeasure measure_posture(const Character& character,
                               std::span<const PointGoal> goals,
                               std::span<const glm::dvec3> targets_in_world,
                               const glm::dvec3& com_in_world,
                               const Pose& reference,
                               const Pose& found) {
  const Skeleton& skeleton = character.skeleton;
  const auto world_from_joint = world_from_joints(skeleton, found);
  PostureMeasure m;
  int free_goals = 0;
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const double error_m = glm::distance(
        world_from_joint[index(goals[k].joint)].translation, targets_in_world[k]);
    m.worst_point_m = std::max(m.worst_point_m, error_m);
    if (goals[k].is_planted) {
      m.planted_m = std::max(m.planted_m, error_m);
    } else {
      m.mean_point_m += error_m;
      ++free_goals;
    }
  }
  m.mean_point_m /= std::max(free_goals, 1);
  const glm::dvec3 off = centre_of(character.masses, world_from_joint) - com_in_world;
  m.com_m = std::hypot(off.x, off.z);
  double squares = 0.0;
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const double angle_rad = glm::length(rotation_vector(
        glm::conjugate(reference.parent_from_joint[i]) * found.parent_from_joint[i]));
    squares += angle_rad * angle_rad;
  }
  m.deviation_rad = std::sqrt(squares / static_cast<double>(skeleton.joints.size()));
  m.displacement_m = mean_joint_distance_m(skeleton, reference, found);
  return m;
}

double mean_joint_distance_m(const Skeleton& skeleton, const Pose& a, const Pose& b) {
  const auto world_from_a = world_from_joints(skeleton, a);
  const auto world_from_b = world_from_joints(skeleton, b);
  double sum_m = 0.0;
  for (std::size_t i = 0; i < world_from_a.size(); ++i) {
    sum_m += glm::distance(world_from_a[i].translation, world_from_b[i].translation);
  }
  return sum_m / static_cast<double>(world_from_a.size());
}

glm::dvec3 centre_of_mass(const Character& character, const Pose& pose) {
  return centre_of(character.masses, world_from_joints(character.skeleton, pose));
}

double now_us() {
  return std::chrono::duration<double, std::micro>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

double processor_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double mean(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

}  // namespace marey
