// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Lengths and speeds are in leg lengths, so that the thresholds hold for bodies of any
/// size.
struct DetectContactsOptions {
  double start_speed_legs_per_s = 0.2;  ///< A contact begins below this speed,
  double keep_speed_legs_per_s = 0.35;  ///< and lasts while below this one.
  /// A contact is extended to the frames where the speed first drops below this, and last
  /// rises above it.
  double edge_speed_legs_per_s = 0.25;
  double start_height_legs = 0.02;  ///< A contact begins below this height,
  double keep_height_legs = 0.045;  ///< and lasts while below this one.
  double heel_up_legs = 0.03;       ///< Maximum movement of a still raised heel.
  double uneven_legs = 0.06;        ///< Maximum height difference between steps.
  double min_contact_s = 0.06;      ///< Shorter contacts are dropped.
  double max_gap_s = 0.05;          ///< Shorter interruptions are noise.
  double smoothing_s = 0.06;        ///< Span of the line fits that give the speeds.
};

/// Detects when each foot stands, from the motion alone: the ankle and the toe joint are
/// slow and low, with hysteresis in both. The resting heights come from the motion itself
/// (the lower decile of the heights while slow, of the whole motion and of each step). So
/// a floor that is a few centimetres off Y = 0, or uneven by as much, does not affect the
/// result; stairs and slopes do. A motion without contacts (all flight) is not an error.
/// Linear in frames.
/// Precondition: `map` was made from the motion's skeleton; the rate is positive.
[[nodiscard]] Contacts detect_contacts(const Motion& motion,
                                       const BodyMap& map,
                                       const DetectContactsOptions& options = {});

}  // namespace marey::retarget
