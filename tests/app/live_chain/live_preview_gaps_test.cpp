// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
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

#include "app/live_chain/live_preview.h"
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

TEST_F(PreviewOfAPerson, KeepsItsDelayInGaps) {
  // A person who glides: interpolated frames are known exactly.
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const auto at = [&](std::int64_t number) {
    Pose pose = rest_pose(skeleton);
    pose.root_in_world.x += 0.01 * static_cast<double>(number);
    return pose;
  };
  LivePreview preview = preview_of(skeleton);
  std::int64_t number = 0;
  std::mt19937 random(3);
  const std::array<std::int64_t, 8> gaps{1, 2, 1, 5, 30, 1, 47, 100};
  for (int i = 0; i < 400; ++i) {
    step(preview, {number, kSeen, at(number)});
    const PreviewedFrame& frame = preview.frame();
    if (number >= kPreviewDelay) {
      EXPECT_EQ(frame.track.state, TrackState::kTracked);
      EXPECT_NEAR(frame.performer.root_in_world.x,
                  at(number - kPreviewDelay).root_in_world.x,
                  1e-9)
          << number;
    }
    number += gaps[std::uniform_int_distribution<std::size_t>(0, 7)(random)];
  }
  // A pause of an hour costs no more than one of some seconds.
  number += 3600 * 60;
  step(preview, {number, kSeen, at(number)});
  EXPECT_NEAR(preview.frame().performer.root_in_world.x,
              at(number - kPreviewDelay).root_in_world.x,
              1e-6);
}

TEST_F(PreviewOfAPerson, HoldsThePoseOfABodyThatWasLostInAGap) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const Pose here = rest_pose(skeleton);
  Pose there = here;
  there.root_in_world.x += 2.0;
  LivePreview preview = preview_of(skeleton);
  std::int64_t number = 0;
  for (; number < 60; ++number) step(preview, {number, kSeen, here});
  step(preview, {number, kUnseen, here});
  number += 20;
  for (int i = 0; i < 100; ++i, ++number) {
    step(preview, {number, kSeen, there});
    const PreviewedFrame& frame = preview.frame();
    const std::int64_t from = number - kPreviewDelay;
    const bool is_back = from >= 80;
    EXPECT_EQ(frame.performer.root_in_world.x, (is_back ? there : here).root_in_world.x);
    const bool is_lost = from >= 60 && !is_back;
    EXPECT_EQ(frame.track.state, is_lost ? TrackState::kLost : TrackState::kTracked);
  }
}

TEST_F(PreviewOfAPerson, GapsDoNotMoveTheBodyByJumps) {
  const Motion source = swaying(900, glm::dvec3(1.0, 0.0, 0.0), 0.5, 0.45);
  LivePreview whole = preview_of(source.skeleton);
  LivePreview gappy = preview_of(source.skeleton);
  std::mt19937 random(11);
  double worst_m = 0.0;
  int next = 0;
  for (int t = 0; t < 900; ++t) {
    const Sent sent{t, kSeen, source.poses[static_cast<std::size_t>(t)]};
    step(whole, sent);
    if (t != next) continue;
    // Up to three frames are missing.
    next += 1 + std::uniform_int_distribution<int>(0, 3)(random);
    step(gappy, sent);
    worst_m = std::max(worst_m, glm::distance(whole.shift_xz_m(1), gappy.shift_xz_m(1)));
  }
  EXPECT_LT(worst_m, 0.01);
}

