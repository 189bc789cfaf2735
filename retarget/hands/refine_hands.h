// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_volume.h"
#include "retarget/hands/find_touches.h"
#include "retarget/hands/keep_touches.h"
#include "retarget/hands/resolve_arm_collisions.h"
#include "retarget/hands/touch_constraints.h"

namespace marey::retarget {

struct RefineHandsOptions {
  bool keep_touches = true;
  bool resolve_arm_collisions = true;
  /// Volume from a skin if there is one (retarget/body/volume_of_skin.h); nullopt:
  /// average_volume() of the skeleton, the best estimate for a captured person.
  std::optional<BodyVolume> source_volume;
  std::optional<BodyVolume> avatar_volume;
  FindTouchesOptions find;
  KeepTouchesOptions keep;
  ArmCollisionOptions arms;
};

struct HandReport {
  Touches touches;  ///< Detected in the source.
  /// Maximum and mean change of the distance between touching surfaces from the source to
  /// the result, over the frames of touches, for the nearest touch of each hand. Other
  /// touches are kept as far as possible without rotation of the hand. [m]
  double worst_touch_error_m = 0.0;
  double mean_touch_error_m = 0.0;
  int unreachable_frames = 0;  ///< Frames in which a hand could not reach a touched part
                               ///< or a still position.
  ArmCollisionReport arms;
  WorldScale world;  ///< Transform from the source's root to the avatar's.
};

/// Keeps the hands' contacts with the body on another body, and moves arms out of it:
/// find_touches() in the source, keep_touches() and resolve_arm_collisions() on the
/// avatar's motion. That motion is retargeted and on its ground, and is changed in place.
/// Only upper arms, forearms and hands change, so feet stay in place. `world` is the
/// transform from the source's root to the avatar's; if it keeps heights, hands that
/// reach keep theirs (keep_hand_heights()). Deterministic to the byte. Linear in frames,
/// a tenth of a millisecond each; memory for every joint of every frame of both.
/// Precondition: both motions have the same frames; the maps were made from their
/// skeletons; the rate is positive.
HandReport refine_hands(const Motion& source,
                        const BodyMap& source_map,
                        const BodyMap& avatar_map,
                        const WorldScale& world,
                        const RefineHandsOptions& options,
                        Motion& motion);

}  // namespace marey::retarget
