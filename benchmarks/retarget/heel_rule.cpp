// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/retarget/heel_rule.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/gtc/quaternion.hpp>

#include "core/base/quantile.h"
#include "core/pose.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey {

std::vector<std::optional<double>> marker_heights(const ContactTrial& trial, int side) {
  std::vector<std::optional<double>> out;
  for (const auto& p : trial.heel_markers[static_cast<std::size_t>(side)]) {
    out.push_back(p ? std::optional<double>(p->y) : std::nullopt);
  }
  return out;
}

std::vector<std::optional<double>> fitted_heights(const ContactTrial& trial, int side) {
  const auto& marker = trial.heel_markers[static_cast<std::size_t>(side)];
  if (marker.empty()) return {};
  const JointIndex ankle = trial.map.leg(side).end;
  std::vector<glm::dquat> turns;
  std::vector<glm::dvec3> ankles;
  std::array<std::vector<double>, 3> place;
  for (std::size_t t = 0; t < trial.motion.poses.size(); ++t) {
    const auto joints = world_from_joints(trial.motion.skeleton, trial.motion.poses[t]);
    turns.push_back(retarget::rotation_from_t_pose(trial.map, joints, ankle));
    ankles.push_back(joints[index(ankle)].translation);
    if (t >= marker.size() || !marker[t]) continue;
    const glm::dvec3 local = glm::conjugate(turns[t]) * (*marker[t] - ankles[t]);
    for (int i = 0; i < 3; ++i) place[static_cast<std::size_t>(i)].push_back(local[i]);
  }
  if (place[0].empty()) return {};
  const glm::dvec3 local(median(place[0]), median(place[1]), median(place[2]));
  std::vector<std::optional<double>> out;
  for (std::size_t t = 0; t < turns.size(); ++t) {
    out.emplace_back((ankles[t] + turns[t] * local).y);
  }
  return out;
}

std::optional<double> strike_by_heel(const std::vector<std::optional<double>>& height_m,
                                     double hz,
                                     double strike_s) {
  constexpr double kNear_m = 0.01;
  constexpr double kBefore_s = 0.12;
  constexpr double kAfter_s = 0.15;
  constexpr double kAhead_s = 0.2;
  const int count = static_cast<int>(height_m.size());
  const auto at = [&](int t) { return height_m[static_cast<std::size_t>(t)]; };
  const int first = std::max(1, static_cast<int>((strike_s - kBefore_s) * hz));
  const int last = std::min(count - 1, static_cast<int>((strike_s + kAfter_s) * hz));
  for (int t = first; t <= last; ++t) {
    if (!at(t)) continue;
    double lowest_m = *at(t);
    for (int k = t; k <= std::min(count - 1, t + static_cast<int>(kAhead_s * hz)); ++k) {
      if (at(k)) lowest_m = std::min(lowest_m, *at(k));
    }
    const double level_m = lowest_m + kNear_m;
    if (*at(t) > level_m) continue;
    if (!at(t - 1) || *at(t - 1) <= level_m) return t / hz;
    return (t - 1 + (level_m - *at(t - 1)) / (*at(t) - *at(t - 1))) / hz;
  }
  return std::nullopt;
}

}  // namespace marey
