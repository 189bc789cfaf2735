// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/skeleton.h"
#include "core/time.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"
#include "retarget/foot_plan.h"
#include "retarget/normalized_skeleton.h"

namespace marey::retarget {

struct GroundOptions {
  FootPlanOptions feet;
  /// The root starts to sink this long before a leg would be too short, and rises as
  /// long after. [s]
  double anticipation_s = 0.2;
  /// A bearing leg is stretched no further than this share of its length, unless the
  /// reference does: the last percent costs a knee ten degrees at once.
  double straight = 0.995;
};

struct GroundReport {
  /// Frames in which a bearing foot could not stay on its footprint.
  int unreachable_frames = 0;
};

/// World Y of the ankles when they rest: of `contacts`; of a foot that never stands the
/// body's own, over the floor of the other one, or Y = 0. [m]
[[nodiscard]] std::array<double, 2> ankles_rest_m(const BodyMap& source,
                                                  const Contacts& contacts);

/// World Y of the floor that a body stands on whose ankles rest at these heights: the
/// mean of what is below both ankles. [m]
[[nodiscard]] double floor_height_m(const BodyMap& body,
                                    const std::array<double, 2>& ankles_rest_m);

/// By how much a root that was scaled with the legs must rise so that a body whose hips
/// or ankles lie otherwise than the source's stands on Y = 0 with its legs as bent as
/// the source's. [m] Negative: sink. Source resting heights are those of `contacts`.
[[nodiscard]] double standing_rise_m(const BodyMap& source,
                                     const Contacts& contacts,
                                     const BodyMap& avatar,
                                     double scale);

/// The same where the source's left and right ankle rest at these heights.
[[nodiscard]] double standing_rise_m(const BodyMap& source,
                                     const std::array<double, 2>& source_ankles_rest_m,
                                     const BodyMap& avatar,
                                     double scale);

/// Fast ground adaptation (Kulpa 2005, 4.2.4.1) of a whole motion, in place.
///
/// `poses` are the reference postures at this body's size, one per frame of `contacts`.
/// The feet go where plan_foot() says. The root keeps its path, and its height unless a
/// bearing leg would not reach: the height is the least of the reference's and those at
/// which each bearing leg is straight, but taken smoothly, from before to after the
/// moment (the thesis takes the minimum posture by posture). Legs follow analytically.
/// Frames in which no foot bears, more than `anticipation_s` away from one that does,
/// keep their root height. Linear in frames, and in `anticipation_s`; one expansion per
/// frame.
GroundReport adapt_to_ground(const Skeleton& body,
                             const BodyMap& map,
                             const Contacts& contacts,
                             FrameRate rate,
                             std::span<NormalizedPose> poses,
                             const GroundOptions& options = {});

/// Where that has the feet, left and right, one place a pose: plan_foot() of both.
/// Precondition: one pose per frame of `contacts`.
[[nodiscard]] std::array<std::vector<FootPlace>, 2> plan_level_feet(
    const Skeleton& body,
    const BodyMap& map,
    const Contacts& contacts,
    FrameRate rate,
    std::span<const NormalizedPose> poses,
    const FootPlanOptions& options = {});

/// The same onto feet that were planned otherwise, above any floor: the root sinks where
/// a bearing leg would not reach, legs, feet and toes follow. `feet` are left, right, one
/// place a pose.
GroundReport settle_on_feet(const Skeleton& body,
                            const BodyMap& map,
                            const Contacts& contacts,
                            FrameRate rate,
                            std::span<NormalizedPose> poses,
                            std::array<std::vector<FootPlace>, 2> feet,
                            const GroundOptions& options = {});

}  // namespace marey::retarget
