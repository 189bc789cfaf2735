// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/point_figures.h"

#include <optional>

#include <glm/geometric.hpp>

namespace marey::app {
namespace {

constexpr double kMetreInMm = 1000.0;

/// An arm and the length that a point of it is away from the shoulder at most.
struct ArmReach {
  JointIndex shoulder{};
  double length_m = 0.0;
};

std::optional<ArmReach> arm_of(const FigureBody& body, const FigurePoint& point) {
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& arm = body.map->limbs[side];
    if (!arm) continue;
    const double offset_m = glm::length(point.offset_in_joint);
    if (point.joint == arm->end) return ArmReach{arm->upper, arm->length_m() + offset_m};
    if (point.joint == arm->lower) {
      return ArmReach{arm->upper, arm->upper_length_m + offset_m};
    }
  }
  return std::nullopt;
}

}  // namespace

ReachedError reached_error_mm(const FigureBody& body,
                              const FigurePoint& point,
                              std::span<const glm::dvec3> targets_in_world,
                              const FigureSpan& span) {
  const std::optional<ArmReach> arm = arm_of(body, point);
  FigureFrames frames(body);
  const auto reaches = [&](const Pose& pose, const glm::dvec3& target) {
    const glm::dvec3 shoulder = frames.joints(pose)[index(arm->shoulder)].translation;
    return glm::distance(shoulder, target) <= arm->length_m;
  };
  ReachedError result;
  for (std::size_t step = 0; step < body.poses.size(); ++step) {
    if (!span.contains(body.times_s[step])) continue;
    const glm::dvec3& target = targets_in_world[step];
    if (arm && !reaches(body.poses[step], target) &&
        (body.references.empty() || !reaches(body.references[step], target))) {
      ++result.beyond;
      continue;
    }
    const glm::dvec3 place = point.in_world(frames.joints(body.poses[step]));
    result.error_mm.add(kMetreInMm * glm::distance(place, target), body.times_s[step]);
  }
  return result;
}

WorstValue clearance_mm(const FigureBody& body,
                        const FigurePoint& point,
                        std::span<const glm::dvec3> targets_in_world,
                        const FigureSpan& span) {
  FigureFrames frames(body);
  WorstValue smallest;
  for (std::size_t step = 0; step < body.poses.size(); ++step) {
    if (!span.contains(body.times_s[step])) continue;
    const glm::dvec3 place = point.in_world(frames.joints(body.poses[step]));
    const double distance_m = glm::distance(place, targets_in_world[step]);
    smallest.add_smallest(kMetreInMm * distance_m, body.times_s[step]);
  }
  return smallest;
}

double distance_at_mm(const FigureBody& body,
                      const FigurePoint& point,
                      std::span<const glm::dvec3> targets_in_world,
                      double time_s) {
  const std::vector<glm::dvec3> path = point_path(body, point);
  const glm::dvec3 place = place_at(body.times_s, path, time_s);
  const glm::dvec3 target = place_at(body.times_s, targets_in_world, time_s);
  return kMetreInMm * glm::distance(place, target);
}

}  // namespace marey::app
