// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "reconstruct/markers/solve_markers.h"

namespace marey::app {

/// Markers with gaps filled as far as possible.
struct CompletedMarkers {
  MarkerTracks tracks;
  std::size_t predicted = 0;  ///< Samples computed from the skeleton.
  std::size_t empty = 0;      ///< Samples that remain unknown.
};

/// Fills missing markers with their position on the solved body, source kInferred. The
/// variances of the joint, of the marker's place and of its stray motion are added. Only
/// markers of segments that are measured or repaired are filled. Markers of inferred
/// segments, and markers with a sigma above 0.1 m, stay empty. Existing samples are
/// unchanged.
///
/// Cost: linear in samples. Precondition: `solved` is of this body and these tracks.
[[nodiscard]] CompletedMarkers complete_markers(const Body& body,
                                                const reconstruct::SolvedMarkers& solved,
                                                MarkerTracks tracks);

}  // namespace marey::app
