// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"

namespace marey::edit {

/// Amplifies the movement between two frequencies by `gain` (Bruderlin & Williams 1995,
/// "Motion signal processing", section 3): the difference of two low-pass versions of the
/// motion, times gain - 1, is added to it. A gain of 1 changes nothing, 0 removes the
/// band, less than 0 reverses it.
///
/// The low-pass versions are Butterworth filters of the 4th order without phase
/// (edit/signal/butterworth.h), so the edges of the band are soft: an octave inside an
/// edge 94 % of a movement count, an octave outside 6 %. Rotations are filtered by
/// RotationChannels, independently of coordinates. With low_hz = 0 the lower version is
/// the mean of a joint's rotation, and the straight line through the root's place and
/// rotation, so that a walk keeps its path and its speed. With high_hz = 0 the upper
/// version is the motion itself.
///
/// Groups limit what is amplified; span and blend_s where (op_weights(), mix_motion()).
/// Standing feet keep their places if the root or a leg changes (hold_feet()). Figures:
/// displaced_mm, lowered_mm, feet_missed_mm. Linear in frames times joints.
///
/// Errors (bad input): a gain that is not from -10 to 10; frequencies below 0, not below
/// half the frame rate, or not ascending; fewer than 8 frames; those of op_weights().
[[nodiscard]] Result<EditState> apply_exaggerate(const ExaggerateOp& op,
                                                 const OpContext& context,
                                                 const EditState& state,
                                                 OpReport& report);

}  // namespace marey::edit
