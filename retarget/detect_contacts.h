// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/motion.h"
#include "retarget/body_map.h"

namespace marey::retarget {

/// A run of poses of a motion, both ends included.
struct FrameInterval {
  int first = 0;
  int last = 0;
};

/// When one foot bears on the floor, ascending and apart. Flat on the floor is both.
struct FootContacts {
  std::vector<FrameInterval> heel;  ///< The ankle rests.
  std::vector<FrameInterval> ball;  ///< The toe joint rests (without toes: as the heel).
  std::vector<FrameInterval> stance;  ///< Heel or ball.
  /// The ball rests and the heel, though up, keeps still: within `ball`, apart from
  /// `heel`.
  std::vector<FrameInterval> heel_up;
  double ankle_height_m = 0.0;        ///< World Y of the ankle when it rests.
  double ball_height_m = 0.0;         ///< World Y of the toe joint when it rests.
};

/// Contacts of both feet over a motion of `frame_count` poses.
struct Contacts {
  int frame_count = 0;
  std::array<FootContacts, 2> feet;  ///< Left, right.
};

/// Lengths and speeds are in leg lengths, so that children and giants count alike.
struct DetectContactsOptions {
  double start_speed_legs_per_s = 0.2;  ///< Slower than this begins a contact,
  double keep_speed_legs_per_s = 0.35;  ///< which lasts while slower than this.
  /// Nor does it begin later than where the foot is slower than this from then on, or end
  /// earlier than where it was slower until then.
  double edge_speed_legs_per_s = 0.25;
  double start_height_legs = 0.02;      ///< Lower above its resting height begins one,
  double keep_height_legs = 0.045;      ///< which lasts while lower than this.
  double heel_up_legs = 0.03;           ///< A raised heel that is still moves less.
  double uneven_legs = 0.06;            ///< Steps may be this much higher than others.
  double shortest_s = 0.06;             ///< Shorter contacts are accidents.
  double longest_gap_s = 0.05;          ///< Shorter interruptions are noise.
  double smoothing_s = 0.06;  ///< Speeds are slopes of lines fitted over this long.
};

/// Finds when each foot stands, from the motion alone: the ankle and the toe joint are
/// slow and low, with hysteresis in both. How low a resting joint is comes from the
/// motion itself (the lower decile of its heights while slow, of the whole motion and of
/// each step), so a floor that is a few centimetres off Y = 0, or uneven by as much, does
/// no harm; stairs and slopes do. No contact is a normal answer (all flight). Linear in
/// frames.
/// Precondition: `map` was made from the motion's skeleton; the rate is positive.
[[nodiscard]] Contacts detect_contacts(const Motion& motion,
                                       const BodyMap& map,
                                       const DetectContactsOptions& options = {});

}  // namespace marey::retarget
