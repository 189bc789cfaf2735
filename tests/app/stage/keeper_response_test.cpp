// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/keeper_response.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace marey::app {
namespace {

/// Share of a way at a time, along a path of least jerk from `start_s` on.
double way_share(double time_s, double start_s, double duration_s) {
  const double u = std::clamp((time_s - start_s) / duration_s, 0.0, 1.0);
  return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
}

/// Time at which the speed of that path is 5 % of its largest: u (1 - u) = sqrt(0.05)
/// / 4.
double movement_truth_s(double start_s, double duration_s) {
  const double product = std::sqrt(0.05) / 4.0;
  return start_s + duration_s * (0.5 - std::sqrt(0.25 - product));
}

struct MadeKeeper {
  KeeperTrack track;
  double hand_starts_s = 0.0;
  double hips_start_s = 0.0;
};

MadeKeeper made_keeper(std::uint64_t seed, double rate_hz) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> delay(0.2, 0.5);
  MadeKeeper keeper;
  keeper.hand_starts_s = 10.0 + delay(random);
  keeper.hips_start_s = 10.0 + delay(random);
  const int fast = static_cast<int>(seed % 2);
  for (int i = 0; i <= static_cast<int>(3.0 * rate_hz); ++i) {
    const double time_s = 9.0 + i / rate_hz;
    const double hand = way_share(time_s, keeper.hand_starts_s, 0.5);
    const double hips = way_share(time_s, keeper.hips_start_s, 0.6);
    keeper.track.times_s.push_back(time_s);
    keeper.track.hips_in_world.push_back({0.4 * hips, 1.0, 0.0});
    for (int side = 0; side < 2; ++side) {
      const double way_m = (side == fast ? 0.9 : 0.2) * hand;
      keeper.track.wrists_in_world[static_cast<std::size_t>(side)].push_back(
          {side == 0 ? 0.3 : -0.3, 1.0 + way_m, 0.2});
    }
  }
  return keeper;
}

TEST(KeeperResponse, FirstMovementsAreFoundWithinAFrame) {
  for (const double rate_hz : {30.0, 120.0, 240.0}) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const MadeKeeper keeper = made_keeper(seed, rate_hz);
      const auto response = keeper_response(keeper.track, 9.5, 11.2);
      ASSERT_TRUE(response);
      EXPECT_EQ(response->hand, static_cast<int>(seed % 2));
      ASSERT_TRUE(response->hand_moves_s && response->hips_move_s);
      EXPECT_NEAR(*response->hand_moves_s,
                  movement_truth_s(keeper.hand_starts_s, 0.5),
                  0.6 / rate_hz);
      EXPECT_NEAR(*response->hips_move_s,
                  movement_truth_s(keeper.hips_start_s, 0.6),
                  0.6 / rate_hz);
      EXPECT_NEAR(response->hand_at_arrival_in_world.y, 1.9, 1e-9);
    }
  }
}

TEST(KeeperResponse, TheHandAtTheArrivalIsInterpolated) {
  MadeKeeper keeper = made_keeper(1, 50.0);
  for (std::size_t i = 0; i < keeper.track.times_s.size(); ++i) {
    keeper.track.wrists_in_world[1][i] = {2.0 * keeper.track.times_s[i], 1.0, 0.0};
  }
  const auto response = keeper_response(keeper.track, 9.5, 10.513);
  ASSERT_TRUE(response);
  EXPECT_EQ(response->hand, 1);
  EXPECT_FALSE(response->hand_moves_s);  // It moved before.
  EXPECT_NEAR(response->hand_at_arrival_in_world.x, 2.0 * 10.513, 1e-9);
}

TEST(KeeperResponse, ARecordingThatEndsBeforeTheArrivalHasNone) {
  const MadeKeeper keeper = made_keeper(3, 60.0);
  EXPECT_FALSE(keeper_response(keeper.track, 9.5, 12.5));
  EXPECT_FALSE(keeper_response(keeper.track, 7.5, 8.5));
  EXPECT_FALSE(keeper_response(KeeperTrack{}, 9.5, 11.0));
}

TEST(KeeperResponse, AStillPointHasNoMovement) {
  const std::vector<double> times_s{0.0, 0.1, 0.2, 0.3};
  const std::vector<glm::dvec3> still(4, glm::dvec3(1.0));
  EXPECT_FALSE(movement_start(times_s, still, 0.0, 1.0));
  EXPECT_FALSE(movement_start({}, {}, 0.0, 1.0));
}

}  // namespace
}  // namespace marey::app
