// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/time.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::dynamics {

/// A body that flies: postures from the last frame on the floor to the first one.
struct MadeFlight {
  Skeleton skeleton;
  std::vector<PointMass> masses;
  FrameRate rate;
  std::vector<Pose> poses;
};

struct MadeFlightRule {
  std::size_t frames = 60;
  double rate_hz = 120.0;
  double max_swing_rad = 0.5;  ///< Amplitude of the joints' rotation.
  double max_swing_hz = 2.5;
  double turns = 0.0;  ///< Somersault during the flight.
};

/// Returns a random human whose joints all swing, each about its own axis: the angular
/// momentum of the made postures is far from constant.
[[nodiscard]] MadeFlight made_flight(testing::Dice& dice, const MadeFlightRule& rule);

/// Returns masses of about 70 kg on all bones, with random principal axes.
[[nodiscard]] std::vector<PointMass> made_masses(const Skeleton& skeleton,
                                                 testing::Dice& dice);

}  // namespace marey::dynamics
