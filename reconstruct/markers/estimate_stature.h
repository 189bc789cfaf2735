// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/marker_tracks.h"
#include "reconstruct/markers/markers_fit.h"

namespace marey::reconstruct {

/// Estimates the stature of an average person with these distances between landmarks: the
/// weighted median over pairs on one segment and over pairs that are separated by a joint
/// next to one of them. nullopt without such pairs. [m]
struct StatureEstimate {
  double stature_m = 0.0;
  int pairs = 0;
};
[[nodiscard]] std::optional<StatureEstimate> estimate_stature(
    std::span<const MarkerTracks> trials, std::span<const NamedMarker> labels);

}  // namespace marey::reconstruct
