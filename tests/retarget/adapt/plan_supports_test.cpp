// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/plan_supports.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/frame_range.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/retarget/mapped.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

constexpr int kSupportFrames = 240;
constexpr double kSupportRate_hz = 60.0;

struct SupportScene {
  testing::SyntheticWalk walk = testing::synthetic_walk(kSupportFrames, kSupportRate_hz);
  BodyMap map = mapped(walk.motion.skeleton);
  Contacts contacts = detect_contacts(walk.motion, map);

  [[nodiscard]] std::vector<SupportTrack> plan(
      const PlanSupportsOptions& options = {}) const {
    return plan_supports(walk.motion, map, contacts, options);
  }
};

const SupportTrack* find(const std::vector<SupportTrack>& tracks, const std::string& id) {
  for (const SupportTrack& track : tracks) {
    if (track.constraint.id == id) return &track;
  }
  return nullptr;
}

bool bears(const SupportTrack& track, int frame) {
  return std::any_of(track.bears.begin(), track.bears.end(), [=](FrameRange run) {
    return run.first <= frame && frame <= run.last;
  });
}

// The walk stands flat, then on the ball; never on the heel alone.
TEST(PlanSupports, FindsFlatFeetAndFeetOnTheirBall) {
  const SupportScene scene;
  const auto tracks = scene.plan();
  ASSERT_EQ(tracks.size(), 5U);  // The right foot begins on its ball.
  for (const auto& [side, segment] :
       {std::pair(std::size_t{0}, "leftFoot"), std::pair(std::size_t{1}, "rightFoot")}) {
    const SupportTrack* flat = find(tracks, std::string("found ") + segment + " flat");
    const SupportTrack* ball =
        find(tracks, std::string("found ") + segment + " ball after flat");
    ASSERT_TRUE(flat && ball);
    EXPECT_FALSE(std::get<Support>(flat->constraint.goal).turns);
    EXPECT_TRUE(std::get<Support>(ball->constraint.goal).turns);
    const testing::SyntheticWalk::Foot& truth = scene.walk.feet[side];
    int wrong = 0;
    int edges = 1;
    for (int t = 0; t < kSupportFrames; ++t) {
      const auto i = static_cast<std::size_t>(t);
      const bool is_flat = truth.heel[i] && truth.ball[i];
      if (bears(*flat, t) != is_flat) ++wrong;
      if ((bears(*flat, t) || bears(*ball, t)) != (truth.ball[i] != 0)) ++wrong;
      if (i > 0) edges += truth.heel[i] != truth.heel[i - 1];
      if (i > 0) edges += truth.ball[i] != truth.ball[i - 1];
    }
    // Contacts of a slow ankle end up to three frames late (detect_contacts_test.cpp).
    EXPECT_LE(wrong, 3 * edges);
  }
}

TEST(PlanSupports, PointsAreStillWhileTheyBearAndSmoothElsewhere) {
  const SupportScene scene;
  for (const SupportTrack& track : scene.plan()) {
    ASSERT_EQ(track.p_in_world.size(), static_cast<std::size_t>(kSupportFrames));
    for (const FrameRange& run : track.bears) {
      for (int t = run.first; t <= run.last; ++t) {
        const glm::dvec3 away = track.p_in_world[static_cast<std::size_t>(t)] -
                                track.p_in_world[static_cast<std::size_t>(run.first)];
        EXPECT_LT(glm::length(away), 1e-9) << track.constraint.id << " at " << t;
      }
    }
    // A swing of 1 m in 0.44 s accelerates by 5.77 * 1 / 0.44^2 = 30 m/s2 (maximum of a
    // quintic), a footprint some millimetres off and the lift of the foot by as much
    // again.
    for (std::size_t t = 1; t + 1 < track.p_in_world.size(); ++t) {
      const glm::dvec3 bend =
          track.p_in_world[t + 1] - 2.0 * track.p_in_world[t] + track.p_in_world[t - 1];
      EXPECT_LT(glm::length(bend) * kSupportRate_hz * kSupportRate_hz, 60.0)
          << track.constraint.id << " at " << t;
    }
  }
}

// They are started by the caller that drives them.
TEST(PlanSupports, DoNotBeginByThemselves) {
  const SupportScene scene;
  for (const SupportTrack& track : scene.plan({.ramp_s = 0.1})) {
    const Activation& when = track.constraint.activation;
    ASSERT_TRUE(when.start_s);
    EXPECT_GT(*when.start_s, 1e6);
    // The transition from the flat foot to the ball has no fade.
    const bool follows = track.constraint.id.find("after flat") != std::string::npos;
    EXPECT_DOUBLE_EQ(when.start_duration_s, follows ? 0.0 : 0.1);
    EXPECT_DOUBLE_EQ(when.stop_duration_s, 0.1);
  }
}

// The walk's flat stances are 0.64 s apart.
TEST(PlanSupports, RunsWithoutRoomForTheirRampsAreOne) {
  const SupportScene scene;
  const auto apart = scene.plan({.ramp_s = 0.2});
  const auto joined = scene.plan({.ramp_s = 0.5});
  EXPECT_GE(find(apart, "found leftFoot flat")->bears.size(), 3U);
  EXPECT_EQ(find(joined, "found leftFoot flat")->bears.size(), 1U);
}

TEST(PlanSupports, StandOnTheFloorAndOnTheFeetThatAreWanted) {
  SupportScene scene;
  const auto low = scene.plan();
  for (Pose& pose : scene.walk.motion.poses) pose.root_in_world.y += 1.5;
  for (FootContacts& foot : scene.contacts.feet) {
    foot.ankle_height_m += 1.5;
    foot.ball_height_m += 1.5;
  }
  PlanSupportsOptions options;
  options.floor_height_m = 1.5;
  options.feet = {false, true};
  const auto high = scene.plan(options);
  ASSERT_EQ(high.size(), 3U);
  for (const SupportTrack& track : high) {
    EXPECT_EQ(track.constraint.point.segment, "rightFoot");
    const SupportTrack* same = find(low, track.constraint.id);
    ASSERT_NE(same, nullptr);
    for (std::size_t t = 0; t < kSupportFrames; t += 7) {
      EXPECT_NEAR(track.p_in_world[t].y, same->p_in_world[t].y + 1.5, 1e-9);
    }
  }
}

}  // namespace
}  // namespace marey::retarget
