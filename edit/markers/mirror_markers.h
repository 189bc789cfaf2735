// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "edit/markers/marker_state.h"

namespace marey::edit {

/// Returns the index of each label's counterpart on the other side; nullopt: it has none.
/// Counterparts differ by left and right as mirrored_name() recognises them ("R.Knee"),
/// or by an L and R at the start or the end of the label, after the subject's name
/// ("Ann:LASI", "kneeR"). Always symmetric.
[[nodiscard]] std::vector<std::optional<std::size_t>> marker_counterparts(
    std::span<const std::string> labels);

/// Mirrors all markers by the plane X = 0, and exchanges the labels of left and right.
/// Markers without a counterpart keep their label, with a note. Left and right are
/// exchanged in annotations, as apply_mirror() does. Twice gives the markers back to the
/// bit. Linear in samples.
/// Figures: pairs. Errors (bad input): fewer than half of the markers have a counterpart;
/// a span, groups or blend_s.
[[nodiscard]] Result<MarkerState> mirror_markers(const MirrorOp& op,
                                                 const MarkerOpContext& context,
                                                 const MarkerState& state,
                                                 OpReport& report);

}  // namespace marey::edit
