// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: estimates an unseen marker's place from the other markers.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/marker_tracks.h"
#include "reconstruct/tracks/marker_distances.h"
#include "reconstruct/tracks/repair_method.h"

namespace marey::reconstruct {

/// Frames from `first` up to, but excluding, `end`.
struct FrameSpan {
  std::size_t first = 0;
  std::size_t end = 0;
  [[nodiscard]] std::size_t size() const { return end - first; }
};

/// The measured and the currently estimated tracks of a trial.
struct GapContext {
  const MarkerTracks& tracks;        ///< Measured samples.
  const MarkerDistances& distances;  ///< Computed from `tracks`.
  /// Frame by frame as in `tracks`, every marker: measured or currently estimated.
  std::span<const glm::dvec3> p_in_world;
};

struct GapFill {
  std::vector<glm::dvec3> p_in_world;  ///< Per frame of the piece.
  std::vector<double> sigma_m;         ///< Per coordinate.
  std::vector<std::size_t> carried_by;
  RepairMethod method = RepairMethod::kCluster;
};

/// Computes the place of `marker` in the frames of `piece`, which lie in its gap `gap`,
/// by the processes described at repair_gaps(). nullopt if fewer than three companions
/// are seen in nine tenths of the piece, or if it was too rarely seen together with them.
/// Cost: that of two symmetric systems of some 170 equations.
[[nodiscard]] std::optional<GapFill> fill_gap(const GapContext& trial,
                                              std::size_t marker,
                                              const FrameSpan& gap,
                                              const FrameSpan& piece);

}  // namespace marey::reconstruct
