// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/adapt_to_ground.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/feet/plan_foot_path.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

// A body that stands still for `frames`, its root raised by `raise_m`.
struct Standing {
  Skeleton body = testing::long_legs();
  BodyMap map = *map_body(body);
  std::vector<NormalizedPose> poses;
  Contacts contacts;

  Standing(int frames, double raise_m) {
    Pose pose = rest_pose(body);
    pose.root_in_world.y += raise_m;
    poses.assign(static_cast<std::size_t>(frames), normalize(body, map, pose));
    contacts.frame_count = frames;
  }
  void bear(int side, int first, int last) {
    FootContacts& foot = contacts.feet[static_cast<std::size_t>(side)];
    foot.heel = foot.ball = foot.stance = {{first, last}};
  }
  GroundReport adapt(const GroundOptions& options = {}) {
    return adapt_to_ground(body, map, contacts, {60.0}, poses, options);
  }
  [[nodiscard]] double root_m(std::size_t t) const {
    return poses[t].root.y * map.leg_length_m;
  }
  [[nodiscard]] glm::dvec3 ankle(std::size_t t, int side) const {
    const auto frames = world_from_joints(body, expand(poses[t], body, map));
    return frames[index(map.leg(side).end)].translation;
  }
};

TEST(AdaptToGround, LeavesTheRootOfAFlyingBodyAlone) {
  Standing s(30, 0.7);
  const double before_m = s.root_m(15);
  s.adapt();
  EXPECT_EQ(s.root_m(15), before_m);
}

TEST(AdaptToGround, LowersTheRootUntilTheLegReaches) {
  Standing s(60, 0.10);
  const double before_m = s.root_m(30);
  s.bear(0, 20, 40);
  const GroundReport report = s.adapt();
  // The leg is straight at rest, so the root sinks by the height by which it was raised.
  EXPECT_NEAR(before_m - s.root_m(30), 0.10, 1e-3);
  EXPECT_NEAR(s.ankle(30, 0).y, s.map.feet[0].ankle_height_m, 1e-9);
  EXPECT_EQ(report.unreachable_frames, 0);
}

TEST(AdaptToGround, TakesTheHigherFootForNothing) {
  Standing s(60, 0.10);
  s.bear(0, 20, 40);
  const double swing_before_m = s.ankle(30, 1).y;
  s.adapt();
  EXPECT_GT(s.ankle(30, 1).y, swing_before_m - 1e-3);
}

TEST(AdaptToGround, BeginsToSinkBeforeTheFootBears) {
  Standing s(60, 0.10);
  const double before_m = s.root_m(0);
  s.bear(0, 20, 40);
  s.adapt();
  EXPECT_LT(s.root_m(17), before_m - 0.01);
  EXPECT_EQ(s.root_m(5), before_m);
}

TEST(AdaptToGround, SinksSmoothly) {
  Standing s(60, 0.10);
  s.bear(0, 20, 40);
  s.adapt();
  for (std::size_t t = 1; t + 1 < 60; ++t) {
    // 10 cm within 0.2 s and back to rest takes at least 4 * 0.1 / 0.2^2 = 10 m/s^2.
    const double acceleration =
        (s.root_m(t - 1) - 2 * s.root_m(t) + s.root_m(t + 1)) * 3600.0;
    EXPECT_LT(std::abs(acceleration), 30.0) << t;
  }
}

// The window is limited to the motion; otherwise this would take an hour, or overflow.
TEST(AdaptToGround, MayLookFurtherThanTheMotionGoes) {
  Standing s(30, 0.10);
  const double before_m = s.root_m(0);
  s.bear(0, 20, 25);
  GroundOptions options;
  options.anticipation_s = 1e9;
  s.adapt(options);
  EXPECT_NEAR(before_m - s.root_m(0), 0.10, 1e-3);
  EXPECT_NEAR(before_m - s.root_m(29), 0.10, 1e-3);
}

TEST(AdaptToGround, CountsFramesInWhichALegCannotReach) {
  Standing s(30, 0.0);
  // The right footprint is the mean of two places three metres apart.
  for (std::size_t t = 15; t < 30; ++t) s.poses[t].root.x += 3.0 / s.map.leg_length_m;
  s.bear(1, 0, 29);
  EXPECT_EQ(s.adapt().unreachable_frames, 30);
}

TEST(AdaptToGround, KeepsBothFeetOnAFloorThatTheSourceSinksInto) {
  Standing s(30, -0.08);
  s.adapt();  // No contacts: only the floor itself.
  EXPECT_GE(s.ankle(15, 0).y, s.map.feet[0].ankle_height_m - 1e-9);
}

// A foot that swings between two stances in a straight line at constant speed.
struct Swing {
  FootMap foot{0.08, 0.02, {0, -0.06, 0.13}, true};
  std::vector<FootPlace> reference{90};
  FootContacts contacts;

