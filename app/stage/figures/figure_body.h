// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"

namespace marey::app {

/// The floor under a foot in one step.
struct FigureFloor {
  glm::dvec3 moved_m{0.0};  ///< Since the start.
  glm::dvec3 normal_in_world{0.0, 1.0, 0.0};
};

/// The steps of a scene as one body played them. Borrows everything.
struct FigureBody {
  std::string id;
  const Character* character = nullptr;
  const retarget::BodyMap* map = nullptr;  ///< Made from the character's skeleton.
  std::span<const double> times_s;         ///< Ascending, on the clock of the scene.
  std::span<const Pose> poses;             ///< One per step.
  /// The postures before feet, constraints and balance; empty: not kept.
  std::span<const Pose> references;
  /// Left, right: the foot stands; empty: not kept.
  std::span<const std::array<bool, 2>> stands;
  /// Left, right; empty: still and level.
  std::span<const std::array<FigureFloor, 2>> floor;
};

/// Steps of a scene in which a figure is measured.
struct FigureSpan {
  double from_s = 0.0;
  std::optional<double> to_s;  ///< nullopt: to the end.
  [[nodiscard]] bool contains(double time_s) const {
    return time_s >= from_s - 1e-9 && (!to_s || time_s <= *to_s + 1e-9);
  }
};

/// Forward kinematics of one body, posture by posture.
class FigureFrames {
 public:
  explicit FigureFrames(const FigureBody& body);
  /// Computes the joints of a posture of this body. Valid until the next call.
  [[nodiscard]] std::span<const RigidTransform> joints(const Pose& pose);

 private:
  const Skeleton& skeleton_;
  std::vector<RigidTransform> joints_;
};

/// A point of a body whose joint is known.
struct FigurePoint {
  JointIndex joint{};
  glm::dvec3 offset_in_joint{0.0};
  [[nodiscard]] glm::dvec3 in_world(
      std::span<const RigidTransform> world_from_joint) const {
    return world_from_joint[index(joint)] * offset_in_joint;
  }
};

/// nullopt: the body has no such segment.
[[nodiscard]] std::optional<FigurePoint> find_point(const FigureBody& body,
                                                    const BodyPoint& point);

/// Returns the place of a point in all steps. [m] Linear.
[[nodiscard]] std::vector<glm::dvec3> point_path(const FigureBody& body,
                                                 const FigurePoint& point);

/// Returns a place between the steps, linear in time; before the first and after the last
/// step those. Precondition: as many places as times, at least one.
[[nodiscard]] glm::dvec3 place_at(std::span<const double> times_s,
                                  std::span<const glm::dvec3> places,
                                  double time_s);

}  // namespace marey::app
