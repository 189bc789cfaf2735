// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/time.h"
#include "core/character.h"
#include "core/character_spec.h"
#include "core/human/contacts.h"
#include "core/skeleton.h"
#include "retarget/balance/measure_balance.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/contacts/support_frame.h"
#include "retarget/feet/adapt_to_ground.h"

namespace marey::retarget {

struct BalanceOptions {
  /// Masses of the bodies. De Leva's fractions of 70 kg are sufficient for the position
  /// of the centre of mass.
  MassSpec source_masses;
  MassSpec avatar_masses;
  double ramp_s = 0.4;      ///< Time until a foot bears its full weight.
  double low_pass_s = 0.8;  ///< Full width of the window for the error.
  int passes = 8;           ///< Each pass restores what the low-pass removed before.
  /// A frame counts fully while the centre of mass is slower than this and above the
  /// support area.
  double still_legs_per_s = 0.25;
  /// A frame does not count while the centre of mass is faster than this.
  double moving_legs_per_s = 0.7;
  /// A frame does not count while the centre of mass is further than this from the middle
  /// of the support area, in half sizes of the area (support_frame.h).
  double max_offset_in_halves = 2.5;
};

/// Result of keeping balance.
struct KeptBalance {
  GroundReport ground;
  double max_shift_m = 0.0;  ///< Maximum shift of the root.
  /// Mean horizontal distance of the centre of mass from its target over the frames with
  /// support, weighted by support: before and after.
  double mean_off_before_m = 0.0;
  double mean_off_m = 0.0;
};

/// Result of keeping balance, and the number of frames with the centre of mass above the
/// support area.
struct BalanceReport {
  KeptBalance kept;
  BalanceFigures source;  ///< Source as captured.
  // Avatar with its feet on the floor, compared with the source: without and with the
  // shift of the root. Both before hands are corrected.
  BalanceFigures before;
  BalanceFigures after;
};

/// Position of a body's centre of mass relative to its support area, frame by frame.
/// Input for keeping it on another body.
struct BalanceReference {
  std::vector<SupportShares> shares;
  std::vector<SupportFrame> support;
  std::vector<glm::dvec2> com_xz_m;
  /// Share of standing still over the support in each frame: 0 to 1 (BalanceOptions).
  std::vector<double> still;
  double leg_length_m = 0.0;
};

/// Computes the reference from postures with their feet on the floor (adapt_to_ground()).
/// Linear in frames. Precondition: `masses` are on the body's joints and their sum is
/// above 0.
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

/// Applies adapt_to_ground() and keeps the horizontal position of the centre of mass as
/// in the reference. While the reference stands still over its support, the target is the
/// same relative position in the support area (corresponding(), scaled by `beyond_scale`
/// outside of the area). In other frames the motion is that without balance, displaced
/// continuously with the neighbouring frames. Only the root moves, horizontally: this
/// shifts the mass with the smallest change of angles (3 cm for an adult are 2 degrees of
/// the legs, or 10 of the trunk). Trunk, head and arms keep their rotation, and hands
/// stay on the body. Feet keep their footprints to the bit; where a leg does not reach,
/// the root sinks. The shift is at most 0.3 legs; a larger error remains.
///
/// Uses displacement maps: the error is computed frame by frame, low-passed over the
/// still frames and added, then the feet are adapted again, `passes` times. The motion
/// stays continuous, and the feet are adapted last. Without error the motion is unchanged
/// to the bit. Linear in frames; some ten microseconds per frame and pass. Precondition:
/// as adapt_to_ground(); the reference has its frames.
KeptBalance keep_balance(const BalanceReference& reference,
                         const BalancedBody& body,
                         const Contacts& contacts,
                         FrameRate rate,
                         double beyond_scale,
                         std::span<NormalizedPose> poses,
                         const BalanceOptions& options,
                         const GroundOptions& ground = {});

}  // namespace marey::retarget
