// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/balance/keep_balance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/frame_range.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "retarget/body/place_masses.h"
#include "retarget/contacts/measure_contacts.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/balance_scenes.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

RetargetedMotion put_on(const Motion& source,
                        const Skeleton& avatar,
                        const std::optional<BalanceOptions>& balance) {
  RetargetOptions options;
  options.balance = balance;
  auto out = retarget_motion(source, avatar, options);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return *std::move(out);
}

// Returns the maximum distance of a joint between the two motions. [m]
double apart_m(const Motion& a, const Motion& b) {
  double maximum = 0.0;
  for (std::size_t t = 0; t < a.poses.size(); ++t) {
    const auto p = world_from_joints(a.skeleton, a.poses[t]);
    const auto q = world_from_joints(b.skeleton, b.poses[t]);
    for (std::size_t j = 0; j < p.size(); ++j) {
      maximum = std::max(maximum, glm::length(p[j].translation - q[j].translation));
    }
  }
  return maximum;
}

BalanceTrack track_of(const Motion& motion,
                      const MassSpec& masses,
                      const Contacts& contacts) {
  const BodyMap map = *map_body(motion.skeleton);
  return track_balance(
      motion, map, *place_masses(motion.skeleton, map, masses), contacts);
}

// Returns the distance of the centre of mass ahead of the left ankle, in lengths of its
// foot from ankle to ball, while the posture is held.
double ahead_of_ankle(const Motion& motion, const MassSpec& masses, int frame) {
  const BodyMap map = *map_body(motion.skeleton);
  const auto world =
      world_from_joints(motion.skeleton, motion.poses[static_cast<std::size_t>(frame)]);
  const auto spec = *place_masses(motion.skeleton, map, masses);
  glm::dvec3 com(0.0);
  double kg = 0.0;
  for (const PointMass& mass : spec) {
    com += mass.mass_kg * (world[index(mass.joint)] * mass.p_in_joint);
    kg += mass.mass_kg;
  }
  return (com.z / kg - world[index(map.leg(0).end)].translation.z) /
         map.feet[0].ball_from_ankle_in_t_pose.z;
}

TEST(TrackBalance, KnowsHowFarAStandingBodyIsFromTheEdgeOfItsFeet) {
  Motion motion{make_humanoid(average_proportions(1.75)), {60.0}, 0, {}};
  const BodyMap map = *map_body(motion.skeleton);
  motion.poses.push_back(rest_pose(motion.skeleton));
  Contacts contacts;
  contacts.frame_count = 1;
  for (FootContacts& foot : contacts.feet) {
    foot.heel = foot.ball = foot.stance = {{0, 0}};
  }
  const std::vector<PointMass> far{{JointIndex{0}, {0.0, 0.0, 1.0}, 1.0}};
  const BalanceTrack track = track_balance(motion, map, far, contacts);
  // From the front of the soles to a mass one metre ahead of the hips.
  const FootMap& foot = map.feet[0];
  const auto rest = world_from_joints(motion.skeleton, motion.poses[0]);
  const double front_m = rest[index(map.leg(0).end)].translation.z +
                         foot.ball_from_ankle_in_t_pose.z +
                         foot.tip_from_ball_in_t_pose.z;
  EXPECT_NEAR(*track[0], rest[0].translation.z + 1.0 - front_m, 1e-9);
  const std::vector<PointMass> middle{{map.leg(0).end, {0.0, 0.0, 0.02}, 1.0},
                                      {map.leg(1).end, {0.0, 0.0, 0.02}, 1.0}};
  const BalanceTrack over = track_balance(motion, map, middle, contacts);
  // The nearest edge is behind: the heels.
  EXPECT_NEAR(*over[0], foot.heel_from_ankle_in_t_pose.z - 0.02, 1e-9);
  contacts.feet[1] = {};
  EXPECT_GT(*track_balance(motion, map, middle, contacts)[0], 0.0) << "on one foot";
  contacts.feet[0] = {};
  EXPECT_FALSE(track_balance(motion, map, middle, contacts)[0]) << "in the air";
}

