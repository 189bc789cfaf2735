// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "core/motion.h"
#include "retarget/body_map.h"
#include "retarget/body_volume.h"
#include "retarget/detect_contacts.h"

namespace marey::retarget {

/// A hand lies on a part of its own body, or moves slowly over it.
struct Touch {
  int side = 0;  ///< Of the hand: 0 left, 1 right. A touch of both hands is the left's.
  VolumePart part = VolumePart::kHead;
  FrameInterval frames;
  /// What of the hand touches, on its capsule's axis: -1 at the wrist, 1 at the tips.
  double along_hand = 0.0;
  PlaceOnPart place;        ///< Where on the part, on average.
  double distance_m = 0.0;  ///< Between the surfaces, on average; negative: they overlap.
};

/// A hand stays where it is in the world while its shoulder moves: it leans on something,
/// or holds on to it.
struct StillHand {
  int side = 0;
  FrameInterval frames;
  glm::dvec3 p_in_world{0.0};  ///< The middle of the hand, on average. [m]
};

struct Touches {
  int frame_count = 0;
  std::vector<Touch> touches;    ///< By side, then by what is touched, then by time.
  std::vector<StillHand> still;  ///< By side, then by time.
};

/// Lengths and speeds are in leg lengths, so that children and giants count alike.
struct FindTouchesOptions {
  double start_gap_legs = 0.015;        ///< Nearer than this begins a touch,
  double keep_gap_legs = 0.035;         ///< which lasts while nearer than this.
  double start_speed_legs_per_s = 0.3;  ///< Slower over the part than this begins one,
  double keep_speed_legs_per_s = 0.55;  ///< which lasts while slower than this.
  double shortest_s = 0.1;              ///< Shorter touches are accidents.
  double longest_gap_s = 0.05;          ///< Shorter interruptions are noise.
  double smoothing_s = 0.06;            ///< Places and speeds are fitted over this long.
  /// A hand is still while it stays within `still_radius` of where it was, for
  /// `still_shortest_s` at least, and its shoulder strays further than `still_travel`.
  double still_speed_legs_per_s = 0.06;
  double still_radius_legs = 0.02;
  double still_travel_legs = 0.06;
  double still_shortest_s = 0.4;
};

/// Finds what the hands of a motion do to the body, from the motion and the body's volume
/// alone: surfaces near each other and slow against each other, with hysteresis in both.
/// A hand touches at most one part at once of each of: the other hand, the other arm, the
/// head, the trunk, the left leg, the right leg; it is the one that is nearest over the
/// touch. None is a normal answer. Linear in frames, some microseconds each; memory for
/// every joint of every frame.
/// Precondition: map and volume were made from the motion's skeleton; the rate is
/// positive.
[[nodiscard]] Touches find_touches(const Motion& motion,
                                   const BodyMap& map,
                                   const BodyVolume& volume,
                                   const FindTouchesOptions& options = {});

}  // namespace marey::retarget
