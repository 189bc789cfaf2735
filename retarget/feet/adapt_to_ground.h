// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/time.h"
#include "core/human/contacts.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/feet/plan_foot_path.h"

namespace marey::retarget {

struct GroundOptions {
  FootPathOptions feet;
  /// The root starts to sink this long before a leg would be too short, and rises as long
  /// after. [s]
  double anticipation_s = 0.2;
  /// Maximum extension of a bearing leg as a share of its length, unless the reference
  /// exceeds it: the last percent of extension takes ten degrees of the knee at once.
  double straight = 0.995;
};

struct GroundReport {
  /// Number of frames in which a bearing foot does not reach its footprint.
  int unreachable_frames = 0;
};

/// Returns the world Y of the resting ankles: that of `contacts`; for a foot that never
/// stands the body's own, above the floor of the other foot, or above Y = 0. [m]
[[nodiscard]] std::array<double, 2> ankles_rest_m(const BodyMap& source,
                                                  const Contacts& contacts);

/// Returns the world Y of the floor under a body whose ankles rest at these heights: the
/// mean of the heights below both ankles. [m]
[[nodiscard]] double floor_height_m(const BodyMap& body,
                                    const std::array<double, 2>& ankles_rest_m);

/// Returns the rise of a root that was scaled with the legs, for a body whose hips or
/// ankles have other offsets than the source's: with it the body stands on Y = 0 with the
/// source's knee bend. [m] Negative: sink. Source resting heights are those of
/// `contacts`.
[[nodiscard]] double standing_rise_m(const BodyMap& source,
                                     const Contacts& contacts,
                                     const BodyMap& avatar,
                                     double scale);

/// Returns the same for a source whose left and right ankle rest at these heights.
[[nodiscard]] double standing_rise_m(const BodyMap& source,
                                     const std::array<double, 2>& source_ankles_rest_m,
                                     const BodyMap& avatar,
                                     double scale);

/// Adapts a whole motion to the ground, in place (fast ground adaptation, Kulpa 2005,
/// 4.2.4.1).
///
/// `poses` are the reference postures at this body's size, one per frame of `contacts`.
/// The feet follow plan_foot_path(). The root keeps its path, and its height unless a
/// bearing leg would not reach: the height is then the minimum of the reference's and
/// those at which each bearing leg is straight, smoothed over time (the thesis takes the
/// minimum posture by posture). Legs follow analytically. Frames in which no foot bears,
/// more than `anticipation_s` away from one that does, keep their root height. Linear in
/// frames, and in `anticipation_s`; one expansion per frame.
GroundReport adapt_to_ground(const Skeleton& body,
                             const BodyMap& map,
                             const Contacts& contacts,
                             FrameRate rate,
                             std::span<NormalizedPose> poses,
                             const GroundOptions& options = {});

/// Returns the planned feet of adapt_to_ground(), left and right, one place per pose:
/// plan_foot_path() of both.
/// Precondition: one pose per frame of `contacts`.
[[nodiscard]] std::array<std::vector<FootPlace>, 2> plan_level_feet(
    const Skeleton& body,
    const BodyMap& map,
    const Contacts& contacts,
    FrameRate rate,
    std::span<const NormalizedPose> poses,
    const FootPathOptions& options = {});

/// Adapts a motion as adapt_to_ground() does, to other planned feet, above any floor: the
/// root sinks where a bearing leg would not reach; legs, feet and toes follow. `feet` are
/// left, right, one place per pose.
GroundReport settle_on_feet(const Skeleton& body,
                            const BodyMap& map,
                            const Contacts& contacts,
                            FrameRate rate,
                            std::span<NormalizedPose> poses,
                            std::array<std::vector<FootPlace>, 2> feet,
                            const GroundOptions& options = {});

}  // namespace marey::retarget