TEST(BalanceFrames, ReportTheCentreOfMassAndTheCornersOfTheSupport) {
  Motion motion{make_humanoid(average_proportions(1.75)), {60.0}, 0, {}};
  const BodyMap map = *map_body(motion.skeleton);
  motion.poses.push_back(rest_pose(motion.skeleton));
  Contacts contacts;
  contacts.frame_count = 1;
  contacts.feet[0].heel = contacts.feet[0].ball = contacts.feet[0].stance = {{0, 0}};
  const std::vector<PointMass> mass{{JointIndex{0}, {0.1, 0.2, 0.3}, 1.0}};
  const auto frames = balance_frames(motion, map, mass, contacts);
  ASSERT_EQ(frames.size(), 1U);
  const auto rest = world_from_joints(motion.skeleton, motion.poses[0]);
  EXPECT_LT(glm::length(frames[0].centre_of_mass_in_world - rest[0].translation -
                        glm::dvec3(0.1, 0.2, 0.3)),
            1e-12);
  // The left sole, from heel to tip.
  ASSERT_EQ(frames[0].support_xz_m.size(), 4U);
  const FootMap& foot = map.feet[0];
  const double ankle_z = rest[index(map.leg(0).end)].translation.z;
  const double heel_z = ankle_z + foot.heel_from_ankle_in_t_pose.z;
  const double tip_z =
      ankle_z + foot.ball_from_ankle_in_t_pose.z + foot.tip_from_ball_in_t_pose.z;
  for (const glm::dvec2& corner : frames[0].support_xz_m) {
    EXPECT_LT(std::min(std::abs(corner.y - heel_z), std::abs(corner.y - tip_z)), 1e-9);
    EXPECT_GT(corner.x, 0.0) << "the left foot";
  }
  contacts.feet[0] = {};
  EXPECT_TRUE(balance_frames(motion, map, mass, contacts)[0].support_xz_m.empty());
}

// One frame of a body in its rest pose, on both feet or on the left one.
BalanceTrack track_at_rest(const Skeleton& body,
                           const BodyMap& map,
                           const glm::dvec3& mass_in_world,
                           bool on_both) {
  Motion motion{body, {60.0}, 0, {rest_pose(body)}};
  Contacts contacts;
  contacts.frame_count = 1;
  for (int side = 0; side < (on_both ? 2 : 1); ++side) {
    FootContacts& foot = contacts.feet[static_cast<std::size_t>(side)];
    foot.heel = foot.ball = foot.stance = {{0, 0}};
  }
  const auto rest = world_from_joints(body, motion.poses[0]);
  const std::vector<PointMass> mass{
      {map.hips(), inverse(rest[index(map.hips())]) * mass_in_world, 1.0}};
  return track_balance(motion, map, mass, contacts);
}

// The toe joint straight below the ankle, no tip: soles of no length.
TEST(TrackBalance, MeasuresFromThePointThatASoleOfNoLengthIs) {
  Skeleton body = make_humanoid(average_proportions(1.75));
  for (const B bone : {B::kLeftToes, B::kRightToes}) {
    Joint& toes = body.joints[index(*body.find(bone))];
    toes.parent_from_joint.translation.x = 0.0;
    toes.parent_from_joint.translation.z = 0.0;
    toes.tip_in_joint.reset();
  }
  const BodyMap map = *map_body(body);
  ASSERT_LT(glm::length(glm::dvec2(map.feet[0].ball_from_ankle_in_t_pose.x,
                                   map.feet[0].ball_from_ankle_in_t_pose.z)),
            1e-12);
  const auto rest = world_from_joints(body, rest_pose(body));
  const glm::dvec3 ankle = rest[index(map.leg(0).end)].translation;
  const auto off_m = [&](const glm::dvec3& from_ankle, bool on_both) {
    return *track_at_rest(body, map, ankle + from_ankle, on_both)[0];
  };
  EXPECT_NEAR(off_m({0.3, 0.0, 0.4}, false), 0.5, 1e-9);
  EXPECT_NEAR(off_m({0.0, 0.0, 0.02}, false), 0.02, 1e-9);
  // Both: the line between them. Left is at +X.
  EXPECT_NEAR(off_m({-0.05, 0.0, 0.02}, true), 0.02, 1e-9);
  EXPECT_NEAR(off_m({0.05, 0.0, 0.0}, true), 0.05, 1e-9) << "on the line, beyond its end";
}

