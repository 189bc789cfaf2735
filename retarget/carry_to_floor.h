// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/floor.h"
#include "core/motion.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"
#include "retarget/ground.h"

namespace marey::retarget {

/// As adapt_to_ground() has it, but the root looks further ahead: legs on two heights are
/// too short by more, and for longer.
struct CarryOptions {
  GroundOptions ground{.feet = {}, .anticipation_s = 0.4};
  /// The root's share of what the floor does to the feet is averaged over this long before
  /// and after: a pelvis takes a step less suddenly than a foot. [s]
  double root_blend_s = 0.1;
};

struct CarriedMotion {
  Motion motion;
  GroundReport ground;  ///< Legs that do not reach, as in adapt_to_ground().
};

/// Takes a motion from a level floor to an uneven or moving one (Kulpa 2005, 4.2.4.2 and
/// figure 4.18), as the reference of what is adapted further.
///
/// The feet go where plan_feet() has them. The root goes by the mean of both feet's
/// displacements, of a swinging one too: so it anticipates, beginning to rise or to be
/// carried as soon as a foot leaves its footprint for one that is displaced otherwise
/// (CarryOptions::root_blend_s earlier still). A foot's lift over an edge does not move
/// it. Then it sinks, and legs follow, as in settle_on_feet(). What hangs on the root
/// (trunk, head, arms) goes along unturned.
///
/// Where nothing is displaced the motion is the same, to the bit. Linear in frames.
/// Precondition: `map` was made from the motion's skeleton; `contacts` are of the motion,
/// which stands on the floor at world Y = `floor_height_m`, from which the floor's
/// heights are.
[[nodiscard]] CarriedMotion carry_to_floor(const Motion& motion,
                                           const BodyMap& map,
                                           const Contacts& contacts,
                                           const Floor& floor,
                                           double floor_height_m = 0.0,
                                           const CarryOptions& options = {});

}  // namespace marey::retarget
