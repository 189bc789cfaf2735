// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the instants of trials that a body is measured from.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/marker_tracks.h"
#include "reconstruct/markers/marker_bundle.h"

namespace marey::reconstruct {

/// A frame of one of the trials, every label of the fit; nullopt if it was not seen.
struct Snapshot {
  std::vector<std::optional<Eigen::Vector3d>> p_in_world;
  std::size_t trial = 0;
  Posture posture;
  double misfit = 0.0;  ///< Cost per marker that was seen.
  bool solved = false;
};

/// Returns some `max_count` frames spread evenly over the trials, at least one of every
/// trial.
[[nodiscard]] std::vector<Snapshot> take_snapshots(std::span<const MarkerTracks> trials,
                                                   std::span<const std::string> labels,
                                                   std::size_t max_count);

/// Label of each marker of the model.
using ModelLabels = std::vector<std::size_t>;

/// Returns the model's markers in a snapshot.
[[nodiscard]] std::vector<SeenMarker> seen_in(const Snapshot& snapshot,
                                              const ModelLabels& labels);

/// Finds every snapshot's posture, from its neighbour's or without a prior.
void pose_snapshots(const MarkerModel& model,
                    const ModelLabels& labels,
                    std::vector<Snapshot>& snapshots);

/// Chooses snapshots as different from each other as possible, without the worst fitting
/// ones.
[[nodiscard]] std::vector<std::size_t> choose_instants(
    std::span<const Snapshot> snapshots, std::size_t max_count);

}  // namespace marey::reconstruct
