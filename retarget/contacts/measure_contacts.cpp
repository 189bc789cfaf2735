// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/measure_contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/pose.h"

namespace marey::retarget {
namespace {

double horizontal_m(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::length(glm::dvec2(a.x - b.x, a.z - b.z));
}

}  // namespace

ContactPaths contact_paths(const Motion& motion, const BodyMap& map) {
  ContactPaths out;
  for (const Pose& pose : motion.poses) {
    const auto world_from_joint = world_from_joints(motion.skeleton, pose);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto joint = map.joint_of[index(kContactBones[i])];
      if (joint) out[i].push_back(world_from_joint[index(*joint)].translation);
    }
  }
  return out;
}

ContactLabels label_contacts(const ContactPaths& source, double hz) {
  constexpr double kSlow_m_per_s = 0.2;
  constexpr double kLow_m = 0.05;
  constexpr double kMinQuantile = 0.02;
  ContactLabels labels;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const auto& path = source[i];
    if (path.size() < 2) continue;
    std::vector<double> heights;
    for (const glm::dvec3& p : path) heights.push_back(p.y);
    std::sort(heights.begin(), heights.end());
    const double low_m = heights[static_cast<std::size_t>(
                             kMinQuantile * static_cast<double>(path.size()))] +
                         kLow_m;
    for (std::size_t t = 0; t + 1 < path.size(); ++t) {
      const double speed_m_per_s = glm::length(path[t + 1] - path[t]) * hz;
      labels[i].push_back(speed_m_per_s < kSlow_m_per_s && path[t].y < low_m ? 1 : 0);
    }
    labels[i].push_back(0);
  }
  return labels;
}

namespace {

// Computes slide and drift of points during contact, and their maximum depth at any time.
void measure_points(const ContactPaths& paths,
                    const ContactLabels& labels,
                    const std::array<double, kContactPoints>& rest_heights_m,
                    double hz,
                    ContactFigures& out) {
  double slide_m = 0.0;
  int frames = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    std::optional<std::size_t> began;
    for (std::size_t t = 0; t < paths[i].size(); ++t) {
      out.sinking_mm =
          std::max(out.sinking_mm, 1e3 * (rest_heights_m[i] - paths[i][t].y));
      if (labels[i].empty() || labels[i][t] == 0) {
        began.reset();
        continue;
      }
      slide_m += horizontal_m(paths[i][t + 1], paths[i][t]);
      ++frames;
      const int frame = static_cast<int>(t);
      if (!began) {
        began = t;
        out.drifts.push_back({static_cast<int>(i), {frame, frame}, 0.0});
      }
      ContactDrift& drift = out.drifts.back();
      drift.frames.last = frame;
      drift.drift_mm =
          std::max(drift.drift_mm, 1e3 * horizontal_m(paths[i][t], paths[i][*began]));
    }
  }
  if (frames > 0) out.mean_slide_cm_per_s = 100.0 * slide_m * hz / frames;
}

}  // namespace

ContactFigures measure_contacts(const ContactPaths& paths,
                                const ContactLabels& labels,
                                const std::array<double, kContactPoints>& rest_heights_m,
                                double hz) {
  ContactFigures out;
  measure_points(paths, labels, rest_heights_m, hz, out);
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t t = 0; t < paths[side].size(); ++t) {
      double lowest_mm = 1e9;
      bool is_labelled = false;
      for (const std::size_t i : {side, side + 2}) {
        if (paths[i].empty() || labels[i].empty()) continue;
        lowest_mm = std::min(lowest_mm, 1e3 * (paths[i][t].y - rest_heights_m[i]));
        is_labelled = is_labelled || labels[i][t] != 0;
      }
      if (!is_labelled) continue;
      out.float_mm = std::max(out.float_mm, lowest_mm);
      constexpr double kFloats_mm = 5.0;
      if (lowest_mm > kFloats_mm) ++out.floating_frames;
    }
  }
  std::vector<double> drifts_mm;
  for (const ContactDrift& drift : out.drifts) drifts_mm.push_back(drift.drift_mm);
  if (!drifts_mm.empty()) {
    std::sort(drifts_mm.begin(), drifts_mm.end());
    out.worst_drift_mm = drifts_mm.back();
    out.median_drift_mm = drifts_mm[drifts_mm.size() / 2];
  }
  return out;
}

std::array<double, kContactPoints> rest_heights_m(const BodyMap& map) {
  return {map.feet[0].ankle_height_m,
          map.feet[1].ankle_height_m,
          map.feet[0].ball_height_m,
          map.feet[1].ball_height_m};
}

double head_height_m(const Skeleton& skeleton, const BodyMap& map) {
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  const JointIndex top = map.joint_of[index(HumanBone::kHead)].value_or(map.hips());
  return rest[index(top)].translation.y - rest[index(map.leg(0).end)].translation.y +
         map.feet[0].ankle_height_m;
}

double mean_jerk(const Motion& motion, std::span<const JointIndex> joints) {
  std::vector<std::vector<glm::dvec3>> places;
  for (const Pose& pose : motion.poses) {
    const auto world_from_joint = world_from_joints(motion.skeleton, pose);
    places.emplace_back();
    for (const JointIndex joint : joints) {
      places.back().push_back(world_from_joint[index(joint)].translation);
    }
  }
  const double hz3 = std::pow(motion.rate.hz, 3.0);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t t = 0; t + 3 < places.size(); ++t) {
    for (std::size_t j = 0; j < places[t].size(); ++j) {
      sum += hz3 * glm::length(places[t + 3][j] - 3.0 * places[t + 2][j] +
                               3.0 * places[t + 1][j] - places[t][j]);
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

double mean_jerk(const Motion& motion) {
  std::vector<JointIndex> all;
  for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
    all.push_back(static_cast<JointIndex>(j));
  }
  return mean_jerk(motion, all);
}

}  // namespace marey::retarget
