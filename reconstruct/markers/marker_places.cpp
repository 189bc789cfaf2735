// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/marker_places.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/quantile.h"
#include "reconstruct/clusters/sightings.h"
#include "reconstruct/markers/soft_tissue.h"

namespace marey::reconstruct {

using Eigen::Vector3d;

namespace {

/// Returns true if one bone is the other's parent.
bool are_neighbours(HumanBone a, HumanBone b) {
  const auto up_a = parent(a);
  const auto up_b = parent(b);
  return up_a == b || up_b == a;
}

}  // namespace

double measure_strays(std::span<const Snapshot> snapshots,
                      const ModelLabels& labels,
                      MarkerModel& model) {
  // Minimum stray of a marker, and weight of its prior in samples.
  constexpr double kMinStray_m = 0.002;
  constexpr double kUsualSamples = 10.0;
  double sum = 0.0;
  double count = 0.0;
  UnfoldedPosture unfolded;
  std::vector<std::vector<double>> squares(model.markers.size());
  for (const Snapshot& snapshot : snapshots) {
    if (!snapshot.solved) continue;
    unfolded.unfold(snapshot.posture, model.lengths, model.body);
    for (std::size_t m = 0; m < model.markers.size(); ++m) {
      const auto& p = snapshot.p_in_world[labels[m]];
      if (!p) continue;
      const ModelMarker& marker = model.markers[m];
      squares[m].push_back(
          (unfolded.point(marker.bone, marker.p_in_bone) - *p).squaredNorm());
      sum += squares[m].back();
      count += 1.0;
    }
  }
  for (std::size_t m = 0; m < model.markers.size(); ++m) {
    std::sort(squares[m].begin(), squares[m].end());
    const std::size_t maximum = squares[m].size() - squares[m].size() / 20;
    double own = 0.0;
    for (std::size_t i = 0; i < maximum; ++i) own += squares[m][i];
    const double samples = static_cast<double>(maximum);
    const double usual = 3.0 * kUsualStray_m * kUsualStray_m;
    const double variance =
        (own + kUsualSamples * usual) / (3.0 * (samples + kUsualSamples));
    model.markers[m].sigma_m = std::max(kMinStray_m, std::sqrt(variance));
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

std::optional<MarkerPlace> place_on(std::span<const Snapshot> snapshots,
                                    const MarkerModel& model,
                                    std::size_t label,
                                    HumanBone bone) {
  constexpr std::size_t kMinSightings = 3;
  std::vector<Vector3d> places;
  UnfoldedPosture unfolded;
  for (const Snapshot& snapshot : snapshots) {
    if (!snapshot.solved || !snapshot.p_in_world[label]) continue;
    unfolded.unfold(snapshot.posture, model.lengths, model.body);
    places.push_back(unfolded.rotation(bone).transpose() *
                     (*snapshot.p_in_world[label] - unfolded.origin(bone)));
  }
  if (places.size() < kMinSightings) return std::nullopt;
  MarkerPlace place;
  place.bone = bone;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vector3d& p : places) values.push_back(p[axis]);
    place.p_in_bone[axis] = median(std::move(values));
  }
  std::vector<double> squares;
  for (const Vector3d& p : places) squares.push_back((p - place.p_in_bone).squaredNorm());
  std::sort(squares.begin(), squares.end());
  const std::size_t count = std::max<std::size_t>(1, squares.size() * 9 / 10);
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += squares[i];
  place.stray_m = std::sqrt(sum / (3.0 * static_cast<double>(count)));
  return place;
}

std::optional<MarkerPlace> best_segment(std::span<const Snapshot> snapshots,
                                        const MarkerModel& model,
                                        std::size_t label,
                                        const SegmentRules& rules) {
  // The tested marker needs at least so many others on its segment.
  constexpr int kNamedMarkers = 2;
  // Strays that differ by less do not distinguish segments.
  constexpr double kAlike = 1.5;
  constexpr double kAlike_m = 0.003;
  constexpr double kOutside_m = 0.02;
  std::vector<MarkerPlace> places;
  for (const HumanBone bone : human_bones()) {
    if (solved_segment(bone) != bone) continue;
    if (rules.named_markers[index(bone)] < kNamedMarkers) continue;
    const auto place = place_on(snapshots, model, label, bone);
    if (!place) continue;
    const Vector3d& p = place->p_in_bone;
    const double outside_m = outside_soft_tissue_m(
        bone, {p.x(), p.y(), p.z()}, rules.proportions, rules.stature_m);
    if (outside_m < kOutside_m) places.push_back(*place);
  }
  if (places.empty()) return std::nullopt;
  const auto less = [](const MarkerPlace& a, const MarkerPlace& b) {
    return a.stray_m < b.stray_m;
  };
  const MarkerPlace best = *std::min_element(places.begin(), places.end(), less);
  for (const MarkerPlace& other : places) {
    const bool alike = other.stray_m < kAlike * best.stray_m + kAlike_m;
    if (alike && other.bone != best.bone && !are_neighbours(other.bone, best.bone)) {
      return std::nullopt;
    }
  }
  return best;
}

}  // namespace marey::reconstruct
