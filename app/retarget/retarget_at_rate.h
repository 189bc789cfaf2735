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
  /// Retargets frame by frame without future frames, as in a live session.
  bool live = false;
  /// Frame rate of the result; nullopt: the source's.
  std::optional<double> rate_hz;
};

/// Retargets a motion at a given output rate, with retarget_motion() or LiveRetarget.
///
/// For another rate the source is first resampled to the smallest whole multiple of that
/// rate that is at least the source's rate. The frames at the output rate are then kept.
/// Feet therefore stand still in every frame, and frames at instants shared by both rates
/// are equal. Contacts, touches and the figures `after` refer to the kept frames, the
/// rest of the report to all solved frames. Same input, same bytes. Linear in frames.
///
/// Errors (kBadInput): retarget_motion()'s; no instant of the rate lies in the motion.
/// Precondition: retarget_motion()'s; rate_hz > 0; `live` is not combined with options
/// that need the whole motion (balance, a kept path, kept heights).
[[nodiscard]] Result<retarget::RetargetedMotion> retarget_at_rate(
    const Motion& source,
    const Skeleton& avatar,
    const RetargetAtRateOptions& options = {});

}  // namespace marey::app
