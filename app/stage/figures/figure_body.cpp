// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/figure_body.h"

#include <algorithm>

#include <glm/common.hpp>

#include "core/base/assert.h"
#include "retarget/constraints/resolve_segment.h"

namespace marey::app {

FigureFrames::FigureFrames(const FigureBody& body)
    : skeleton_(body.character->skeleton), joints_(skeleton_.joints.size()) {}

std::span<const RigidTransform> FigureFrames::joints(const Pose& pose) {
  world_from_joints(skeleton_, pose, joints_);
  return joints_;
}

std::optional<FigurePoint> find_point(const FigureBody& body, const BodyPoint& point) {
  const auto joint = retarget::resolve_segment(body.character->skeleton, point.segment);
  if (!joint) return std::nullopt;
  const glm::dquat t_pose = body.map->joints[index(*joint)].t_pose_from_joint;
  return FigurePoint{*joint, glm::conjugate(t_pose) * point.offset_in_t_pose};
}

std::vector<glm::dvec3> point_path(const FigureBody& body, const FigurePoint& point) {
  FigureFrames frames(body);
  std::vector<glm::dvec3> path;
  path.reserve(body.poses.size());
  for (const Pose& pose : body.poses) path.push_back(point.in_world(frames.joints(pose)));
  return path;
}

glm::dvec3 place_at(std::span<const double> times_s,
                    std::span<const glm::dvec3> places,
                    double time_s) {
  MAREY_ASSERT(!places.empty() && times_s.size() == places.size());
  const auto after = std::lower_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin()) return places.front();
  if (after == times_s.end()) return places.back();
  const auto i = static_cast<std::size_t>(after - times_s.begin());
  const double share = (time_s - times_s[i - 1]) / (times_s[i] - times_s[i - 1]);
  return glm::mix(places[i - 1], places[i], share);
}

}  // namespace marey::app
