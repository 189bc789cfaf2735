// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/hip_regression.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/quantile.h"

namespace marey::reconstruct {
namespace {

// Distance of a marker's centre from the bone, in the pelvis' depth. [m]
constexpr double kOffBone_m = 0.0075;
constexpr std::size_t kMaxRegressionFrames = 200;

/// Directions forward along the plane of the spines, and up from it, in the hips' frame,
/// from the landmarks: the anterior ones are lower by some 12 degrees.
struct PelvicPlane {
  glm::dvec3 forward;
  glm::dvec3 up;
};

PelvicPlane pelvic_plane() {
  const Landmark* front = find_landmark("left_asis");
  const Landmark* back = find_landmark("left_psis");
  MAREY_ASSERT(front && back);
  glm::dvec3 along = front->p_in_segment_per_stature - back->p_in_segment_per_stature;
  along.x = 0.0;
  const glm::dvec3 forward = glm::normalize(along);
  return {forward, {0.0, forward.z, -forward.y}};
}

using Column = std::optional<std::size_t>;

Column column_of_landmark(const MarkerTracks& tracks,
                          std::span<const NamedMarker> labels,
                          std::string_view landmark) {
  for (const NamedMarker& marker : labels) {
    if (!marker.landmark || marker.landmark->name != landmark) continue;
    const auto it = std::find(tracks.labels.begin(), tracks.labels.end(), marker.label);
    if (it != tracks.labels.end()) {
      return static_cast<std::size_t>(it - tracks.labels.begin());
    }
  }
  return std::nullopt;
}

}  // namespace

HipRegression hips_from_spines(double width_m, double depth_m) {
  MAREY_ASSERT(width_m > 0.0 && depth_m > 0.0);
  const PelvicPlane plane = pelvic_plane();
  const double bone_depth_m = std::max(0.5 * depth_m, depth_m - 2.0 * kOffBone_m);
  // Harrington's equations are in millimetres, from the middle of the anterior spines.
  const double behind_m = 0.24 * bone_depth_m + 0.0099;
  const double below_m = 0.30 * width_m + 0.0109;
  HipRegression hips;
  hips.half_hip_width_m = 0.33 * width_m + 0.0073;
  hips.anterior_in_hips = (behind_m + kOffBone_m) * plane.forward + below_m * plane.up;
  hips.posterior_in_hips = hips.anterior_in_hips - depth_m * plane.forward;
  hips.half_anterior_width_m = 0.5 * width_m;
  return hips;
}

std::optional<HipRegression> hips_from_markers(std::span<const MarkerTracks> trials,
                                               std::span<const NamedMarker> labels) {
  std::vector<double> widths;
  std::vector<double> depths;
  for (const MarkerTracks& tracks : trials) {
    const auto find = [&](std::string_view landmark) {
      return column_of_landmark(tracks, labels, landmark);
    };
    const Column left = find("left_asis");
    const Column right = find("right_asis");
    const Column left_back = find("left_psis");
    const Column right_back = find("right_psis");
    const Column sacrum = find("sacrum");
    if (!left || !right || !((left_back && right_back) || sacrum)) continue;
    const std::size_t step = 1 + tracks.frames() / kMaxRegressionFrames;
    for (std::size_t f = 0; f < tracks.frames(); f += step) {
      const auto at = [&](Column column) -> std::optional<glm::dvec3> {
        if (!column || !tracks.at(f, *column)) return std::nullopt;
        return tracks.at(f, *column)->p_in_world;
      };
      const auto a = at(left);
      const auto b = at(right);
      const auto c = left_back && right_back ? at(left_back) : at(sacrum);
      const auto d = left_back && right_back ? at(right_back) : at(sacrum);
      if (!a || !b || !c || !d) continue;
      widths.push_back(glm::length(*a - *b));
      depths.push_back(0.5 * glm::length(*a + *b - *c - *d));
    }
  }
  if (widths.empty()) return std::nullopt;
  const double width_m = median(std::move(widths));
  const double depth_m = median(std::move(depths));
  if (width_m <= 0.0 || depth_m <= 0.0) return std::nullopt;
  return hips_from_spines(width_m, depth_m);
}

}  // namespace marey::reconstruct
