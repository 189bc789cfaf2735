// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/base/frame_range.h"

namespace marey {

/// Contacts of one foot with the floor, ascending and disjoint. A foot flat on the floor
/// has both heel and ball contact.
struct FootContacts {
  std::vector<FrameRange> heel;    ///< The ankle rests.
  std::vector<FrameRange> ball;    ///< The toe joint rests (without toes: as the heel).
  std::vector<FrameRange> stance;  ///< Heel or ball.
  /// The ball rests and the raised heel does not move: within `ball`, disjoint from
  /// `heel`.
  std::vector<FrameRange> heel_up;
  double ankle_height_m = 0.0;  ///< World Y of the ankle when it rests.
  double ball_height_m = 0.0;   ///< World Y of the toe joint when it rests.
};

/// Contacts of both feet over a motion of `frame_count` poses.
struct Contacts {
  int frame_count = 0;
  std::array<FootContacts, 2> feet;  ///< Left, right.
};

}  // namespace marey
