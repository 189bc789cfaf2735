// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/frame_range.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::edit {

/// The period with which the feet of a motion repeat their heights.
struct FootPeriod {
  double period_s = 0.0;
  double correlation =
      0.0;  ///< Correlation of heights one period apart: 1 is exact repetition.
  double deviation_m = 0.0;  ///< Standard deviation of the heights where it was found.
};

/// Returns the heights of the left and the right ankle, every `stride`-th frame. [m]
[[nodiscard]] std::array<std::vector<double>, 2> ankle_heights(
    const Motion& motion,
    const retarget::BodyMap& map,
    const FrameRange& frames,
    int stride = 1);

/// Returns the time after which both ankles repeat their heights: the first high peak of
/// their autocorrelation, left with left and right with right, so that a walk has the
/// period of two steps. Motions of more than 8 s are searched in windows of 6 s; the
/// window with the highest peak decides. nullopt: the feet hardly move, or no peak is
/// above 0.6. A movement that is not repeated for half of its duration has no period.
/// Linear in frames; the heights are sampled at 60 Hz at most.
/// Precondition: `map` was made from the motion's skeleton; `frames` within the motion.
[[nodiscard]] std::optional<FootPeriod> foot_period(const Motion& motion,
                                                    const retarget::BodyMap& map,
                                                    const FrameRange& frames);

}  // namespace marey::edit
