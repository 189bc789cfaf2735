// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/base/time.h"
#include "retarget/body/arm_shift.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_volume.h"
#include "retarget/body/posed_frames.h"
#include "retarget/hands/find_touches.h"
#include "retarget/hands/touch_constraints.h"

namespace marey::retarget {

/// One body through a motion. Referenced objects must outlive it.
struct VolumeInMotion {
  const PosedFrames& frames;
  const BodyMap& map;
  const BodyVolume& volume;
};

struct KeepTouchesOptions {
  double fade_s = 0.3;       ///< As in TouchConstraintsOptions.
  double low_pass_s = 0.15;  ///< For the displacement added to the hand's own path.
  StillPlace still = StillPlace::kScaled;
};

/// Share of each hand that is held, 0 (free) to 1, per frame.
struct HandHolds {
  std::array<std::vector<double>, 2> hand;  ///< Left, right: on the body, or still in the
                                            ///< world.
  std::vector<double> hands;                ///< One on the other: they move together.
};

/// Moves the hands of an avatar to the positions of the source's hands on its body: the
/// same positions on the same parts, frame by frame, at the same distance of the
/// surfaces. Stroking motions are kept, and a source's own body changes by less than 1e-9
/// m. The displacement of a hand continues before and after the touch, in the axes of the
/// touched part, and fades with continuous speed and acceleration. Only the arm follows
/// (retarget/body/arm_shift.h). A hand that would penetrate another part of trunk or
/// thighs by more than `slack_m` slides on the touched part until it does not. A hand
/// with several touches keeps the position of the nearest, and the distances of all as
/// far as one position allows. Hands that touch each other meet half way, or where one of
/// them is held. Uses displacement maps: solve, low-pass the difference, add, repeat.
/// Adds to `shifts`. Linear in the frames of touches; some ten microseconds per frame.
/// Precondition: source and avatar have the same frames, `arms` are the avatar's,
/// `shifts` has one element per frame.
[[nodiscard]] HandHolds keep_touches(const Touches& touches,
                                     const VolumeInMotion& source,
                                     const VolumeInMotion& avatar,
                                     const Arms& arms,
                                     FrameRate rate,
                                     const WorldScale& world,
                                     const KeepTouchesOptions& options,
                                     double slack_m,
                                     ArmShifts& shifts);

/// Returns the distance between the surfaces of a hand and the part it touches, on a
/// shifted avatar in frame `t`. [m] Precondition: the body has both parts.
[[nodiscard]] double touch_gap_m(const Touch& touch,
                                 const VolumeInMotion& body,
                                 const Arms& arms,
                                 const ArmShifts& shifts,
                                 std::size_t t);

}  // namespace marey::retarget
