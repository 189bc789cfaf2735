// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: tests for recording faults that the refinement does not solve for, as
// alternative hypotheses.

#include <optional>

#include "calib/bundle/refine_rig.h"
#include "calib/model/calibrated_rig.h"
#include "calib/model/rig_model.h"

namespace marey::calib {

/// Estimates line delays, with the clocks free. Returns nullopt if they were solved for,
/// or if the normal equations cannot be solved.
[[nodiscard]] std::optional<ApparentLineDelays> apparent_line_delays(
    const RigModel& model, const RefineOptions& refine, double rate_hz);

/// Frames at which a move may begin.
enum class MoveStart {
  kWithin,    ///< The cameras were calibrated from the same recording.
  kAnywhere,  ///< The cameras were known before; a move may hold for the whole recording.
};

/// Returns the move that reduces the cost most, over all cameras and frames: one rotation
/// and translation of one camera from one frame on, or between the waved and the floor
/// trial. First-order; accurate to a tenth for moves up to about ten pixels. `from_frame`
/// is nullopt if the move holds for the whole recording. With kAnywhere it is set only if
/// a start within the recording has a significant gain. Returns nullopt without evidence.
[[nodiscard]] std::optional<ApparentMove> apparent_move(
    const RigModel& model,
    const RefineOptions& refine,
    double rate_hz,
    MoveStart start = MoveStart::kWithin);

}  // namespace marey::calib