  Swing() {
    for (std::size_t t = 0; t < 90; ++t) {
      const double s = std::clamp((static_cast<double>(t) - 30.0) / 29.0, 0.0, 1.0);
      const double eased = s * s * s * (10 + s * (6 * s - 15));
      // The stances slide, differently, and float.
      const double slide = 0.0003 * static_cast<double>(t);
      reference[t].ankle_in_world = {
          slide, 0.09 + 0.1 * eased * (1 - eased), eased + slide};
      reference[t].foot = glm::angleAxis(0.05, glm::dvec3(0, 0, 1));
    }
    contacts.heel = contacts.ball = contacts.stance = {{0, 29}, {60, 89}};
  }
  [[nodiscard]] std::vector<FootPlace> plan() const {
    return plan_foot_path(reference, contacts, foot, 0.85, {60.0});
  }
};

TEST(PlanFoot, HoldsAFootStillAndFlatWhileItStands) {
  const auto plan = Swing().plan();
  for (std::size_t t = 1; t < 30; ++t) {
    EXPECT_EQ(plan[t].ankle_in_world, plan[0].ankle_in_world);
    EXPECT_LT(glm::distance(plan[t].foot * glm::dvec3(0, 1, 0), glm::dvec3(0, 1, 0)),
              1e-12);
  }
}

TEST(PlanFoot, PutsTheFootprintWhereTheReferenceStandsOnAverage) {
  const Swing swing;
  glm::dvec3 mean(0.0);
  for (std::size_t t = 0; t < 30; ++t) mean += swing.reference[t].ankle_in_world / 30.0;
  const glm::dvec3 print = swing.plan()[10].ankle_in_world;
  EXPECT_LT(glm::distance(print, glm::dvec3(mean.x, 0.08, mean.z)), 1e-12);
}

// Neither position nor speed jumps where the contact ends and begins.
TEST(PlanFoot, BlendsOutOfAndIntoContactWithoutAJump) {
  const Swing swing;
  const auto plan = swing.plan();
  const auto acceleration = [](const std::vector<FootPlace>& p, std::size_t t) {
    return glm::length(p[t - 1].ankle_in_world - 2.0 * p[t].ankle_in_world +
                       p[t + 1].ankle_in_world) *
           3600.0;
  };
  double reference = 0.0;
  double planned = 0.0;
  for (std::size_t t = 1; t + 1 < plan.size(); ++t) {
    reference = std::max(reference, acceleration(swing.reference, t));
    planned = std::max(planned, acceleration(plan, t));
  }
  EXPECT_LT(planned, 1.25 * reference);
}

// A reference that is moving when its contact ends is joined without a kink: its own
// 0.12 m/s, taken up within one frame at 60 Hz, would be 7.2 m/s^2.
TEST(PlanFoot, TakesUpTheSpeedOfTheReferenceGradually) {
  Swing swing;
  for (std::size_t t = 0; t < 90; ++t) {
    swing.reference[t].ankle_in_world.x += 0.002 * static_cast<double>(t);
  }
  const auto plan = swing.plan();
  for (const std::size_t t : {29U, 60U}) {
    const glm::dvec3 step_change = plan[t - 1].ankle_in_world -
                                   2.0 * plan[t].ankle_in_world +
                                   plan[t + 1].ankle_in_world;
    EXPECT_LT(std::abs(step_change.x) * 3600.0, 1.5);
  }
}

// Standing on the ball, the foot turns about it and the ball does not move.
TEST(PlanFoot, TurnsAFootAboutTheJointThatBears) {
  Swing swing;
  for (std::size_t t = 20; t < 30; ++t) {
    swing.reference[t].foot =
        glm::angleAxis(0.04 * static_cast<double>(t - 19), glm::dvec3(1, 0, 0));
  }
  swing.contacts.heel = {{0, 19}, {60, 89}};
  const auto plan = swing.plan();
  const auto ball = [&](std::size_t t) {
    return plan[t].ankle_in_world + plan[t].foot * swing.foot.ball_from_ankle_in_t_pose;
  };
  for (std::size_t t = 1; t < 30; ++t) EXPECT_LT(glm::distance(ball(t), ball(0)), 1e-12);
  EXPECT_GT(plan[29].ankle_in_world.y, plan[0].ankle_in_world.y + 0.02);
}

TEST(PlanFoot, LeavesAFootThatNeverBearsToItsReference) {
  Swing swing;
  swing.contacts = {};
  for (FootPlace& place : swing.reference) place.ankle_in_world.y += 1.0;
  const auto plan = swing.plan();
  for (std::size_t t = 0; t < plan.size(); ++t) {
    EXPECT_LT(glm::distance(plan[t].ankle_in_world, swing.reference[t].ankle_in_world),
              1e-4);
  }
}

}  // namespace
}  // namespace marey::retarget
