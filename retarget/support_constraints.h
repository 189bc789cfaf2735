// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/constraint.h"
#include "core/time.h"
#include "retarget/plan_supports.h"

namespace marey::retarget {

/// The stances of supports that were found, each as a constraint of its own, which a
/// person can read, move and delete: its footprint, how the foot is turned on it, when it
/// bears, and how it fades in before and out after. Named "leftFoot flat 1" and so on, in
/// the order of time for each foot and way of bearing.
///
/// Times are from the motion's first frame: files of motions begin at 0. A stance is
/// fully active in all its frames. Numbers have as many digits as a hand that edits them
/// wants: times tenths of a millisecond, places micrometres. It takes no longer to fade
/// than half the time to the same foot's stance before or after it, and where one takes
/// over from the other it is at once: both hold for a moment, so that stances that take
/// over from each other have the footprints of one posture, the foot's in the first frame
/// in which it is flat. A foot that turns on its heel may rise by some millimetres; its
/// footprint does not. A flat foot that turns by more than 0.15 rad while it stands (a
/// dancer's) may turn about its ball, or its ankle if that moves less: a constraint holds
/// still. On a floor that moves, footprints are where they are in that
/// frame, those of other stances where they are when these begin. Flat feet come first,
/// so that where both hold the foot is flat. Costs stances squared. Precondition: the
/// rate is positive; tracks have one motion's frames.
[[nodiscard]] ConstraintSet support_constraints(std::span<const SupportTrack> tracks,
                                                FrameRate rate);

}  // namespace marey::retarget
