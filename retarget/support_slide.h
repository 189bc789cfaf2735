// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/character.h"
#include "core/floor.h"
#include "core/motion.h"
#include "retarget/plan_supports.h"

namespace marey::retarget {

/// How far a support's point slides while it bears.
struct SupportSlide {
  FloorStance stance;
  /// The most that the point is away from where it was, against the part that it stands
  /// on, when the stance began.
  double slide_m = 0.0;
};

/// Measures the bearing runs of a track on an adapted motion, by forward kinematics. One
/// for each of `track.stands`. Linear in frames.
/// Precondition: the track is of that motion, planned on that floor; the character has
/// its segment.
[[nodiscard]] std::vector<SupportSlide> slides_of(const SupportTrack& track,
                                                  const Motion& adapted,
                                                  const Character& character,
                                                  const Floor& floor);

}  // namespace marey::retarget
