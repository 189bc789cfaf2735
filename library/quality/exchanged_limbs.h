// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "library/quality/found_figure.h"
#include "library/quality/quality_frames.h"
#include "library/quality/quality_limits.h"

namespace marey::library {

/// Measures exchanged left and right: "swap_frames" and "sides_share".
///
/// - swap_frames: number of frames in which the names of left and right of the legs or of
///   the arms are exchanged. An exchange is between two frames: if the joints of both
///   sides continue the paths of the other side, within half the distance to their own
///   ones, and these are 4 cm away or more in the mean. Paths are continued with the
///   velocity before; they are those in the world, and those relative to the limb's root,
///   since files exchange either positions or rotations. Frames between two exchanges
///   within 2 s are exchanged; after a single one, one frame.
/// - sides_share: share of frames in which the toes point backwards, with front = (left -
///   right) x up of the hips: the whole body has the names of the other side.
///
/// Linear in frames.
[[nodiscard]] std::array<FoundFigure, 2> find_exchanged_limbs(
    const QualityFrames& frames, const QualityLimits& limits);

}  // namespace marey::library
