// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/pose.h"
#include "retarget/adapt/plan/adapt_plan.h"

/// Input of a lane in single precision, in the order in which it is loaded
/// (retarget/adapt/kernel/adapt_load.h). Lengths are divided by the body's own unit, and
/// positions are relative to the root of the reference posture. Thresholds are therefore
/// independent of body size, and single precision has its best resolution.
namespace marey::retarget {

/// Constants of a body.
struct BodyNumbers {
  double unit_m = 1.0;  ///< Length of a leg; without legs of a limb; without limbs of the
                        ///< longest chain.
  std::vector<float> packed;
  /// Index of the first mass in `packed`: 4 numbers per element of Plan::masses, the mass
  /// in kilograms first. Only masses change, when a load is picked up.
  std::size_t masses_at = 0;
};

/// Returns the count of the constants of a body with this plan.
[[nodiscard]] std::size_t body_number_count(const Plan& plan);

/// Packs the constants of a character. Precondition: as make_plan().
[[nodiscard]] BodyNumbers body_numbers(const Character& character, const Plan& plan);

/// Returns the world rotation of each joint's frame in the T-pose
/// (Character::t_pose_from_joint).
[[nodiscard]] std::vector<glm::dquat> t_pose_rotations(const Character& character);

/// Packs a reference posture: the rotation of every joint in its parent. `out` has 4
/// numbers per joint. Precondition: finite, unit rotations.
void pack_posture(const Pose& pose, std::span<float> out);

/// One target at one moment, in world metres.
struct TargetNumbers {
  glm::dvec3 in_joint{0.0};    ///< Constrained point in the frame of its joint.
  glm::dvec3 a_in_world{0.0};  ///< Position; lower corner; footprint.
  /// Upper corner, in the world; the other point, in the frame of its joint.
  glm::dvec3 b{0.0};
  glm::dquat world_from_joint{1.0, 0.0, 0.0, 0.0};
  double distance_m = 0.0;
  bool active = false;
  double weight = 1.0;
  double precision_m = 0.001;
};

inline constexpr std::size_t kNumbersPerTarget = 17;

/// Packs targets. `targets` has the order of Plan::points. `unit_m` is that of the body.
void pack_targets(const Plan& plan,
                  double unit_m,
                  const glm::dvec3& origin_in_world,
                  std::span<const TargetNumbers> targets,
                  std::span<float> out);
inline void pack_targets(const Plan& plan,
                         const BodyNumbers& body,
                         const glm::dvec3& origin_in_world,
                         std::span<const TargetNumbers> targets,
                         std::span<float> out) {
  pack_targets(plan, body.unit_m, origin_in_world, targets, out);
}

struct BalanceNumbers {
  bool wanted = false;
  bool vertical = false;
  double precision_m = 1e-4;
  /// Target of the centre of mass.
  glm::dvec3 com_in_world{0.0};
  bool from_reference = true;  ///< If true, its position in the reference is used
                               ///< instead.
  double root_weight = 1.0;    ///< Vertical share of the root's translation.
  double root_weight_on_floor = 1.0;
  /// Thresholds for changes of the errors between steps; smaller changes are no progress.
  double constraint_threshold_m = 1e-4;
  double balance_threshold_m = 1e-5;
};

inline constexpr std::size_t kBalanceNumbers = 11;

void pack_balance(double unit_m,
                  const glm::dvec3& origin_in_world,
                  const BalanceNumbers& balance,
                  std::span<float> out);
inline void pack_balance(const BodyNumbers& body,
                         const glm::dvec3& origin_in_world,
                         const BalanceNumbers& balance,
                         std::span<float> out) {
  pack_balance(body.unit_m, origin_in_world, balance, out);
}

}  // namespace marey::retarget
