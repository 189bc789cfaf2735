// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::app {

struct RetargetAtRateOptions {
  retarget::RetargetOptions retarget;
  /// Posture by posture, without knowing what comes: as it would be live.
  bool live = false;
  /// Frames per second of the result; without it the source's.
  std::optional<double> rate_hz;
};

/// retarget_motion(), or LiveRetarget, at another rate.
///
/// At another rate the source is resampled first, to the smallest whole multiple of that
/// rate that is no less than its own, and of what comes of it the frames in question are
/// kept: so feet stand in every frame, and instants that both rates share are the same.
/// Contacts, touches and the figures `after` are of the frames that are kept, the rest of
/// the report is of all that were solved. Same input, same bytes. Linear in frames.
///
/// Errors (kBadInput): retarget_motion()'s; no instant of the rate lies in the motion.
/// Precondition: retarget_motion()'s; rate_hz > 0; not `live` with what needs the whole
/// motion: balance, a way or heights that are kept.
[[nodiscard]] Result<retarget::RetargetedMotion> retarget_at_rate(
    const Motion& source,
    const Skeleton& avatar,
    const RetargetAtRateOptions& options = {});

}  // namespace marey::app
