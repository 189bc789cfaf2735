// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/markers/marker_state.h"

namespace marey::edit {

/// Removes noise from markers: the three coordinates of each marker get one filter
/// (filter/channel_filter.h), along the vertical and the principal horizontal axes of its
/// path, so that placing the markers before or after gives the same result to rounding.
/// A gap stays a gap: each piece between gaps is filtered apart. The filter is chosen on
/// pieces of at least 20 frames, and applied to those of at least 5 (7 for a quintic
/// spline). Samples that were not measured (filled, or invented) count a tenth in the
/// splines. The span limits the effect; the filter is chosen on all frames.
/// `keep_contacts` has no effect: markers have no contacts. Samples that move by more
/// than 10 mm become inferred. Linear in samples.
///
/// Figures per marker: LABEL_cutoff_hz (half power), LABEL_noise_mm (standard deviation
/// per coordinate, from the removed part), LABEL_removed_rms_mm,
/// LABEL_removed_max_mm and LABEL_removed_max_s; for all of them displaced_mm (largest
/// displacement), filtered_markers, left_samples. Findings: markers and pieces that are
/// left as they are; a displacement above 30 mm. Errors (bad input): check_filter()'s;
/// resolve_span()'s; groups.
[[nodiscard]] Result<MarkerState> filter_markers(const FilterOp& op,
                                                 const MarkerOpContext& context,
                                                 const MarkerState& state,
                                                 OpReport& report);

}  // namespace marey::edit
