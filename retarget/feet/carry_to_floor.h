// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/floor.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/adapt_to_ground.h"

namespace marey::retarget {

/// As in adapt_to_ground(), with a longer anticipation of the root: legs on two heights
/// are too short by more, and for longer.
struct CarryOptions {
  GroundOptions ground{.feet = {}, .anticipation_s = 0.4};
  /// The root's share of the floor's displacement of the feet is averaged over this time
  /// before and after: a pelvis takes a step less suddenly than a foot. [s]
  double root_blend_s = 0.1;
};

struct CarriedMotion {
  Motion motion;
  GroundReport ground;  ///< Legs that do not reach, as in adapt_to_ground().
};

/// Moves a motion from a level floor to an uneven or moving one (Kulpa 2005, 4.2.4.2 and
/// figure 4.18). The result is the reference for further adaptation.
///
/// The feet follow plan_feet(). The root moves by the mean of both feet's displacements,
/// including a swinging foot. So it anticipates: it begins to rise or to be carried as
/// soon as a foot leaves its footprint for one with another displacement
/// (CarryOptions::root_blend_s earlier still). A foot's lift over an edge does not move
/// the root. Then the root sinks, and the legs follow, as in settle_on_feet(). Trunk,
/// head and arms move with the root and are not turned.
///
/// A frame without displacement keeps its postures to the bit. Linear in frames.
/// Precondition: `map` was made from the motion's skeleton; `contacts` are of the motion,
/// which stands on the floor at world Y = `floor_height_m`; the heights of the floor are
/// relative to it.
[[nodiscard]] CarriedMotion carry_to_floor(const Motion& motion,
                                           const BodyMap& map,
                                           const Contacts& contacts,
                                           const Floor& floor,
                                           double floor_height_m = 0.0,
                                           const CarryOptions& options = {});

}  // namespace marey::retarget
