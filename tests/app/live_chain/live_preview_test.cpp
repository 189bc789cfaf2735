// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/human/centre_of_mass.h"
#include "core/humanoid.h"
#include "retarget/body/place_masses.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/app/live_chain/preview_scene.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/simulation/synthetic_walk.h"
#include "tests/support/truth/zmp_judge.h"

namespace marey::app {
namespace {

TEST_F(PreviewOfAPerson, IsDelayedByFourFifthsOfASecond) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const std::array<const Skeleton*, 1> bodies{&skeleton};
  for (const double hz : {10.0, 25.0, 29.97, 30.0, 60.0, 120.0, 240.0}) {
    auto preview = LivePreview::make(bodies, FrameRate{hz});
    ASSERT_TRUE(preview);
    EXPECT_NEAR(static_cast<double>(preview->delay_frames()) / hz, 0.8, 0.5 / hz) << hz;
  }
  const Motion walk = testing::synthetic_walk(150, kPreviewRate_hz).motion;
  const auto shown = run(walk.skeleton, stream_of(walk));
  for (std::size_t t = 0; t < shown.size(); ++t) {
    const PreviewedFrame& frame = shown[t].frame;
    if (t < kPreviewDelay) {
      EXPECT_EQ(frame.track.state, TrackState::kWaiting) << t;
      EXPECT_TRUE(have_same_bits(frame.avatars[0], rest_pose(walk.skeleton))) << t;
      continue;
    }
    EXPECT_EQ(frame.track.state, TrackState::kTracked) << t;
    EXPECT_TRUE(have_same_bits(frame.performer, walk.poses[t - kPreviewDelay])) << t;
  }
}

TEST_F(PreviewOfAPerson, BringsTheZeroMomentPointNearerToTheFeet) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Judged before;
  Judged after;
  for (int seed = 0; seed < 100; ++seed) {
    const double turn = 3.14 * share(random);
    const glm::dvec3 axis(std::sin(turn), 0.0, std::cos(turn));
    const double angle_rad = 0.2 + 0.4 * share(random);
    const double hz = 0.2 + 0.4 * share(random);
    const Motion source = swaying(360, axis, angle_rad, hz);
    const Motion moved = balanced(source);
    Motion same = source;
    same.poses.resize(moved.poses.size());
    const Judged was = judge(same, same);
    const Judged is = judge(same, moved);
    EXPECT_LE(is.sum_outside_m, was.sum_outside_m + 1e-9) << seed;
    EXPECT_LE(is.outside, was.outside) << seed;
    before.outside += was.outside;
    before.sum_outside_m += was.sum_outside_m;
    after.outside += is.outside;
    after.sum_outside_m += is.sum_outside_m;
  }
  ASSERT_GT(before.outside, 3000);
  EXPECT_LT(after.outside, before.outside / 2);
  EXPECT_LT(after.sum_outside_m, 0.2 * before.sum_outside_m);
  RecordProperty("outside_before", before.outside);
  RecordProperty("outside_after", after.outside);
}

TEST_F(PreviewOfAPerson, HelpsAStepperToo) {
  for (const double noise : {0.0, 0.001}) {
    const Motion walk =
        testing::synthetic_walk(600, kPreviewRate_hz, 2.0 * noise, noise).motion;
    const Motion moved = balanced(walk);
    Motion same = walk;
    same.poses.resize(moved.poses.size());
    const Judged was = judge(same, same);
    const Judged is = judge(same, moved);
    EXPECT_LT(is.outside, was.outside) << noise;
    EXPECT_LT(is.sum_outside_m, 0.5 * was.sum_outside_m) << noise;
  }
}