TEST(TrackBalance, EndsAFootWhereItsKnownSkinDoes) {
  const Skeleton body = make_humanoid(average_proportions(1.75));
  BodyMap map = *map_body(body);
  for (FootMap& foot : map.feet) foot.tip_from_ball_in_t_pose.z = 0.0;
  const FootMap& foot = map.feet[0];
  const auto rest = world_from_joints(body, rest_pose(body));
  const glm::dvec3 ankle = rest[index(map.leg(0).end)].translation;
  const glm::dvec3 ahead{0.0, 0.0, foot.ball_from_ankle_in_t_pose.z + 0.03};
  EXPECT_NEAR(*track_at_rest(body, map, ankle + ahead, false)[0], 0.03, 1e-9);
}

TEST(KeepBalance, LeavesABodyThatIsTheSourcesAsItIs) {
  for (const Motion& source : {slow_kick(),
                               deep_bend(),
                               testing::synthetic_walk(200, 60.0, 0.002, 0.001).motion}) {
    const auto without = put_on(source, source.skeleton, std::nullopt);
    const auto with = put_on(source, source.skeleton, BalanceOptions{});
    EXPECT_LT(apart_m(without.motion, with.motion), 1e-4);
    EXPECT_LT(with.report.balance->kept.max_shift_m, 1e-4);
  }
}

struct Case {
  const char* name;
  double trunk_length;
  double trunk_mass;
};

class HeavyTrunk : public ::testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(KeepBalance,
                         HeavyTrunk,
                         ::testing::Values(Case{"TwiceAsHeavy", 1.0, 2.0},
                                           Case{"TwiceAsLong", 2.0, 1.0},
                                           Case{"LongerAndHeavier", 1.6, 2.0}),
                         [](const auto& test) { return std::string(test.param.name); });

// The source is over its foot; the same posture of another body may not be.
TEST_P(HeavyTrunk, IsOverItsFootInAOneLegStanceAsTheSourceIs) {
  const Motion source = slow_kick();
  BalanceOptions balance;
  balance.avatar_masses = with_trunk_mass(GetParam().trunk_mass);
  const Skeleton avatar = with_trunk(GetParam().trunk_length);
  const auto without = put_on(source, avatar, std::nullopt);
  const auto with = put_on(source, avatar, balance);
  const Contacts& contacts = with.report.contacts;
  const auto own = put_on(source, source.skeleton, std::nullopt);
  const BalanceTrack before = track_of(without.motion, balance.avatar_masses, contacts);
  const BalanceTrack after = track_of(with.motion, balance.avatar_masses, contacts);
  const BalanceTrack of_source = track_of(own.motion, {}, contacts);
  double changed = 0.0;
  for (int t = kPostureFirst; t <= kPostureLast; ++t) {
    const auto i = static_cast<std::size_t>(t);
    ASSERT_LT(*of_source[i], 0.0);
    EXPECT_LT(*after[i], 0.0) << t;
    EXPECT_NEAR(ahead_of_ankle(with.motion, balance.avatar_masses, t),
                ahead_of_ankle(own.motion, {}, t),
                0.01);
    changed = std::max(changed,
                       std::abs(ahead_of_ankle(without.motion, balance.avatar_masses, t) -
                                ahead_of_ankle(own.motion, {}, t)));
  }
  EXPECT_GT(changed, 0.1) << "retargeting alone keeps the balance";
  EXPECT_LE(with.report.balance->after.lost_frames,
            with.report.balance->before.lost_frames);
  EXPECT_EQ(with.report.ground.unreachable_frames, 0);
}

TEST_P(HeavyTrunk, BendsDownWithoutFallingOver) {
  const Motion source = deep_bend();
  BalanceOptions balance;
  balance.avatar_masses = with_trunk_mass(GetParam().trunk_mass);
  const auto with = put_on(source, with_trunk(GetParam().trunk_length), balance);
  const BalanceReport& report = *with.report.balance;
  EXPECT_EQ(report.source.over_frames, report.source.supported_frames);
  EXPECT_EQ(report.after.lost_frames, 0);
  EXPECT_GT(report.kept.mean_off_before_m, 0.005);
  EXPECT_LT(report.kept.mean_off_m, 1e-3);
}

