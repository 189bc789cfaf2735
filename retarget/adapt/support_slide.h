// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/character.h"
#include "core/floor.h"
#include "core/motion.h"
#include "retarget/adapt/plan_supports.h"

namespace marey::retarget {

/// Slide of a support's point during contact.
struct SupportSlide {
  FloorStance stance;
  /// Maximum distance of the point from its position at the start of the stance, relative
  /// to the floor part that it stands on.
  double slide_m = 0.0;
};

/// Measures the slide in the contact intervals of a track on an adapted motion by forward
/// kinematics. Returns one element per element of `track.stands`. Linear in frames.
/// Precondition: the track belongs to that motion and was planned on that floor; the
/// character has the track's segment.
[[nodiscard]] std::vector<SupportSlide> slides_of(const SupportTrack& track,
                                                  const Motion& adapted,
                                                  const Character& character,
                                                  const Floor& floor);

}  // namespace marey::retarget
