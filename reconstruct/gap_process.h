// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: where a marker is that is not seen, after the others.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/marker_tracks.h"
#include "reconstruct/marker_distances.h"
#include "reconstruct/repair_gaps.h"

namespace marey::reconstruct {

/// Frames from `first` up to, and not with, `end`.
struct FrameSpan {
  std::size_t first = 0;
  std::size_t end = 0;
  [[nodiscard]] std::size_t size() const { return end - first; }
};

/// A trial as it is known so far.
struct TrialSoFar {
  const MarkerTracks& tracks;        ///< What was measured.
  const MarkerDistances& distances;  ///< Of `tracks`.
  /// Frame by frame as in `tracks`, every marker: measured, or what is believed by now.
  std::span<const glm::dvec3> p_in_world;
};

struct GapFill {
  std::vector<glm::dvec3> p_in_world;  ///< Per frame of the piece.
  std::vector<double> sigma_m;         ///< Per coordinate.
  std::vector<std::size_t> carried_by;
  RepairMethod method = RepairMethod::kCluster;
};

/// Where `marker` is in the frames of `piece`, which lie in its gap `gap`, as the
/// processes described at repair_gaps() have it. nullopt when fewer than three companions
/// are there in nine tenths of the piece, or it was too rarely seen together with them.
/// Cost: that of two symmetric systems of some 170 equations.
[[nodiscard]] std::optional<GapFill> fill_gap(const TrialSoFar& trial,
                                              std::size_t marker,
                                              const FrameSpan& gap,
                                              const FrameSpan& piece);

}  // namespace marey::reconstruct
