// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "library/quality/found_figure.h"
#include "library/quality/quality_frames.h"
#include "library/quality/quality_limits.h"

namespace marey::library {

/// Measures faults of single rotations: "frozen_s" and "flip_count".
///
/// - frozen_s: longest run in which the rotation of a joint in its parent changes by less
///   than 1e-6 rad per frame, while at least three other joints turn by more than
///   1 deg/s. Joints that rest in more than half of the motion are not animated, and are
///   left out; and so are toes, which many solvers keep flat. [s]
/// - flip_count: turns of a joint in its parent of more than 1500 deg/s and 40 degrees in
///   one frame, which a second such turn within 0.2 s (at least five frames) takes back
///   to within 40 % of the angle.
///
/// Linear in frames times joints.
[[nodiscard]] std::array<FoundFigure, 2> find_rotation_faults(
    const QualityFrames& frames, const Motion& motion, const QualityLimits& limits);

}  // namespace marey::library
