// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/time.h"
#include "retarget/arm_shift.h"
#include "retarget/body_map.h"
#include "retarget/body_volume.h"
#include "retarget/find_touches.h"
#include "retarget/posed_frames.h"
#include "retarget/touch_constraints.h"

namespace marey::retarget {

/// One body through a motion. What it refers to outlives it.
struct VolumeInMotion {
  const PosedFrames& frames;
  const BodyMap& map;
  const BodyVolume& volume;
};

struct KeepTouchesOptions {
  double fade_s = 0.3;       ///< As in TouchConstraintsOptions.
  double low_pass_s = 0.15;  ///< Of what is added to the hand's own way.
  StillPlace still = StillPlace::kScaled;
};

/// How far hands are not free to go elsewhere, 0 to 1, per frame.
struct HandHolds {
  std::array<std::vector<double>, 2> hand;  ///< Left, right: on the body, or still.
  std::vector<double> hands;                ///< One on the other: they move together.
};

/// Moves the hands of an avatar to where the source's hands are on its body: the same
/// places of the same parts, frame by frame, at the same distance of the surfaces, so
/// that a hand that strokes strokes, and a source's own body changes by less than 1e-9 m.
/// What a hand is moved by goes on, in the axes of what it touches, before and after, and
/// fades there with continuous speed and acceleration; the arm follows
/// (retarget/arm_shift.h), nothing else does. A hand that would lie in another part of
/// trunk or thighs, by more than `slack_m`, slides on what it touches until it does not.
/// A hand with several
/// touches keeps the nearest one's place, and the distances of all as far as one place
/// has them; hands that touch meet half way, or where one of them is held. Displacement
/// maps: solve, low-pass the difference, add, repeat. Adds to `shifts`. Linear in the
/// frames of touches; some ten microseconds each. Precondition: source and avatar have
/// the same frames, `arms` are the avatar's, `shifts` has one per frame.
[[nodiscard]] HandHolds keep_touches(const Touches& touches,
                                     const VolumeInMotion& source,
                                     const VolumeInMotion& avatar,
                                     const Arms& arms,
                                     FrameRate rate,
                                     const WorldScale& world,
                                     const KeepTouchesOptions& options,
                                     double slack_m,
                                     ArmShifts& shifts);

/// Between the surfaces of a hand and what it touches, on a shifted avatar in frame `t`.
/// [m] Precondition: the body has both parts.
[[nodiscard]] double touch_gap_m(const Touch& touch,
                                 const VolumeInMotion& body,
                                 const Arms& arms,
                                 const ArmShifts& shifts,
                                 std::size_t t);

}  // namespace marey::retarget
