// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/com/bend_leg.h"
#include "retarget/com/com_plan.h"
#include "retarget/com/raise_heel.h"

namespace marey::retarget {

/// Rigid part of a leg: thigh, shank, foot or toes, with everything that hangs on it.
struct LegPart {
  double mass_kg = 0.0;
  glm::dvec3 moment{0.0};  ///< Mass times place relative to the part's joint. [kg m]
};

/// Place of an ankle above its foot, before the leg is bent.
struct AnkleOverFoot {
  glm::dvec3 ankle_from_hip{0.0};  ///< World axes; the heel raised. [m]
  double heel_rise_rad = 0.0;
  /// Length by which the leg is too short. Negative: it cannot fold as far. [m]
  double short_m = 0.0;
};

/// Turns of a leg that stands on its foot, in world axes.
struct LegOverFoot {
  LegTurns turns;
  glm::dquat foot{1.0, 0.0, 0.0, 0.0};  ///< Takes the reference's foot to its place.
  glm::dvec3 ankle_in_world{0.0};
  glm::dvec3 moment{0.0};  ///< Sum of mass times place in the world. [kg m]
};

/// One leg while the root moves: its foot at its place, thigh and shank between.
/// Allocates nothing.
class StandingLeg {
 public:
  /// Precondition: `map` was made from `skeleton`; both outlive the object.
  StandingLeg(const Skeleton& skeleton, const BodyMap& map, int side);

  /// Returns the part that carries a joint: 0 thigh, 1 shank, 2 foot, 3 toes; nullopt if
  /// the joint does not belong to this leg.
  [[nodiscard]] std::optional<std::size_t> part_of(JointIndex joint) const;
  /// Joint of a part; without toes that of the foot.
  [[nodiscard]] JointIndex joint(std::size_t part) const { return joints_[part]; }

  /// Takes over a reference posture, the masses of its parts and the wanted place.
  void start_frame(std::span<const RigidTransform> world_from_joint,
                   const std::array<LegPart, 4>& parts,
                   const FootGoal& goal);

  [[nodiscard]] double hold() const { return hold_; }
  /// As FootGoal::root_gives_way.
  [[nodiscard]] double root_gives_way() const { return root_gives_way_; }
  /// True if the wanted place is the reference's own.
  [[nodiscard]] bool is_at_goal() const { return is_at_goal_; }
  [[nodiscard]] double length_m() const { return bones_.length_m; }
  /// Derivative of moment by the root's position, the knee's sidewise way left out. [kg]
  [[nodiscard]] double moved_mass_kg() const;

  /// Returns the place of the ankle after the root moved by `moved_m`.
  [[nodiscard]] AnkleOverFoot ankle_over_foot(const glm::dvec3& moved_m) const;
  /// Returns the displacement of the ankle by the rise of the heel. [m]
  [[nodiscard]] glm::dvec3 rise_m(const AnkleOverFoot& ankle) const;
  /// Bends the leg to it.
  [[nodiscard]] LegOverFoot bend(const glm::dvec3& moved_m,
                                 const AnkleOverFoot& ankle) const;
  /// Writes the leg into a pose that was the reference's.
  void write(const LegOverFoot& leg,
             std::span<const RigidTransform> world_from_joint,
             Pose& pose) const;

 private:
  void set_reach();

  const Skeleton& skeleton_;
  const BodyMap& map_;
  std::size_t side_;
  std::array<JointIndex, 4> joints_{};
  bool has_toes_ = false;

  std::array<LegPart, 4> parts_;
  LegBones bones_;
  HeelLever lever_;
  glm::dvec3 hip_in_world_{0.0};
  glm::dvec3 ankle_in_world_{0.0};
  glm::dvec3 toes_from_ankle_{0.0};
  glm::dvec3 goal_in_world_{0.0};
  glm::dquat foot_turn_{1.0, 0.0, 0.0, 0.0};
  glm::dquat toes_turn_{1.0, 0.0, 0.0, 0.0};
  double hold_ = 0.0;
  double root_gives_way_ = 1.0;
  bool is_at_goal_ = true;
  double max_reach_m_ = 0.0;
  double min_reach_m_ = 0.0;
};

}  // namespace marey::retarget