TEST_F(PreviewOfAPerson, GivesTheSameBitsAgain) {
  const Motion walk = testing::synthetic_walk(300, kPreviewRate_hz, 0.002, 0.001).motion;
  const std::vector<Sent> sent = stream_of(walk);
  const auto once = run(walk.skeleton, sent);
  // Two others in turn, one of which is moved to another place meanwhile.
  LivePreview a = preview_of(walk.skeleton);
  std::optional<LivePreview> b = preview_of(walk.skeleton);
  for (std::size_t t = 0; t < sent.size(); ++t) {
    step(a, sent[t]);
    if (t % 50 == 20) {
      LivePreview elsewhere = *std::move(b);
      b.emplace(std::move(elsewhere));
    }
    step(*b, sent[t]);
    EXPECT_TRUE(have_same_bits(a.frame().avatars[0], once[t].frame.avatars[0])) << t;
    EXPECT_TRUE(have_same_bits(b->frame().avatars[0], once[t].frame.avatars[0])) << t;
    EXPECT_EQ(a.shift_xz_m(0), once[t].shift_xz_m) << t;
  }
}

TEST_F(PreviewOfAPerson, AllocatesNothingAfterTheFirstSecond) {
  const Motion walk = testing::synthetic_walk(300, kPreviewRate_hz, 0.002, 0.001).motion;
  LivePreview preview = preview_of(walk.skeleton);
  std::vector<Sent> sent = stream_of(walk);
  for (std::size_t t = 200; t < 220; ++t) sent[t].track = kUnseen;
  for (std::size_t t = 0; t < 60; ++t) step(preview, sent[t]);
  const long before = testing::allocations();
  for (std::size_t t = 60; t < sent.size(); ++t) {
    if (t % 40 > 30) continue;
    step(preview, sent[t]);
  }
  EXPECT_EQ(testing::allocations(), before);
}

TEST_F(PreviewOfAPerson, OnlyDelaysABodyThatIsNotHuman) {
  Skeleton box;
  box.joints.push_back({});
  LivePreview preview = preview_of(box);
  for (int t = 0; t < 100; ++t) {
    Pose pose = rest_pose(box);
    pose.root_in_world.x = t;
    step(preview, {t, kSeen, pose});
    if (t < kPreviewDelay) continue;
    EXPECT_EQ(preview.frame().avatars[0].root_in_world.x, t - kPreviewDelay);
  }
}

TEST(LivePreview, RefusesRatesThatLeaveTooFewOrTooManyFrames) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const std::array<const Skeleton*, 1> bodies{&skeleton};
  for (const double hz : {0.0, 0.1, 9.9, 501.0, 1e4, -30.0, std::nan("")}) {
    const auto made = LivePreview::make(bodies, FrameRate{hz});
    ASSERT_FALSE(made) << hz;
    EXPECT_EQ(made.error().code, Errc::kBadInput);
    EXPECT_EQ(made.error().where, "--balance preview");
  }
}

TEST(WantedZmpShift, TakesAPointIntoTheArea) {
  const std::vector<glm::dvec2> area{
      {-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.15}, {-0.1, 0.15}};
  EXPECT_EQ(wanted_zmp_shift_m(area, {0.0, 0.0}), glm::dvec2(0.0));
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-0.25, 0.25);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 p(place(random), place(random));
    const glm::dvec2 shift = wanted_zmp_shift_m(area, p);
    EXPECT_LE(glm::length(shift), 0.15 + 1e-12);
    const auto is_inside = [](const glm::dvec2& q) {
      return std::abs(q.x) <= 0.1 && q.y >= -0.1 && q.y <= 0.15;
    };
    const bool is_near = p.x > -0.2 && p.x < 0.2 && p.y > -0.2 && p.y < 0.25;
    const bool is_enough = is_near && glm::length(shift) < 0.149;
    EXPECT_TRUE(!is_enough || is_inside(p + shift)) << i;
    // Near points have near displacements.
    const glm::dvec2 near = p + glm::dvec2(1e-5, -1e-5);
    EXPECT_LT(glm::distance(wanted_zmp_shift_m(area, near), shift), 1e-3) << i;
  }
  // An edge has no inside.
  EXPECT_EQ(wanted_zmp_shift_m({area.data(), 2}, {1.0, 1.0}), glm::dvec2(0.0));
  EXPECT_EQ(wanted_zmp_shift_m({}, {1.0, 1.0}), glm::dvec2(0.0));
}

}  // namespace
}  // namespace marey::app
