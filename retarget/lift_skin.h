// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/motion.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"
#include "retarget/skin.h"

namespace marey::retarget {

struct LiftSkinOptions {
  /// Skin this far below the floor is left there. [m]
  double slack_m = 1e-3;
  /// The body starts to rise this long before it must, and comes down as long after. [s]
  double anticipation_s = 0.3;
  /// The same of a foot alone. [s]
  double foot_anticipation_s = 0.16;
  /// Hair, skirts and tails raise the body by no more than this share of its leg length.
  double max_worn_in_legs = 0.1;
  int max_passes = 12;
};

/// The lowest skin of a motion, below what is allowed.
struct SkinDepth {
  double depth_m = 0.0;          ///< Below the floor, beyond what is allowed; 0: none is.
  std::optional<SkinPart> part;  ///< nullopt: none, or not known.
  int frame = -1;                ///< -1: none.
};

struct LiftSkinReport {
  SkinDepth before;
  SkinDepth after;
  double max_root_m = 0.0;  ///< The most that the body was raised.
  double max_foot_m = 0.0;  ///< The most that an ankle was raised against the floor.
  int passes = 0;
};

/// The deepest skin of a motion below the floor Y = 0, exact. `allowed_m` is how far
/// below it skin may be, one value a frame; empty: not at all. Precondition: `skin` was
/// made from the motion's skeleton.
[[nodiscard]] SkinDepth deepest_skin(const Motion& motion,
                                     const Skin& skin,
                                     std::span<const double> allowed_m = {});

/// Raises a body until its skin is above the floor Y = 0, in place.
///
/// Head, trunk, thighs, shanks, upper arms and forearms raise the whole body; bearing
/// feet stay where they are as far as legs reach and that helps; a foot that is too low
/// rises by its leg, a hand by its arm. The rises are smooth over time
/// (retarget/smooth_cover.h) and vertical; feet and hands keep their orientation. Passes
/// are made until no skin is lower than the slack. Frames far from any that needs it keep
/// their bytes. Same input, same bytes. Some ten microseconds a frame for the first pass,
/// as much again for each frame that is moved.
///
/// `allowed_m` is how far below the floor the source is in each frame, at this body's
/// size: that much is left. Empty: nothing. Precondition: `map` and `skin` were made from
/// the motion's skeleton; one frame of contacts a pose.
LiftSkinReport lift_skin(const Skin& skin,
                         const BodyMap& map,
                         const Contacts& contacts,
                         std::span<const double> allowed_m,
                         const LiftSkinOptions& options,
                         Motion& motion);

/// Head, trunk and limbs but for feet and hands: parts that raise the whole body.
[[nodiscard]] std::span<const SkinPart> lifting_parts();

/// How far parts of one posture are moved up. [m]
struct SkinLift {
  double root_m = 0.0;
  std::array<double, 2> ankle_m{};  ///< Left, right: against where it was.
  std::array<double, 2> wrist_m{};  ///< Beyond `root_m`.

  [[nodiscard]] bool is_zero() const;
};

/// Moves one posture up. Legs and arms follow analytically; feet and hands keep their
/// orientation in the world. A leg that does not reach takes its foot along. Unmarked
/// joints of a leg or arm that changes are taken as at rest. Allocates nothing.
/// Precondition: `world_from_joint` has one entry per joint, `scratch` too.
void lift_posture(const Skeleton& body,
                  const BodyMap& map,
                  const SkinLift& lift,
                  std::span<RigidTransform> world_from_joint,
                  Pose& scratch,
                  Pose& pose);

}  // namespace marey::retarget