TEST_F(PreviewOfAPerson, MovesTheCentreOfMassOverFeetThatStayWhereTheyStand) {
  const Motion walk = testing::synthetic_walk(300, kPreviewRate_hz).motion;
  for (const Motion& source : {walk, swaying(300, glm::dvec3(1.0, 0.0, 0.0), 0.5, 0.5)}) {
    double largest_shift_m = 0.0;
    int standing = 0;
    for (const Shown& shown : run(source.skeleton, stream_of(source))) {
      if (shown.frame.track.state == TrackState::kWaiting) continue;
      const Pose& from = shown.frame.performer;
      const Pose& to = shown.frame.avatars[0];
      EXPECT_TRUE(have_same_bits(to, shown.frame.balanced_performer));
      for (std::size_t side = 0; side < 2; ++side) {
        const retarget::StandingFoot& foot = shown.frame.standing[side];
        if (!foot.heel && !foot.ball) continue;
        ++standing;
        EXPECT_LT(glm::distance(ankle_of(source.skeleton, from, side),
                                ankle_of(source.skeleton, to, side)),
                  1e-6);
      }
      const glm::dvec3 way =
          centre_of(source.skeleton, to) - centre_of(source.skeleton, from);
      // Legs that are nearly straight let the body sink.
      EXPECT_LT(std::abs(way.y), 0.03);
      EXPECT_LT(glm::distance(glm::dvec2(way.x, way.z), shown.shift_xz_m), 0.03);
      largest_shift_m = std::max(largest_shift_m, glm::length(shown.shift_xz_m));
    }
    EXPECT_GT(largest_shift_m, 0.01);
    EXPECT_LT(largest_shift_m, 0.15);
    EXPECT_GT(standing, 200);
  }
}

TEST_F(PreviewOfAPerson, LeavesABalancedPersonAsItIs) {
  const Motion calm = swaying(200, glm::dvec3(1.0, 0.0, 0.0), 0.05, 0.3);
  for (const Shown& shown : run(calm.skeleton, stream_of(calm))) {
    EXPECT_EQ(shown.shift_xz_m, glm::dvec2(0.0));
    EXPECT_TRUE(have_same_bits(shown.frame.avatars[0], shown.frame.performer));
  }
}

/// Largest second difference of the displacement, as an acceleration, after the first
/// shown frame.
double worst_bend_m_s2(const std::vector<glm::dvec2>& shifts) {
  double worst_m = 0.0;
  for (std::size_t t = 2; t < shifts.size(); ++t) {
    worst_m =
        std::max(worst_m, glm::length(shifts[t] - 2.0 * shifts[t - 1] + shifts[t - 2]));
  }
  return worst_m * kPreviewRate_hz * kPreviewRate_hz;
}

TEST_F(PreviewOfAPerson, FadesOutWhileTheBodyIsLostAndDoesNotJump) {
  std::mt19937 random(5);
  for (int seed = 0; seed < 20; ++seed) {
    Motion source = swaying(600, glm::dvec3(1.0, 0.0, 0.0), 0.5, 0.45);
    std::vector<Sent> sent = stream_of(source);
    // Lost for two seconds, and elsewhere afterwards.
    const std::size_t lost =
        150 + std::uniform_int_distribution<std::size_t>(0, 100)(random);
    for (std::size_t t = lost; t < lost + 120; ++t) {
      sent[t].track = kUnseen;
      sent[t].pose = sent[lost - 1].pose;
    }
    for (std::size_t t = lost + 120; t < sent.size(); ++t) {
      sent[t].pose.root_in_world += glm::dvec3(1.0, 0.0, -2.0);
    }
    std::vector<glm::dvec2> shifts;
    const auto shown = run(source.skeleton, sent);
    for (std::size_t t = kPreviewDelay; t < shown.size(); ++t) {
      const std::size_t from = t - kPreviewDelay;
      EXPECT_EQ(shown[t].frame.track.state, sent[from].track.state);
      EXPECT_TRUE(have_same_bits(shown[t].frame.performer, sent[from].pose));
      shifts.push_back(shown[t].shift_xz_m);
    }
    EXPECT_LT(worst_bend_m_s2(shifts), 8.0) << seed;
    for (const glm::dvec2& shift : shifts) EXPECT_LT(glm::length(shift), 0.15) << seed;
    // The control settles within a second; it is at rest before the body is back.
    EXPECT_LT(glm::length(shifts[lost + 70]), 0.01) << seed;
  }
}

}  // namespace
}  // namespace marey::app
