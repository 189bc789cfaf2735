// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/constraint_copies.h"

#include <cmath>
#include <optional>
#include <variant>

#include <glm/geometric.hpp>

namespace marey::edit {
namespace {

/// Compares two goals of one type.
struct SameGoal {
  const Goal& other;
  const GoalTolerance& tolerance;

  [[nodiscard]] bool near(const glm::dvec3& a, const glm::dvec3& b) const {
    return glm::distance(a, b) < tolerance.place_m;
  }
  [[nodiscard]] bool near(const glm::dquat& a, const glm::dquat& b) const {
    return 1.0 - std::abs(glm::dot(a, b)) < tolerance.rotation;
  }
  template <class T>
  [[nodiscard]] bool near(const std::optional<T>& a, const std::optional<T>& b) const {
    return a.has_value() == b.has_value() && (!a || near(*a, *b));
  }

  bool operator()(const DistanceToPoint& a) const {
    const auto& b = std::get<DistanceToPoint>(other);
    return a.distance_m == b.distance_m && near(a.p_in_world, b.p_in_world);
  }
  bool operator()(const DistanceToBody& a) const {
    const auto& b = std::get<DistanceToBody>(other);
    return a.distance_m == b.distance_m && a.other.segment == b.other.segment &&
           near(a.other.offset_in_t_pose, b.other.offset_in_t_pose);
  }
  bool operator()(const DistanceToConstraint& a) const {
    const auto& b = std::get<DistanceToConstraint>(other);
    return a.distance_m == b.distance_m && a.other_id == b.other_id;
  }
  bool operator()(const AllowedSpace& a) const {
    const auto& b = std::get<AllowedSpace>(other);
    return near(a.min_in_world, b.min_in_world) && near(a.max_in_world, b.max_in_world);
  }
  bool operator()(const ForbiddenSpace& a) const {
    const auto& b = std::get<ForbiddenSpace>(other);
    return near(a.min_in_world, b.min_in_world) && near(a.max_in_world, b.max_in_world);
  }
  bool operator()(const SegmentOrientation& a) const {
    return near(a.world_from_t_pose,
                std::get<SegmentOrientation>(other).world_from_t_pose);
  }
  bool operator()(const Support& a) const {
    const auto& b = std::get<Support>(other);
    return a.turns == b.turns && near(a.footprint_in_world, b.footprint_in_world) &&
           near(a.world_from_t_pose, b.world_from_t_pose);
  }
};

}  // namespace

bool is_same_goal(const Goal& a, const Goal& b, const GoalTolerance& tolerance) {
  return a.index() == b.index() && std::visit(SameGoal{b, tolerance}, a);
}

bool is_same_point(const BodyPoint& a, const BodyPoint& b) {
  constexpr double kSamePlace_m = 1e-9;
  return a.segment == b.segment &&
         glm::distance(a.offset_in_t_pose, b.offset_in_t_pose) < kSamePlace_m;
}

std::string free_constraint_id(const ConstraintSet& set, std::string_view id) {
  if (set.find(id) == nullptr) return std::string(id);
  std::string family = std::string(id) + ".";
  const std::size_t last = id.find_last_not_of("0123456789");
  if (last != std::string_view::npos && last + 1 < id.size() && id[last] == ' ') {
    family = std::string(id.substr(0, last + 1));
  }
  int number = 2;
  while (set.find(family + std::to_string(number)) != nullptr) ++number;
  return family + std::to_string(number);
}

}  // namespace marey::edit
