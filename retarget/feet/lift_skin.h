// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/body/skin.h"

namespace marey::retarget {

struct LiftSkinOptions {
  /// Skin up to this depth below the floor is left there. [m]
  double slack_m = 1e-3;
  /// The body starts to rise this long before it must, and comes down as long after. [s]
  double anticipation_s = 0.3;
  /// Anticipation of a single foot. [s]
  double foot_anticipation_s = 0.16;
  /// Maximum rise of the body for hair, skirts and tails, as a share of its leg length.
  double max_worn_in_legs = 0.1;
  int max_passes = 12;
};

/// Lowest skin of a motion, below the allowed depth.
struct SkinDepth {
  double depth_m = 0.0;          ///< Depth below the floor beyond the allowed; 0: none.
  std::optional<SkinPart> part;  ///< nullopt: none, or not known.
  std::optional<int> frame{};    ///< nullopt: none.
};

struct LiftSkinReport {
  SkinDepth before;
  SkinDepth after;
  double max_root_m = 0.0;  ///< Maximum rise of the body.
  double max_foot_m = 0.0;  ///< Maximum rise of an ankle relative to the floor.
  int passes = 0;
};

/// Computes the deepest skin of a motion below the floor Y = 0, exact. `allowed_m` is the
/// allowed depth of the skin, one value per frame; empty: 0.
/// Precondition: `skin` was made from the motion's skeleton.
[[nodiscard]] SkinDepth max_skin_depth(const Motion& motion,
                                       const Skin& skin,
                                       std::span<const double> allowed_m = {});

/// Raises a body until its skin is above the floor Y = 0, in place.
///
/// Head, trunk, thighs, shanks, upper arms and forearms raise the whole body. Bearing
/// feet stay in place as far as the legs reach and this removes the depth. A foot that is
/// too low rises by its leg, a hand by its arm. The rises are smooth over time
/// (retarget/base/smooth_cover.h) and vertical; feet and hands keep their orientation.
/// Passes are repeated until no skin is lower than the slack. Frames far from any that
/// needs a rise keep their bytes. Same input, same bytes. Cost: about ten microseconds
/// per frame for the first pass, and as much again for each frame that is moved.
///
/// `allowed_m` is the depth of the source below the floor in each frame, at this body's
/// size; skin up to this depth is left. Empty: 0.
/// Precondition: `map` and `skin` were made from the motion's skeleton; one frame of
/// contacts per pose.
LiftSkinReport lift_skin(const Skin& skin,
                         const BodyMap& map,
                         const Contacts& contacts,
                         std::span<const double> allowed_m,
                         const LiftSkinOptions& options,
                         Motion& motion);

/// Returns the parts that raise the whole body: head, trunk and limbs except feet and
/// hands.
[[nodiscard]] std::span<const SkinPart> lifting_parts();

/// Vertical displacement of the parts of one posture. [m]
struct SkinLift {
  double root_m = 0.0;
  std::array<double, 2> ankle_m{};  ///< Left, right: relative to its place before.
  std::array<double, 2> wrist_m{};  ///< Beyond `root_m`.

  [[nodiscard]] bool is_zero() const;
};

/// Moves one posture up. Legs and arms follow analytically; feet and hands keep their
/// orientation in the world. A leg that does not reach moves its foot along. Unmarked
/// joints of a leg or arm that changes are set to their rest rotation. Allocates nothing.
/// Precondition: `world_from_joint` has one entry per joint, `scratch` too.
void lift_posture(const Skeleton& body,
                  const BodyMap& map,
                  const SkinLift& lift,
                  std::span<RigidTransform> world_from_joint,
                  Pose& scratch,
                  Pose& pose);

}  // namespace marey::retarget
