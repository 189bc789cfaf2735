// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/marker_tracks.h"

namespace marey::testing {

/// Markers on a trunk and two limbs of two parts each, five to a part, that move about
/// smoothly: "M0" to "M4" on the trunk, the next ten on one limb. 100 frames a second,
/// exact but for `noise_m` per coordinate. Frames and markers differ with the seed of
/// the noise alone.
[[nodiscard]] MarkerTracks synthetic_markers(std::size_t frames, double noise_m = 0.0);

constexpr std::size_t kMarkersOfPart = 5;
constexpr std::size_t kSyntheticParts = 5;

}  // namespace marey::testing
