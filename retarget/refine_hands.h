// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/motion.h"
#include "retarget/body_map.h"
#include "retarget/body_volume.h"
#include "retarget/clear_arms.h"
#include "retarget/find_touches.h"
#include "retarget/keep_touches.h"
#include "retarget/touch_constraints.h"

namespace marey::retarget {

struct RefineHandsOptions {
  bool keep_touches = true;
  bool clear_arms = true;
  /// By a skin where there is one (retarget/fit_volume.h); nullopt: average_volume() of
  /// the skeleton, which is as good a guess of somebody captured as there is.
  std::optional<BodyVolume> source_volume;
  std::optional<BodyVolume> avatar_volume;
  FindTouchesOptions find;
  KeepTouchesOptions keep;
  ClearArmsOptions clear;
};

struct HandReport {
  Touches touches;  ///< Found in the source.
  /// Greatest and mean change of the distance between surfaces that touch, over the
  /// frames of touches, from the source's to the delivered, of the nearest touch of each
  /// hand: the others it keeps as far as it can without turning. [m]
  double worst_touch_error_m = 0.0;
  double mean_touch_error_m = 0.0;
  int unreachable_frames = 0;  ///< A hand could not reach what it touches or leans on.
  ClearArmsReport arms;
  WorldScale world;  ///< What brought the source's root to the avatar's.
};

/// What hands do to the body is kept on another body, and arms stay out of it:
/// find_touches() in the source, keep_touches() and clear_arms() on the avatar's motion,
/// which is a retargeted one, in place, after its ground. Only upper arms, forearms and
/// hands of the postures change, so feet stand where they stand. `world` is what brought
/// the source's root to the avatar's; where it keeps heights, hands that reach do, too
/// (keep_hand_heights()). Same input, same bytes. Linear in frames, a tenth
/// of a millisecond each; memory for every joint of every frame of both.
/// Precondition: both motions have the same frames; the maps were made from their
/// skeletons; the rate is positive.
HandReport refine_hands(const Motion& source,
                        const BodyMap& source_map,
                        const BodyMap& avatar_map,
                        const WorldScale& world,
                        const RefineHandsOptions& options,
                        Motion& motion);

}  // namespace marey::retarget
