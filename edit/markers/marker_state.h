// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "edit/state/lineage.h"
#include "edit/state/op_report.h"
#include "edit/state/timeline.h"

#include "core/base/frame_range.h"
#include "core/base/result.h"
#include "core/edit/annotation.h"
#include "core/edit/edit_ops.h"
#include "core/marker_tracks.h"

namespace marey::edit {

/// Labelled markers with everything that belongs to them, between two operations. Times
/// of annotations are since the first frame. [s]
struct MarkerState {
  MarkerTracks tracks;
  Annotations annotations;
  Lineage lineage;
  /// An operation moved or mirrored all markers: the source's force plates and other
  /// points do not belong to these places.
  bool is_moved = false;

  [[nodiscard]] int frame_count() const { return static_cast<int>(tracks.frames()); }
  /// Time of the last frame. [s]
  [[nodiscard]] double duration_s() const {
    return frame_count() < 2 ? 0.0 : (frame_count() - 1) / tracks.rate.hz;
  }
};

/// Makes the state of a source. Linear in samples.
/// Errors (bad input, place is "markers" or "frame N"): no markers or no frames; a rate
/// that is not positive; a place that is not finite.
[[nodiscard]] Result<MarkerState> make_marker_state(MarkerTracks tracks,
                                                    Annotations annotations = {});

/// Returns the timeline of markers. Valid as long as the state's annotations.
[[nodiscard]] Timeline timeline_of(const MarkerState& state);

/// Returns the runs of consecutive frames in which a marker was seen, ascending. Linear
/// in frames. Precondition: the marker exists.
[[nodiscard]] std::vector<FrameRange> seen_runs(const MarkerTracks& tracks,
                                                std::size_t marker);

/// Returns labels as text for a finding: all of up to five, else three and the number of
/// the others.
[[nodiscard]] std::string label_list(const std::vector<std::string>& labels);

/// One operation, as the functions of this folder receive it.
struct MarkerOpContext {
  const EditOp& op;
  int index = 0;  ///< In EditRecipe::ops.
};

}  // namespace marey::edit
