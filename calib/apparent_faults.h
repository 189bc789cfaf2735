// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: what a recording may have got wrong that the refinement does not
// solve for, tested as second hypotheses.

#include <optional>

#include "calib/calibrated_rig.h"
#include "calib/refine_rig.h"
#include "calib/rig_model.h"

namespace marey::calib {

/// Line delays, clocks free beside them. nullopt where they were solved for, or where
/// the normal equations cannot be solved.
[[nodiscard]] std::optional<ApparentLineDelays> apparent_line_delays(
    const RigModel& model, const RefineOptions& refine, double rate_hz);

/// Where a move may begin.
enum class MoveStart {
  kWithin,    ///< The cameras were found from the same recording.
  kAnywhere,  ///< They were known before: it may hold for all of the recording.
};

/// Of all cameras and frames, the move that explains most: one rotation and translation
/// of one camera from one frame on, or between the waving and the floor. To first order;
/// good to a tenth up to some ten pixels. `from_frame` is nullopt, too, where it holds
/// for the whole recording: with kAnywhere always unless a start within it gains more
/// than chance does. Returns nullopt without evidence.
[[nodiscard]] std::optional<ApparentMove> apparent_move(
    const RigModel& model,
    const RefineOptions& refine,
    double rate_hz,
    MoveStart start = MoveStart::kWithin);

}  // namespace marey::calib
