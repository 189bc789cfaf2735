// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_volume.h"

namespace marey::retarget {

/// Contact of a hand with a part of its own body: at rest or in slow motion.
struct Touch {
  int side = 0;  ///< Side of the hand: 0 left, 1 right. A touch of both hands belongs to
                 ///< the left.
  VolumePart part = VolumePart::kHead;
  FrameRange frames;
  /// Contact position on the axis of the hand's capsule: -1 at the wrist, 1 at the tips.
  double along_hand = 0.0;
  PlaceOnPart place;        ///< Mean position on the part.
  double distance_m = 0.0;  ///< Mean distance between the surfaces; negative: they
                            ///< overlap.
};

/// A hand that is stationary in the world while its shoulder moves: it leans on or holds
/// something.
struct StillHand {
  int side = 0;
  FrameRange frames;
  glm::dvec3 p_in_world{0.0};  ///< Mean position of the middle of the hand. [m]
};

struct Touches {
  int frame_count = 0;
  std::vector<Touch> touches;    ///< Ordered by side, then by touched part, then by time.
  std::vector<StillHand> still;  ///< Ordered by side, then by time.
};

/// Lengths and speeds are in leg lengths, so that thresholds are independent of body
/// size.
struct FindTouchesOptions {
  double start_gap_legs = 0.015;        ///< A touch starts below this distance,
  double keep_gap_legs = 0.035;         ///< and continues while below this one.
  double start_speed_legs_per_s = 0.3;  ///< A touch starts below this speed over the
                                        ///< part,
  double keep_speed_legs_per_s = 0.55;  ///< and continues while below this one.
  double min_touch_s = 0.1;             ///< Shorter touches are discarded.
  double max_gap_s = 0.05;              ///< Shorter gaps are closed.
  double smoothing_s = 0.06;            ///< Window of the fit of positions and speeds.
  /// A hand is still while it is slower than `still_speed_legs_per_s` and stays within
  /// `still_radius_legs` of its position for at least `min_still_s`, and its shoulder
  /// moves by more than `still_travel_legs`.
  double still_speed_legs_per_s = 0.06;
  double still_radius_legs = 0.02;
  double still_travel_legs = 0.06;
  double min_still_s = 0.4;
};

/// Detects contacts of the hands with the body, from the motion and the body's volume
/// alone: surfaces that are near each other with a low relative speed, with hysteresis in
/// both. A hand touches at most one part at a time of each of: the other hand, the other
/// arm, the head, the trunk, the left leg, the right leg; the nearest one over the touch
/// is used. An empty result is valid. Linear in frames, some microseconds per frame;
/// memory for every joint of every frame. Precondition: map and volume were made from the
/// motion's skeleton; the rate is positive.
[[nodiscard]] Touches find_touches(const Motion& motion,
                                   const BodyMap& map,
                                   const BodyVolume& volume,
                                   const FindTouchesOptions& options = {});

}  // namespace marey::retarget
