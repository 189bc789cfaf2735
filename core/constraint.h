// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace marey {

/// Any point of a body, on the skin or within (Kulpa 2005, 3.1.1.2).
struct BodyPoint {
  /// A bone by VRM's name ("leftLowerArm"), or any joint by its own.
  std::string segment;
  /// From the segment's joint, along the T-pose's axes: how the point lies when the body
  /// stands in its T-pose facing +Z. [m]
  glm::dvec3 offset_in_t_pose{0.0};
};

/// Target of a constraint for its point (Kulpa 2005, 3.1.2). Lengths in metres.
struct DistanceToPoint {
  double distance_m = 0.0;  ///< 0 is contact.
  glm::dvec3 p_in_world{0.0};
};
struct DistanceToBody {
  double distance_m = 0.0;
  BodyPoint other;
};
struct DistanceToConstraint {
  double distance_m = 0.0;
  std::string other_id;  ///< Id of the constraint whose point is the other end.
};
struct AllowedSpace {
  glm::dvec3 min_in_world{0.0};
  glm::dvec3 max_in_world{0.0};
};
struct ForbiddenSpace {
  glm::dvec3 min_in_world{0.0};
  glm::dvec3 max_in_world{0.0};
};
struct SegmentOrientation {
  /// Rotation of the segment from the T-pose, in world axes.
  glm::dquat world_from_t_pose{1.0, 0.0, 0.0, 0.0};
};
/// A standing foot. Always satisfied, whatever the other constraints (Kulpa 2005,
/// 3.1.1.1).
struct Support {
  /// Place of the constraint's point (the ankle); nullopt: its place in the reference
  /// posture when the support begins.
  std::optional<glm::dvec3> footprint_in_world;
  /// nullopt: as in the reference posture.
  std::optional<glm::dquat> world_from_t_pose;
  /// The foot bears on its point alone (heel, ball, tip of a toe) and may turn about it.
  bool turns = false;
};

using Goal = std::variant<DistanceToPoint,
                          DistanceToBody,
                          DistanceToConstraint,
                          AllowedSpace,
                          ForbiddenSpace,
                          SegmentOrientation,
                          Support>;

/// Returns the place of a goal in the world: its point, its footprint or the middle of
/// its box; nullopt: it has none.
[[nodiscard]] inline std::optional<glm::dvec3> target_in_world(const Goal& goal) {
  if (const auto* point = std::get_if<DistanceToPoint>(&goal)) return point->p_in_world;
  if (const auto* support = std::get_if<Support>(&goal)) {
    return support->footprint_in_world;
  }
  if (const auto* box = std::get_if<AllowedSpace>(&goal)) {
    return 0.5 * (box->min_in_world + box->max_in_world);
  }
  if (const auto* box = std::get_if<ForbiddenSpace>(&goal)) {
    return 0.5 * (box->min_in_world + box->max_in_world);
  }
  return std::nullopt;
}

/// Time in which a constraint is active. It fades in over `start_duration_s` from
/// `start_s` on, and out over `stop_duration_s` from `stop_s` on, with continuous speed
/// and acceleration.
struct Activation {
  std::optional<double> start_s;  ///< nullopt: from the start.
  std::optional<double> stop_s;   ///< nullopt: to the end.
  double start_duration_s = 0.0;
  double stop_duration_s = 0.0;
};

/// One constraint on a posture, as the user gives it (Kulpa 2005, 3.1.1). Adaptation
/// turns every type into points and targets.
struct Constraint {
  std::string id;
  BodyPoint point;
  Goal goal;
  /// Maximum number of segments, its own included, that may turn for it, counted up the
  /// chain. The root moves for it when the count reaches the root's segment. nullopt:
  /// all.
  std::optional<int> range;
  double importance = 1.0;     ///< > 0. A priority or a weight, depending on the solver.
  double precision_m = 0.001;  ///< Satisfied if nearer than this.
  Activation activation;
  /// Elements of a constraint file that marey does not know, kept as they were read.
  std::vector<std::string> unknown_xml;
};

/// The constraints of a motion. Ids are all different.
struct ConstraintSet {
  std::vector<Constraint> constraints;
  std::vector<std::string> unknown_xml;  ///< As in Constraint.

  [[nodiscard]] const Constraint* find(std::string_view id) const {
    for (const Constraint& c : constraints) {
      if (c.id == id) return &c;
    }
    return nullptr;
  }
  [[nodiscard]] Constraint* find(std::string_view id) {
    return const_cast<Constraint*>(std::as_const(*this).find(id));
  }
};

}  // namespace marey
