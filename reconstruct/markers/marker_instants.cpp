// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/marker_instants.h"

#include <algorithm>
#include <limits>

#include "reconstruct/markers/relocalize_from_markers.h"

namespace marey::reconstruct {
namespace {

// Frames with fewer markers than this share of the maximum are left out.
constexpr double kFullEnough = 0.7;
// Share of the worst fitting frames, which are left out: their postures can be wrong.
constexpr double kWorstShare = 0.1;

/// Returns the posture without its place and heading: the basis for differences.
PostureVector attitude(const Posture& posture) {
  PostureVector all = PostureVector::Zero();
  const glm::dquat hips = posture.rotation(PoseParameter::kHips);
  for (const PoseParameter parameter : kAllPoseParameters) {
    const int column = column_of(parameter);
    if (parameter == PoseParameter::kHipsPosition || parameter == PoseParameter::kHips)
      continue;
    if (is_rotation(parameter)) {
      const glm::dvec3 turn =
          rotation_vector(glm::conjugate(hips) * posture.rotation(parameter));
      for (int i = 0; i < 3; ++i) all[column + i] = turn[i];
    } else {
      all[column] = *posture.block(parameter);
    }
  }
  return all;
}

}  // namespace

std::vector<Snapshot> take_snapshots(std::span<const MarkerTracks> trials,
                                     std::span<const std::string> labels,
                                     std::size_t max_count) {
  std::size_t frames = 0;
  for (const MarkerTracks& tracks : trials) frames += tracks.frames();
  const std::size_t step = std::max<std::size_t>(1, (frames + max_count - 1) / max_count);
  std::vector<Snapshot> snapshots;
  for (std::size_t trial = 0; trial < trials.size(); ++trial) {
    const MarkerTracks& tracks = trials[trial];
    std::vector<std::optional<std::size_t>> columns;
    for (const std::string& label : labels) {
      const auto it = std::find(tracks.labels.begin(), tracks.labels.end(), label);
      columns.push_back(
          it == tracks.labels.end()
              ? std::nullopt
              : std::optional(static_cast<std::size_t>(it - tracks.labels.begin())));
    }
    // A trial shorter than the step contributes a frame as well.
    const std::size_t begin = std::min(step, tracks.frames()) / 2;
    for (std::size_t f = begin; f < tracks.frames(); f += step) {
      Snapshot snapshot;
      snapshot.trial = trial;
      for (const auto& column : columns) {
        snapshot.p_in_world.emplace_back();
        if (!column || !tracks.at(f, *column)) continue;
        const MarkerSample& sample = *tracks.at(f, *column);
        if (sample.source != Source::kMeasured) continue;
        const glm::dvec3& p = sample.p_in_world;
        snapshot.p_in_world.back() = Eigen::Vector3d(p.x, p.y, p.z);
      }
      snapshots.push_back(std::move(snapshot));
    }
  }
  return snapshots;
}

std::vector<SeenMarker> seen_in(const Snapshot& snapshot, const ModelLabels& labels) {
  std::vector<SeenMarker> seen;
  for (std::size_t m = 0; m < labels.size(); ++m) {
    if (const auto& p = snapshot.p_in_world[labels[m]]) seen.push_back({m, *p, 0.0});
  }
  return seen;
}

void pose_snapshots(const MarkerModel& model,
                    const ModelLabels& labels,
                    std::vector<Snapshot>& snapshots) {
  // Trials can have different markers: those inside of knees are taken off for walking.
  std::vector<std::size_t> maximum;
  for (const Snapshot& snapshot : snapshots) {
    maximum.resize(std::max(maximum.size(), snapshot.trial + 1));
    maximum[snapshot.trial] =
        std::max(maximum[snapshot.trial], seen_in(snapshot, labels).size());
  }
  MarkerPoseRelocalizer finder(model);
  const Snapshot* before = nullptr;
  for (Snapshot& snapshot : snapshots) {
    const std::vector<SeenMarker> seen = seen_in(snapshot, labels);
    const bool enough = seen.size() >= 6 &&
                        static_cast<double>(seen.size()) >=
                            kFullEnough * static_cast<double>(maximum[snapshot.trial]);
    if (!enough) {
      snapshot.solved = false;
      continue;
    }
    FoundPosture found = snapshot.solved ? finder.find_near(snapshot.posture, seen)
                         : before        ? finder.find_near(before->posture, seen)
                                         : finder.find(seen);
    snapshot.posture = found.posture;
    snapshot.misfit = found.cost / static_cast<double>(seen.size());
    snapshot.solved = true;
    before = &snapshot;
  }
}

std::vector<std::size_t> choose_instants(std::span<const Snapshot> snapshots,
                                         std::size_t max_count) {
  std::vector<std::size_t> by_misfit;
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    if (snapshots[i].solved) by_misfit.push_back(i);
  }
  std::stable_sort(by_misfit.begin(), by_misfit.end(), [&](std::size_t a, std::size_t b) {
    return snapshots[a].misfit < snapshots[b].misfit;
  });
  if (by_misfit.size() > max_count) {
    by_misfit.resize(std::max(
        max_count,
        by_misfit.size() - static_cast<std::size_t>(
                               kWorstShare * static_cast<double>(by_misfit.size()))));
  }
  if (by_misfit.size() <= max_count) return by_misfit;
  // Repeatedly adds the posture farthest from all chosen ones, starting from the best
  // fitting.
  std::vector<PostureVector> attitudes;
  for (const std::size_t i : by_misfit) {
    attitudes.push_back(attitude(snapshots[i].posture));
  }
  std::vector<double> distance(by_misfit.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen;
  std::size_t next = 0;
  while (chosen.size() < max_count) {
    chosen.push_back(by_misfit[next]);
    for (std::size_t i = 0; i < attitudes.size(); ++i) {
      distance[i] = std::min(distance[i], (attitudes[i] - attitudes[next]).squaredNorm());
    }
    next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) -
                                    distance.begin());
    if (distance[next] <= 0.0) break;  // The rest are duplicates.
  }
  return chosen;
}

}  // namespace marey::reconstruct
