// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "reconstruct/markers/solve_markers.h"

namespace marey::app {

/// Markers without gaps, as far as anything is known of them.
struct CompletedMarkers {
  MarkerTracks tracks;
  std::size_t predicted = 0;  ///< Samples that the skeleton told.
  std::size_t empty = 0;      ///< Samples that nobody knows.
};

/// Puts markers that are still missing where the solved body has them, source kInferred,
/// with the doubts of the joint, of the marker's place and of its straying added up. Only
/// where the marker's segment is measured or repaired: where a segment is itself a guess,
/// markers stay empty, and so do those known
/// no better than to 0.1 m. Those that are there stay as they are.
///
/// Cost: linear in samples. Precondition: `solved` is of this body and these tracks.
[[nodiscard]] CompletedMarkers complete_markers(const Body& body,
                                                const reconstruct::SolvedMarkers& solved,
                                                MarkerTracks tracks);

}  // namespace marey::app
