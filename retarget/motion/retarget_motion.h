// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/balance/keep_balance.h"
#include "retarget/body/find_soles.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/feet/lift_skin.h"
#include "retarget/hands/refine_hands.h"
#include "retarget/motion/compare_postures.h"

namespace marey::retarget {

/// Conversion of lengths in the world.
enum class WorldLengths {
  kScaled,  ///< Scaled with the body, by the factor of RetargetOptions::root.
  kKept,    ///< Metres are kept.
};

struct RetargetOptions {
  RootNormalization root = RootNormalization::kLegLength;
  /// The horizontal path of the root, and with it of footprints and still hands. The root
  /// sinks where legs are too short for kept strides.
  WorldLengths path = WorldLengths::kScaled;
  /// Heights of reaching hands and feet, still hands, chairs and jumps
  /// (retarget/hands/keep_heights.h). Standing height is always the avatar's own. Hands:
  /// if `hands` is set.
  WorldLengths heights = WorldLengths::kScaled;
  bool adapt_ground = true;
  Soles soles;  ///< Soles of the avatar, if its skin is known.
  /// The avatar's skin, raised out of the floor (retarget/feet/lift_skin.h) if
  /// adapt_ground is set; null or empty: unknown. Must outlive the call.
  const Skin* skin = nullptr;
  LiftSkinOptions lift;
  DetectContactsOptions contacts;
  /// The source's contacts, if they are known, such as contacts that were changed by
  /// hand; nullopt: detected in the source.
  std::optional<Contacts> known_contacts{};
  GroundOptions ground;
  /// Options for keeping hand contacts and moving arms out of the body
  /// (retarget/hands/refine_hands.h); nullopt: arms keep the normalized posture.
  std::optional<RefineHandsOptions> hands;
  /// Options for keeping the centre of mass over the support area
  /// (retarget/balance/keep_balance.h); nullopt: balance is not corrected. Needs
  /// adapt_ground.
  std::optional<BalanceOptions> balance;
  /// Fills in RetargetReport::steps. Costs two forward kinematics per step and frame.
  bool compare_steps = false;
};

/// The steps of retarget_motion(), in order.
enum class RetargetStep {
  kPosture,  ///< The source's posture on bones of other lengths.
  kGround,   ///< Feet stand; the centre of mass is over them if requested.
  kHands,    ///< Hands keep the source's touches, arms stay out of the body.
  kSkin,     ///< The skin is raised out of the floor.
};

/// The source's and the avatar's body.
struct MappedBodies {
  BodyMap source;
  BodyMap avatar;
};
/// Maps both bodies, the avatar's with match_carriage(), and checks that the root can be
/// normalized with them. Errors: those of map_body(), for the source ("source skeleton")
/// or the avatar ("avatar"); a body without arms if the root is normalized by them.
[[nodiscard]] Result<MappedBodies> map_bodies(const Skeleton& source,
                                              const Skeleton& avatar,
                                              RootNormalization root);

/// Contact errors of the feet.
struct FootFigures {
  /// Mean horizontal speed of the bearing joints, over all contacts. [cm/s]
  double mean_slide_cm_per_s = 0.0;
  /// Maximum depth of an ankle or toe joint below its height when standing in the T-pose,
  /// or of an end of a sole below the floor. [mm]
  double max_penetration_mm = 0.0;
};

/// Measures a motion's feet against the given contacts. Precondition: `map` was made from
/// the motion's skeleton; one contact frame per pose.
[[nodiscard]] FootFigures measure_feet(const Motion& motion,
                                       const BodyMap& map,
                                       const Contacts& contacts);

struct RetargetReport {
  Contacts contacts;   ///< Stances of the source, detected or as given.
  FootFigures before;  ///< On the avatar, without ground adaptation.
  FootFigures after;   ///< On the avatar, final result.
  GroundReport ground;
  HandReport hands;                      ///< Empty unless requested.
  std::optional<BalanceReport> balance;  ///< Present if requested.
  LiftSkinReport skin;                   ///< Empty without a skin.
  /// Differences of segment directions from the source's after each performed step, in
  /// the order of the steps; empty unless RetargetOptions::compare_steps is set.
  std::vector<std::pair<RetargetStep, PostureFigures>> steps;
  /// Depth of the source's joints (except the feet's) below its floor, per frame, at the
  /// avatar's size. The avatar's skin may be as deep. [m]
  std::vector<double> source_depth_m;
};

struct RetargetedMotion {
  Motion motion;
  RetargetReport report;
};

/// Retargets a motion to another body: normalized skeleton, root at the avatar's height,
/// feet on the floor Y = 0 (defined by the source's feet at any height), hands at their
/// positions on the source's body, and the centre of mass over the support area if
/// requested. Frames, rate and first_frame are the source's. Deterministic to the byte.
/// Linear in frames, some ten microseconds each; keep_balance() and refine_hands() cost
/// more.
///
/// Errors: those of map_bodies() and place_masses(); balance without ground adaptation.
/// Precondition: the rate is positive; every pose has one entry per joint; known contacts
/// have the source's frames.
[[nodiscard]] Result<RetargetedMotion> retarget_motion(
    const Motion& source, const Skeleton& avatar, const RetargetOptions& options = {});

}  // namespace marey::retarget
