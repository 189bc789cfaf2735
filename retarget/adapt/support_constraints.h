// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/time.h"
#include "core/constraint.h"
#include "retarget/adapt/plan_supports.h"

namespace marey::retarget {

/// Converts the stances of supports to constraints, one per stance, so that a user can
/// read, move and delete each. A constraint has the stance's footprint, the rotation of
/// the foot on it, its interval, and its fade-in and fade-out. Names are "leftFoot flat
/// 1" and so on, numbered by time for each foot and contact type.
///
/// Times start at the motion's first frame, because motion files begin at 0. A stance is
/// fully active in all its frames. Numbers are rounded for manual editing: times to 0.1
/// ms, positions to 1 um. A fade takes at most half the time to the same foot's previous
/// or next stance. At a direct transition between two stances it has no duration: both
/// constraints hold for a moment, so their footprints are taken from one posture, that of
/// the first frame in which the foot is flat. A foot that rotates on its heel may rise by
/// some millimetres; its footprint does not. A flat foot that rotates by more than 0.15
/// rad during its stance (a dancer's) may rotate about its ball, or about its ankle if
/// that moves less, because a constraint is static. On a moving floor footprints are
/// those of that frame; those of other stances are taken at the start of the stance. Flat
/// contacts come first, so the foot is flat where two contacts hold. Costs stances
/// squared. Precondition: the rate is positive; the tracks have the frames of one motion.
[[nodiscard]] ConstraintSet support_constraints(std::span<const SupportTrack> tracks,
                                                FrameRate rate);

}  // namespace marey::retarget
