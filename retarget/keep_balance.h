// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/character.h"
#include "core/character_spec.h"
#include "core/skeleton.h"
#include "core/time.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"
#include "retarget/ground.h"
#include "retarget/measure_balance.h"
#include "retarget/normalized_skeleton.h"
#include "retarget/support_frame.h"

namespace marey::retarget {

struct BalanceOptions {
  /// What the bodies weigh; de Leva's shares of 70 kg say where as well as any.
  MassSpec source_masses;
  MassSpec avatar_masses;
  double ramp_s = 0.4;      ///< A foot takes this long to bear in full.
  double low_pass_s = 0.8;  ///< Whole width of the window over what is missing.
  int passes = 8;           ///< Each brings back what the low-pass took before.
  // What is in balance: in full while the centre of mass is slower than the one, and
  // above what bears; not at all when faster than the other, or that many half sizes from
  // the middle of what bears (support_frame.h).
  double still_legs_per_s = 0.25;
  double moving_legs_per_s = 0.7;
  double beside_halves = 2.5;
};

/// What keeping balance came to.
struct KeptBalance {
  GroundReport ground;
  double furthest_m = 0.0;  ///< Most that the root was moved.
  /// How far the centre of mass is from where it belongs, seen from above, on average
  /// over the frames that bear, each as far as it does: before, and at last.
  double mean_off_before_m = 0.0;
  double mean_off_m = 0.0;
};

/// That, and in how many frames the centre of mass is above what bears.
struct BalanceReport {
  KeptBalance kept;
  BalanceFigures source;  ///< As it was captured.
  // On the avatar, its feet on the floor, held against the source: the root not moved,
  // and moved. Both before hands are kept where they touch.
  BalanceFigures before;
  BalanceFigures after;
};

/// A body in a motion that is to be kept on another: where its centre of mass is above
/// what bears, frame by frame.
struct BalanceReference {
  std::vector<SupportShares> shares;
  std::vector<SupportFrame> support;
  std::vector<glm::dvec2> com_xz_m;
  /// How near to standing still over what bears: 0 to 1 (BalanceOptions).
  std::vector<double> still;
  double leg_length_m = 0.0;
};

/// Of postures that stand on their feet already (adapt_to_ground()). Linear in frames.
/// Precondition: `masses` are on the body's joints and weigh something.
[[nodiscard]] BalanceReference balance_reference(const Skeleton& body,
                                                 const BodyMap& map,
                                                 std::span<const PointMass> masses,
                                                 const Contacts& contacts,
                                                 FrameRate rate,
                                                 std::span<const NormalizedPose> poses,
                                                 const BalanceOptions& options);

/// One body to keep in balance.
struct BalancedBody {
  const Skeleton& skeleton;
  const BodyMap& map;
  std::span<const PointMass> masses;
};

/// adapt_to_ground() that keeps the centre of mass, seen from above, where the reference
/// has it: while that stands still over what bears, at the same share of what bears
/// (corresponding(), by `beyond_scale` where it is beside). Where bodies move, and
/// nothing is in balance, the motion is what it is without, displaced as before and
/// after. The root alone moves for it, level: that shifts the mass at the least cost of
/// angles (3 cm at an adult are 2 degrees of the legs, or 10 of the trunk), leaves trunk,
/// head and arms turned as they are and hands on the body. Feet stay on the footprints
/// they have without it, to the bit; where a leg would not reach, the root sinks. It is
/// moved by 0.3 legs at most: what is then missing stays so.
///
/// Displacement maps: what is missing is found frame by frame, low-passed over the frames
/// that are still, added, and all stands on its feet again, `passes` times; so nothing
/// pops, and the last word is the feet's. Where nothing is missing nothing is moved, to
/// the bit. Linear in frames; some ten microseconds each a pass. Precondition: as
/// adapt_to_ground(); the reference has its frames.
KeptBalance keep_balance(const BalanceReference& reference,
                         const BalancedBody& body,
                         const Contacts& contacts,
                         FrameRate rate,
                         double beyond_scale,
                         std::span<NormalizedPose> poses,
                         const BalanceOptions& options,
                         const GroundOptions& ground = {});

}  // namespace marey::retarget
