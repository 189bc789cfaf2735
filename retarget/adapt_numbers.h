// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/pose.h"
#include "retarget/adapt_plan.h"

/// What goes into a lane, as plain single precision in the order in which it is loaded
/// (retarget/adapt_load.h). Lengths are over the body's own unit, places from the root of
/// the reference posture: so that thresholds mean the same for a child and a giant, and
/// single precision is used where it is finest.
namespace marey::retarget {

/// What never changes of a body.
struct BodyNumbers {
  double unit_m = 1.0;  ///< A leg's length, else a limb's, else the longest chain's.
  std::vector<float> packed;
  /// Where the masses begin in `packed`: they alone change, when a load is taken up.
  std::size_t masses_at = 0;
};

/// Precondition: as make_plan().
[[nodiscard]] BodyNumbers body_numbers(const Character& character, const Plan& plan);

/// Mass `index` of Plan::masses becomes this.
void set_mass(BodyNumbers& body, std::size_t index, double mass_kg);

/// World rotation of each joint's frame in the T-pose (Character::t_pose_from_joint).
[[nodiscard]] std::vector<glm::dquat> t_pose_rotations(const Character& character);

/// A reference posture: every joint's rotation in its parent. `out` has 4 numbers per
/// joint. Precondition: finite, unit rotations.
void pack_posture(const Pose& pose, std::span<float> out);

/// One wish at one moment, in world metres.
struct WishNumbers {
  glm::dvec3 in_joint{0.0};    ///< The point, in its joint's frame.
  glm::dvec3 a_in_world{0.0};  ///< Place; low corner; footprint.
  /// High corner, in the world; the other point, in its joint's frame.
  glm::dvec3 b{0.0};
  glm::dquat world_from_joint{1.0, 0.0, 0.0, 0.0};
  double distance_m = 0.0;
  bool active = false;
  double weight = 1.0;
  double precision_m = 0.001;
};

inline constexpr std::size_t kNumbersPerWish = 17;

/// `wishes` are as Plan::points.
void pack_wishes(const Plan& plan,
                 const BodyNumbers& body,
                 const glm::dvec3& origin_in_world,
                 std::span<const WishNumbers> wishes,
                 std::span<float> out);

struct BalanceNumbers {
  bool wanted = false;
  bool vertical = false;
  double precision_m = 1e-4;
  /// Where the centre of mass is wanted.
  glm::dvec3 com_in_world{0.0};
  bool from_reference = true;  ///< Where the reference has it, instead.
  double root_weight = 1.0;    ///< Vertical: the root's share of its travel.
  double root_weight_on_floor = 1.0;
  /// Of changes of error from step to step: less is no progress.
  double constraint_threshold_m = 1e-4;
  double balance_threshold_m = 1e-5;
};

inline constexpr std::size_t kBalanceNumbers = 11;

void pack_balance(const BodyNumbers& body,
                  const glm::dvec3& origin_in_world,
                  const BalanceNumbers& balance,
                  std::span<float> out);

}  // namespace marey::retarget
