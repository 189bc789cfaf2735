// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/marker_places.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/quantile.h"
#include "reconstruct/sightings.h"

namespace marey::reconstruct {

using Eigen::Vector3d;

std::optional<MarkerPlace> place_on(std::span<const Snapshot> snapshots,
                                    const MarkerModel& model,
                                    std::size_t label,
                                    HumanBone bone) {
  constexpr std::size_t kFewestSightings = 3;
  std::vector<Vector3d> places;
  UnfoldedPosture unfolded;
  for (const Snapshot& snapshot : snapshots) {
    if (!snapshot.solved || !snapshot.p_in_world[label]) continue;
    unfolded.unfold(snapshot.posture, model.lengths, model.body);
    places.push_back(unfolded.rotation(bone).transpose() *
                     (*snapshot.p_in_world[label] - unfolded.origin(bone)));
  }
  if (places.size() < kFewestSightings) return std::nullopt;
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
                                        std::size_t label) {
  std::optional<MarkerPlace> best;
  for (const HumanBone bone : human_bones()) {
    if (solved_segment(bone) != bone) continue;
    const auto place = place_on(snapshots, model, label, bone);
    if (place && (!best || place->stray_m < best->stray_m)) best = place;
  }
  return best;
}

}  // namespace marey::reconstruct
