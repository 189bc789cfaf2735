// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "dynamics/jumps/find_jumps.h"
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/made_jump.h"

namespace marey::dynamics {

using marey::testing::Dice;
using marey::testing::made_jump;
using marey::testing::MadeFlight;
using marey::testing::MadeFlightTruth;
using marey::testing::MadeJump;
using marey::testing::MadeJumpOptions;

inline MadeJumpOptions random_jump_options(std::uint64_t seed, double min_hz) {
  Dice dice(1000 + seed);
  MadeJumpOptions options;
  options.stature_m = dice.between(0.6, 2.5);
  options.rate_hz = dice.between(min_hz, 240.0);
  options.first_floor_m = dice.between(-0.5, 1.0);
  options.seed = seed;
  return options;
}

inline bool has_jump_finding(const Jump& jump, const std::string& id) {
  return std::any_of(jump.findings.begin(), jump.findings.end(), [&](const Finding& one) {
    return one.id == id;
  });
}

/// A tip leaves at once, with the body's speed: 0.6 of it is reached within 10 ms and a
/// frame. A foot counts as landed when its tip is within 15 mm of the floor (of an
/// adult), which takes 15 mm divided by the speed.
inline void expect_jump_times(const Jump& jump,
                              const MadeFlightTruth& truth,
                              const MadeJumpOptions& options,
                              double noise_s,
                              const std::string& what) {
  const double frame_s = 1.0 / options.rate_hz;
  const double size = options.stature_m / 1.75;
  EXPECT_NEAR(jump.takeoff.time_s, truth.takeoff_s, 0.010 + frame_s + noise_s) << what;
  ASSERT_TRUE(jump.touchdown) << what;
  const double early_s = 0.015 * size / std::abs(truth.landing_m_s.y);
  EXPECT_GT(jump.touchdown->time_s, truth.landing_s - early_s - 0.003 - frame_s - noise_s)
      << what;
  EXPECT_LT(jump.touchdown->time_s, truth.landing_s + 0.003 + frame_s + noise_s) << what;
}

/// Changes the centre of mass and all sole points.
inline void for_each_track_point(BodyTrack& track, const auto& change) {
  for (glm::dvec3& p : track.com_in_world) p = change(p);
  for (SoleTrack& sole : track.soles) {
    for (auto* points : {&sole.heel_in_world, &sole.ball_in_world, &sole.tip_in_world}) {
      for (glm::dvec3& p : *points) p = change(p);
    }
  }
}

}  // namespace marey::dynamics