TEST_P(HeavyTrunk, MovesNoFootThatStands) {
  for (const Motion& source :
       {slow_kick(), deep_bend(), testing::synthetic_walk(200, 60.0).motion}) {
    BalanceOptions balance;
    balance.avatar_masses = with_trunk_mass(GetParam().trunk_mass);
    const Skeleton avatar = with_trunk(GetParam().trunk_length);
    const auto without = put_on(source, avatar, std::nullopt);
    const auto with = put_on(source, avatar, balance);
    const BodyMap map = *map_body(avatar);
    const ContactPaths before = contact_paths(without.motion, map);
    const ContactPaths after = contact_paths(with.motion, map);
    for (std::size_t side = 0; side < 2; ++side) {
      for (const FrameRange& run : with.report.contacts.feet[side].stance) {
        for (int t = run.first; t <= run.last; ++t) {
          const auto i = static_cast<std::size_t>(t);
          EXPECT_LT(glm::length(before[side][i] - after[side][i]), 1e-9);
        }
      }
    }
  }
}

// Postures are reached and left within a second: a smooth path of s metres in T seconds
// has an acceleration of 5.8 s / T^2. Twice that, as a path may turn; a jump would be a
// hundred times as much.
TEST_P(HeavyTrunk, MovesItsRootWithoutAPop) {
  for (const Motion& source : {slow_kick(), deep_bend()}) {
    BalanceOptions balance;
    balance.avatar_masses = with_trunk_mass(GetParam().trunk_mass);
    const Skeleton avatar = with_trunk(GetParam().trunk_length);
    const Motion without = put_on(source, avatar, std::nullopt).motion;
    const auto with = put_on(source, avatar, balance);
    const auto added = [&](std::size_t t) {
      return with.motion.poses[t].root_in_world - without.poses[t].root_in_world;
    };
    double greatest = 0.0;
    for (std::size_t t = 1; t + 1 < source.poses.size(); ++t) {
      greatest =
          std::max(greatest, glm::length(added(t - 1) - 2.0 * added(t) + added(t + 1)));
    }
    const double hz = source.rate.hz;
    EXPECT_LT(greatest * hz * hz, 2.0 * 5.8 * with.report.balance->kept.max_shift_m);
  }
  const Motion walk = testing::synthetic_walk(200, 60.0).motion;
  const Skeleton avatar = with_trunk(GetParam().trunk_length);
  BalanceOptions balance;
  balance.avatar_masses = with_trunk_mass(GetParam().trunk_mass);
  EXPECT_LT(mean_jerk(put_on(walk, avatar, balance).motion),
            1.1 * mean_jerk(put_on(walk, avatar, std::nullopt).motion));
}

// Purpose of the option.
TEST(KeepBalance, SavesATwiceAsLongAndHeavyTrunkFromFalling) {
  BalanceOptions balance;
  balance.avatar_masses = with_trunk_mass(2.0);
  for (const Motion& source : {slow_kick(), deep_bend()}) {
    const auto out = put_on(source, with_trunk(2.0), balance);
    EXPECT_GT(out.report.balance->before.lost_frames, 60);
    EXPECT_EQ(out.report.balance->after.lost_frames, 0);
  }
}

TEST(KeepBalance, LeavesABodyThatNeverStandsAsItIs) {
  Motion source = slow_kick();
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    source.poses[t].root_in_world += glm::dvec3(0.0, 1.0, 0.05 * static_cast<double>(t));
  }
  const Skeleton avatar = with_trunk(1.5);
  const auto with = put_on(source, avatar, BalanceOptions{});
  EXPECT_EQ(with.report.balance->after.supported_frames, 0);
  EXPECT_EQ(apart_m(put_on(source, avatar, std::nullopt).motion, with.motion), 0.0);
}

TEST(KeepBalance, IsDeclinedWithoutTheGround) {
  RetargetOptions options;
  options.adapt_ground = false;
  options.balance.emplace();
  const auto out = retarget_motion(deep_bend(), testing::child(), options);
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().message().find("balance"), std::string::npos);
}

}  // namespace
}  // namespace marey::retarget
