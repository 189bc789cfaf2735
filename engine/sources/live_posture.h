// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/blend/posture_groups.h"
#include "engine/clips/sample_clip.h"

#include "core/base/result.h"
#include "core/engine/blend_posture.h"

namespace marey::engine {

/// A posture of a performer, measured at one instant.
struct LivePosture {
  double time_s = 0.0;  ///< Instant of the measurement, on the engine's clock.
  BlendPosture posture;
  /// Place of the performer's hips in his own world; lengths of his leg instead of
  /// metres. Only its changes are used.
  RootPlace root_legs;
  /// Standard deviation of the joints of each group. [m]
  PerGroup sigma_m{};
  unsigned bears = 0;  ///< Parts of the feet that bear: bits by ClipFootPart.
};

/// Checks a posture alone. Errors (bad input): a number that is not finite; a rotation
/// that is not of unit length to 0.001; a fold outside of [0, pi/2]; a negative sigma;
/// bits that no part of a foot has.
[[nodiscard]] Status check_live_posture(const LivePosture& posture);

}  // namespace marey::engine
