// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/motion.h"
#include "core/result.h"
#include "retarget/compare_postures.h"
#include "retarget/detect_contacts.h"
#include "retarget/find_soles.h"
#include "retarget/ground.h"
#include "retarget/keep_balance.h"
#include "retarget/lift_skin.h"
#include "retarget/normalized_skeleton.h"
#include "retarget/refine_hands.h"

namespace marey::retarget {

/// What becomes of a length in the world.
enum class WorldLengths {
  kScaled,  ///< It grows with the body: by what RetargetOptions::root names.
  kKept,    ///< Metres stay metres.
};

struct RetargetOptions {
  RootNormalization root = RootNormalization::kLegLength;
  /// The way over the ground: of the root, and with it of footprints and still hands.
  /// Legs that are too short for kept strides make the root sink.
  WorldLengths path = WorldLengths::kScaled;
  /// How high hands and feet reach, still hands are, seats are and jumps go
  /// (retarget/keep_heights.h). Who stands, stands at the own height. Hands: if `hands`.
  WorldLengths heights = WorldLengths::kScaled;
  bool adapt_ground = true;
  Soles soles;  ///< Of the avatar, where its skin is known.
  /// The avatar's skin, which is raised out of the floor (retarget/lift_skin.h) when
  /// adapt_ground is set; null or empty: unknown. It must outlive the call.
  const Skin* skin = nullptr;
  LiftSkinOptions lift;
  DetectContactsOptions contacts;
  GroundOptions ground;
  /// What hands do to the body is kept, arms stay out of it (retarget/refine_hands.h);
  /// nullopt: arms stay where the normalized posture has them.
  std::optional<RefineHandsOptions> hands;
  /// The centre of mass is kept over what bears (retarget/keep_balance.h); nullopt: it is
  /// where the posture brings it. Needs adapt_ground.
  std::optional<BalanceOptions> balance;
  /// Fills in RetargetReport::steps. Costs two forward kinematics a step and frame.
  bool compare_steps = false;
};

/// The steps of retarget_motion(), in order.
enum class RetargetStep {
  kPosture,  ///< The source's posture on bones of other lengths.
  kGround,   ///< Feet stand; the centre of mass is over them if requested.
  kHands,    ///< Hands keep the source's touches, arms stay out of the body.
  kSkin,     ///< The skin is raised out of the floor.
};

/// Who moves, and who is to.
struct MappedBodies {
  BodyMap source;
  BodyMap avatar;
};
/// Maps both bodies, the avatar's with match_carriage(), and checks that the root can be
/// normalized with them.
/// Errors: map_body()'s, of the source ("source skeleton") or the avatar ("avatar"); no
/// arms to normalize the root with.
[[nodiscard]] Result<MappedBodies> map_bodies(const Skeleton& source,
                                              const Skeleton& avatar,
                                              RootNormalization root);

/// How well feet keep to the floor.
struct FootFigures {
  /// Mean horizontal speed of the joints that bear, over all contacts. [cm/s]
  double mean_slide_cm_per_s = 0.0;
  /// Most that an ankle or toe joint is lower than when it stands in the T-pose, or that
  /// an end of a sole is below the floor. [mm]
  double deepest_penetration_mm = 0.0;
};

/// Measures a motion's feet against the contacts it should have.
/// Precondition: `map` was made from the motion's skeleton; one contact frame per pose.
[[nodiscard]] FootFigures measure_feet(const Motion& motion,
                                       const BodyMap& map,
                                       const Contacts& contacts);

struct RetargetReport {
  Contacts contacts;   ///< Stances, found in the source.
  FootFigures before;  ///< On the avatar, without ground adaptation.
  FootFigures after;   ///< On the avatar, as delivered.
  GroundReport ground;
  HandReport hands;                      ///< Empty unless asked for.
  std::optional<BalanceReport> balance;  ///< If asked for.
  LiftSkinReport skin;                   ///< Empty unless there is a skin.
  /// How far segments point away from the source's after each step that was taken, in the
  /// order of the steps; empty unless RetargetOptions::compare_steps is set.
  std::vector<std::pair<RetargetStep, PostureFigures>> steps;
  /// How far joints of the source other than the feet's are below its floor, frame by
  /// frame, at the avatar's size: what its skin may be, too. [m]
  std::vector<double> source_depth_m;
};

struct RetargetedMotion {
  Motion motion;
  RetargetReport report;
};

/// Puts a motion on another body: normalized skeleton, root at the avatar's height,
/// feet on the floor Y = 0 (which the source's feet define, wherever they rest), hands
/// where they are on the source's body, and the centre of mass over what bears, if asked
/// for. Frames, rate and first_frame are the source's. Same input, same bytes. Linear in
/// frames, some ten microseconds each; keep_balance() and refine_hands() more.
///
/// Errors: map_bodies()'s; place_masses()'s; balance without the ground. Precondition:
/// the rate is positive; every pose has one entry per joint.
[[nodiscard]] Result<RetargetedMotion> retarget_motion(
    const Motion& source, const Skeleton& avatar, const RetargetOptions& options = {});

}  // namespace marey::retarget
