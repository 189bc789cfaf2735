// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/estimate_stature.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"

namespace marey::reconstruct {
namespace {

// Shares of stature. A landmark this near a joint hardly moves relative to the bone
// beyond it. Distances of closer pairs depend more on the placement of the markers.
constexpr double kNearJoint = 0.045;
constexpr double kLongEnough = 0.10;
// Standard deviation of the length of a part among people of one stature.
constexpr double kBuildSigma = 0.045;
constexpr std::size_t kMaxFrames = 200;

struct Point {
  const Landmark* landmark = nullptr;
  glm::dvec3 p_in_t_pose{0.0};  ///< In shares of stature.
};

/// Returns true if the distance between two landmarks is the same as in the T-pose.
bool steady(const Point& a,
            const Point& b,
            const std::array<glm::dvec3, kHumanBoneCount>& origins) {
  const HumanBone bone_a = a.landmark->segment;
  const HumanBone bone_b = b.landmark->segment;
  if (bone_a == bone_b) return true;
  const auto near = [&](const Point& point, HumanBone joint) {
    return glm::length(point.p_in_t_pose - origins[index(joint)]) < kNearJoint;
  };
  if (parent(bone_a) == bone_b) return near(a, bone_a) || near(b, bone_a);
  if (parent(bone_b) == bone_a) return near(a, bone_b) || near(b, bone_b);
  return false;
}

/// Returns the median distance of two markers over frames that show both. [m]
std::optional<double> median_distance(std::span<const MarkerTracks> trials,
                                      const std::string& a,
                                      const std::string& b) {
  std::vector<double> distances;
  for (const MarkerTracks& tracks : trials) {
    const auto find = [&](const std::string& label) {
      return std::find(tracks.labels.begin(), tracks.labels.end(), label);
    };
    const auto at_a = find(a);
    const auto at_b = find(b);
    if (at_a == tracks.labels.end() || at_b == tracks.labels.end()) continue;
    const auto column_a = static_cast<std::size_t>(at_a - tracks.labels.begin());
    const auto column_b = static_cast<std::size_t>(at_b - tracks.labels.begin());
    const std::size_t step = 1 + tracks.frames() / kMaxFrames;
    for (std::size_t f = 0; f < tracks.frames(); f += step) {
      const auto& sample_a = tracks.at(f, column_a);
      const auto& sample_b = tracks.at(f, column_b);
      if (!sample_a || !sample_b) continue;
      distances.push_back(glm::length(sample_a->p_in_world - sample_b->p_in_world));
    }
  }
  if (distances.empty()) return std::nullopt;
  return median(std::move(distances));
}

}  // namespace

std::optional<StatureEstimate> estimate_stature(std::span<const MarkerTracks> trials,
                                                std::span<const NamedMarker> labels) {
  const Skeleton average = make_humanoid(average_proportions(1.0));
  const auto world = world_from_joints(average, rest_pose(average));
  std::array<glm::dvec3, kHumanBoneCount> origins{};
  for (const HumanBone bone : human_bones())
    origins[index(bone)] = world[index(bone)].translation;
  std::vector<std::pair<double, double>> statures;  // Statures and their weights.
  double sum = 0.0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Landmark* a = labels[i].landmark;
      const Landmark* b = labels[j].landmark;
      if (!a || !b ||
          std::max(a->sigma_per_stature, b->sigma_per_stature) >= kSomewhereSigma) {
        continue;
      }
      const Point point_a{a, origins[index(a->segment)] + a->p_in_segment_per_stature};
      const Point point_b{b, origins[index(b->segment)] + b->p_in_segment_per_stature};
      const double apart = glm::length(point_a.p_in_t_pose - point_b.p_in_t_pose);
      if (apart < kLongEnough || !steady(point_a, point_b, origins)) continue;
      const auto distance = median_distance(trials, labels[i].label, labels[j].label);
      if (!distance) continue;
      // Two uncertain ends give a better ratio at a larger distance.
      const double sigma = std::hypot(
          std::hypot(a->sigma_per_stature, b->sigma_per_stature) / apart, kBuildSigma);
      statures.emplace_back(*distance / apart, 1.0 / (sigma * sigma));
      sum += statures.back().second;
    }
  }
  if (statures.empty()) return std::nullopt;
  std::sort(statures.begin(), statures.end());
  double passed = 0.0;
  for (const auto& [stature_m, weight] : statures) {
    passed += weight;
    if (passed >= 0.5 * sum)
      return StatureEstimate{stature_m, static_cast<int>(statures.size())};
  }
  return StatureEstimate{statures.back().first, static_cast<int>(statures.size())};
}

}  // namespace marey::reconstruct
