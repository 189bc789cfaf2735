// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the markers of a body among the columns of recorded tracks.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "core/source.h"
#include "reconstruct/markers/marker_model.h"

namespace marey::reconstruct {

/// Converts a body's lengths and markers to the solver's model; markers in the body's
/// order.
[[nodiscard]] MarkerModel to_marker_model(const Body& body);

/// Column in the tracks of each marker of a body; nullopt if absent.
using MarkerColumns = std::vector<std::optional<std::size_t>>;
[[nodiscard]] MarkerColumns find_columns(const Body& body,
                                         std::span<const std::string> labels);

/// Writes the model's markers in one frame to `out`. No allocation if its capacity
/// suffices.
void collect(std::span<const std::optional<MarkerSample>> frame,
             const MarkerColumns& columns,
             std::vector<SeenMarker>& out);

/// Source of every bone in a frame: measured if one of its own markers was.
using BoneSources = std::array<Source, kHumanBoneCount>;
[[nodiscard]] BoneSources sources_of(const MarkerModel& model,
                                     std::span<const std::optional<MarkerSample>> frame,
                                     const MarkerColumns& columns);

}  // namespace marey::reconstruct
