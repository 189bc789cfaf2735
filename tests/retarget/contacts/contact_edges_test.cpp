// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/contact_edges.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/frame_range.h"
#include "core/base/quantile.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/contacts/frame_marks.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

// A rigid body stands, is pushed up at a constant acceleration, flies and lands on a hard
// floor. All times are known between frames.
struct Hop {
  Motion motion;
  double toe_off_s = 0.0;  // The ball reaches the speed of toe-off.
  double strike_s = 0.0;   // The foot reaches the height of a strike.
};

Hop hop(double hz, double push_s, double noise_m, testing::Dice& dice) {
  constexpr double kPush_m_s2 = 40.0;
  constexpr double kTakeoff_m_per_s = 3.0;
  constexpr double kGravity = 9.81;
  constexpr double kPush_s = kTakeoff_m_per_s / kPush_m_s2;
  constexpr double kPush_m = 0.5 * kTakeoff_m_per_s * kPush_s;
  Hop out;
  out.motion.skeleton = make_humanoid(average_proportions(1.75));
  out.motion.rate.hz = hz;
  const BodyMap map = mapped(out.motion.skeleton);
  const ContactEdgeOptions options;
  // The vertical speed counts half.
  out.toe_off_s =
      push_s + 2.0 * options.toe_off_speed_legs_per_s * map.leg_length_m / kPush_m_s2;
  const double strike_m = options.strike_height_legs * map.leg_length_m;
  const auto falls_to = [&](double height_m) {
    const double root = std::sqrt(kTakeoff_m_per_s * kTakeoff_m_per_s +
                                  2.0 * kGravity * (kPush_m - height_m));
    return push_s + kPush_s + (kTakeoff_m_per_s + root) / kGravity;
  };
  out.strike_s = falls_to(strike_m);
  const double landing_s = falls_to(0.0);
  const Pose stands = rest_pose(out.motion.skeleton);
  for (int k = 0; k < static_cast<int>(2.2 * hz); ++k) {
    const double t = k / hz;
    double up_m = 0.0;
    if (t > push_s && t <= push_s + kPush_s) {
      up_m = 0.5 * kPush_m_s2 * (t - push_s) * (t - push_s);
    } else if (t > push_s + kPush_s && t < landing_s) {
      const double s = t - push_s - kPush_s;
      up_m = kPush_m + kTakeoff_m_per_s * s - 0.5 * kGravity * s * s;
    }
    Pose pose = stands;
    pose.root_in_world +=
        glm::dvec3(dice.noise(noise_m), up_m + dice.noise(noise_m), dice.noise(noise_m));
    out.motion.poses.push_back(std::move(pose));
  }
  return out;
}

// Errors of strikes and toe-offs of forty hops that begin at any time between frames.
// [ms]
struct HopErrors {
  std::vector<double> strike_ms;
  std::vector<double> toe_off_ms;
};

HopErrors hop_errors(double hz, double noise_m) {
  HopErrors out;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    testing::Dice dice(seed);
    const Hop one = hop(hz, dice.between(0.6, 0.7), noise_m, dice);
    const auto edges = find_contact_edges(one.motion, mapped(one.motion.skeleton));
    for (const auto& foot : edges.feet) {
      EXPECT_EQ(foot.size(), 2U) << "seed " << seed;
      if (foot.size() != 2) continue;
      EXPECT_FALSE(foot[0].strike);
      EXPECT_FALSE(foot[1].toe_off);
      EXPECT_TRUE(foot[0].toe_off && foot[1].strike) << "seed " << seed;
      if (!foot[0].toe_off || !foot[1].strike) continue;
      EXPECT_EQ(foot[1].strike->rule, EdgeRule::kHeight);
      out.toe_off_ms.push_back(1e3 * std::abs(foot[0].toe_off->time_s - one.toe_off_s));
      out.strike_ms.push_back(1e3 * std::abs(foot[1].strike->time_s - one.strike_s));
    }
  }
  return out;
}

// Landing at 3.4 m/s within one frame: interpolation over the corner is off by less than
// a third of a frame. The push is fitted exactly.
TEST(ContactEdges, RecoversTheEdgesOfAHopBetweenFrames) {
  const HopErrors errors = hop_errors(100.0, 0.0);
  EXPECT_LT(quantile(errors.strike_ms, 1.0), 3.5);
  EXPECT_LT(quantile(errors.toe_off_ms, 1.0), 1.0);
}

TEST(ContactEdges, RecoversTheEdgesOfAHopUnderNoiseOf1mm) {
  const HopErrors errors = hop_errors(100.0, 0.001);
  EXPECT_LT(median(errors.strike_ms), 2.0);
  EXPECT_LT(quantile(errors.strike_ms, 0.9), 4.0);
  EXPECT_LT(median(errors.toe_off_ms), 1.5);
  EXPECT_LT(quantile(errors.toe_off_ms, 0.9), 3.0);
}

TEST(ContactEdges, RecoversTheEdgesOfAHopUnderNoiseOf3mm) {
  const HopErrors errors = hop_errors(100.0, 0.003);
  EXPECT_LT(median(errors.strike_ms), 3.0);
  EXPECT_LT(quantile(errors.strike_ms, 0.9), 10.0);  // One frame.
  EXPECT_LT(median(errors.toe_off_ms), 3.0);
  EXPECT_LT(quantile(errors.toe_off_ms, 0.9), 6.0);
}

std::vector<double> times_of(const ContactEdges& edges, bool strikes) {
  std::vector<double> out;
  for (const auto& foot : edges.feet) {
    for (const StanceEdges& stance : foot) {
      const auto& edge = strikes ? stance.strike : stance.toe_off;
      if (edge) out.push_back(edge->time_s);
    }
  }
  return out;
}

// Distances from each time to the nearest of `found`. [ms]
std::vector<double> distances_ms(const std::vector<double>& times,
                                 const std::vector<double>& found) {
  std::vector<double> out;
  for (const double time_s : times) {
    double nearest_s = 1.0;
    for (const double other_s : found) {
      nearest_s = std::min(nearest_s, std::abs(other_s - time_s));
    }
    out.push_back(1e3 * nearest_s);
  }
  return out;
}

constexpr double kWalk_s = 3.3;

Motion walk_at(double hz) {
  return testing::synthetic_walk(static_cast<int>(kWalk_s * hz), hz).motion;
}

ContactEdges edges_of_walk(double hz) {
  const Motion walk = walk_at(hz);
  return find_contact_edges(walk, mapped(walk.skeleton));
}

TEST(ContactEdges, LieOutsideTheRestOfAWalkingFoot) {
  const ContactEdges edges = edges_of_walk(120.0);
  int strikes = 0;
  for (const auto& foot : edges.feet) {
    for (const StanceEdges& stance : foot) {
      if (stance.strike) {
        ++strikes;
        EXPECT_LE(stance.strike->time_s, stance.stance.first / 120.0);
        EXPECT_EQ(stance.strike->rule, EdgeRule::kSlowing);
      }
      if (stance.toe_off) {
        EXPECT_GE(stance.toe_off->time_s, stance.stance.last / 120.0);
      }
    }
  }
  EXPECT_GE(strikes, 4);
}

// The same walk at 480 Hz is the truth. A frame takes 17 and 8 ms.
TEST(ContactEdges, AgreeBetweenFrameRatesToAFractionOfAFrame) {
  const ContactEdges truth = edges_of_walk(480.0);
  for (const double hz : {60.0, 120.0}) {
    const ContactEdges edges = edges_of_walk(hz);
    for (const bool strikes : {true, false}) {
      const auto off_ms =
          distances_ms(times_of(truth, strikes), times_of(edges, strikes));
      ASSERT_GE(off_ms.size(), 4U);
      EXPECT_LT(quantile(off_ms, 1.0), 4.0) << hz << " Hz";
    }
  }
}

void expect_walk_under_noise(double noise_m, double max_median_ms, double max_p90_ms) {
  const Motion clean = walk_at(120.0);
  const BodyMap map = mapped(clean.skeleton);
  const ContactEdges truth = find_contact_edges(clean, map);
  std::vector<double> off_ms;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    testing::Dice dice(seed);
    Motion noisy = clean;
    for (Pose& pose : noisy.poses) {
      pose.root_in_world +=
          glm::dvec3(dice.noise(noise_m), dice.noise(noise_m), dice.noise(noise_m));
    }
    const ContactEdges edges = find_contact_edges(noisy, map);
    for (const bool strikes : {true, false}) {
      const auto more = distances_ms(times_of(truth, strikes), times_of(edges, strikes));
      off_ms.insert(off_ms.end(), more.begin(), more.end());
    }
  }
  EXPECT_LT(median(off_ms), max_median_ms);
  EXPECT_LT(quantile(off_ms, 0.9), max_p90_ms);
}

TEST(ContactEdges, MoveLittleInAWalkUnderNoiseOf1mm) {
  expect_walk_under_noise(0.001, 2.5, 7.0);
}

TEST(ContactEdges, MoveByAFrameInAWalkUnderNoiseOf3mm) {
  expect_walk_under_noise(0.003, 6.0, 20.0);
}

TEST(ContactEdges, DoNotDependOnTheHeightOfTheFloor) {
  Motion walk = walk_at(120.0);
  const ContactEdges truth = find_contact_edges(walk, mapped(walk.skeleton));
  for (Pose& pose : walk.poses) pose.root_in_world.y += 0.37;
  const ContactEdges edges = find_contact_edges(walk, mapped(walk.skeleton));
  for (const bool strikes : {true, false}) {
    EXPECT_LT(
        quantile(distances_ms(times_of(truth, strikes), times_of(edges, strikes)), 1.0),
        1e-6);
  }
}

// A belt of 1 m stride in 1.1 s, along X and Z.
TEST(ContactEdges, AreFoundOnATreadmill) {
  Motion walk = walk_at(120.0);
  const BodyMap map = mapped(walk.skeleton);
  const ContactEdges truth = find_contact_edges(walk, map);
  const glm::dvec3 belt(0.3, 0.0, -0.9);
  for (std::size_t t = 0; t < walk.poses.size(); ++t) {
    walk.poses[t].root_in_world += static_cast<double>(t) / 120.0 * belt;
  }
  EXPECT_TRUE(detect_contacts(walk, map).feet[0].stance.empty());
  const ContactEdges edges = find_contact_edges(walk, map);
  EXPECT_NEAR(edges.floor_velocity_in_world.x, belt.x, 0.02);
  EXPECT_NEAR(edges.floor_velocity_in_world.z, belt.z, 0.02);
  for (const bool strikes : {true, false}) {
    EXPECT_LT(
        quantile(distances_ms(times_of(truth, strikes), times_of(edges, strikes)), 1.0),
        4.0);
  }
}

TEST(ContactEdges, AreAbsentIfABodyNeverLeavesTheFloor) {
  Motion motion;
  motion.skeleton = testing::child();
  motion.rate.hz = 60.0;
  motion.poses.assign(90, rest_pose(motion.skeleton));
  const ContactEdges edges = find_contact_edges(motion, mapped(motion.skeleton));
  for (const auto& foot : edges.feet) {
    ASSERT_EQ(foot.size(), 1U);
    EXPECT_FALSE(foot[0].strike);
    EXPECT_FALSE(foot[0].toe_off);
  }
}

TEST(ContactEdges, AreAbsentInFreeFall) {
  Motion motion;
  motion.skeleton = testing::giant();
  motion.rate.hz = 60.0;
  for (int t = 0; t < 40; ++t) {
    Pose pose = rest_pose(motion.skeleton);
    const double s = t / 60.0;
    pose.root_in_world += glm::dvec3(0.0, 3.0 + 2.0 * s - 4.905 * s * s, 1.5 * s);
    motion.poses.push_back(pose);
  }
  const ContactEdges edges = find_contact_edges(motion, mapped(motion.skeleton));
  EXPECT_TRUE(times_of(edges, true).empty());
  EXPECT_TRUE(times_of(edges, false).empty());
}

TEST(ContactEdges, AcceptMotionsOfFewFrames) {
  Motion motion;
  motion.skeleton = testing::child();
  motion.rate.hz = 60.0;
  for (int frames = 0; frames < 5; ++frames) {
    const ContactEdges edges = find_contact_edges(motion, mapped(motion.skeleton));
    EXPECT_TRUE(times_of(edges, true).empty()) << frames;
    motion.poses.push_back(rest_pose(motion.skeleton));
  }
}

void expect_within(const std::vector<FrameRange>& inner,
                   const std::vector<FrameRange>& outer,
                   std::size_t count) {
  const auto in = frame_marks(inner, count);
  const auto out = frame_marks(outer, count);
  for (std::size_t t = 0; t < count; ++t) EXPECT_LE(in[t], out[t]) << "frame " << t;
}

TEST(ContactEdges, ExtendContactsAtRestToLoadedContacts) {
  const Motion walk = walk_at(120.0);
  const BodyMap map = mapped(walk.skeleton);
  const Contacts rest = detect_contacts(walk, map);
  const Contacts load = detect_loaded_contacts(walk, map);
  const ContactEdges edges = find_contact_edges(walk, map, rest);
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContacts& foot = load.feet[side];
    ASSERT_EQ(foot.stance.size(), rest.feet[side].stance.size());
    for (std::size_t i = 0; i < foot.stance.size(); ++i) {
      const StanceEdges& found = edges.feet[side][i];
      if (found.strike) {
        EXPECT_EQ(foot.stance[i].first, std::ceil(120.0 * found.strike->time_s));
      }
      if (found.toe_off) {
        EXPECT_EQ(foot.stance[i].last, std::floor(120.0 * found.toe_off->time_s));
      }
    }
    const std::size_t count = walk.poses.size();
    expect_within(rest.feet[side].stance, foot.stance, count);
    expect_within(foot.heel, foot.stance, count);
    expect_within(foot.ball, foot.stance, count);
    expect_within(foot.heel_up, foot.ball, count);
  }
}

TEST(ContactEdges, LeaveAFrameBetweenTwoStances) {
  Contacts contacts;
  contacts.frame_count = 100;
  ContactEdges edges;
  for (std::size_t side = 0; side < 2; ++side) {
    contacts.feet[side].stance = {{10, 30}, {40, 60}};
    contacts.feet[side].heel = {{10, 20}, {40, 50}};
    contacts.feet[side].ball = {{15, 30}, {45, 60}};
    const ContactEdge late{0.39, FootPart::kBall, EdgeRule::kLeaving};
    const ContactEdge early{0.31, FootPart::kHeel, EdgeRule::kSlowing};
    edges.feet[side] = {{{10, 30}, {}, late}, {{40, 60}, early, {}}};
  }
  move_to_edges(edges, {100.0}, contacts);
  for (const FootContacts& foot : contacts.feet) {
    ASSERT_EQ(foot.stance.size(), 2U);
    EXPECT_EQ(foot.stance[0].first, 10);
    EXPECT_LT(foot.stance[0].last + 1, foot.stance[1].first);
    EXPECT_GE(foot.stance[0].last, 30);
    EXPECT_LE(foot.stance[1].first, 40);
    EXPECT_EQ(foot.ball[0].last, foot.stance[0].last);
    EXPECT_EQ(foot.heel[1].first, foot.stance[1].first);
    EXPECT_EQ(foot.ball[1].first, 45);
  }
}

// The strike of a slow walker can lie after the first frame in which the foot counts as
// at rest.
TEST(ContactEdges, ShortenAStanceThatBeginsTooEarly) {
  Contacts contacts;
  contacts.frame_count = 100;
  contacts.feet[0].stance = {{10, 40}};
  contacts.feet[0].heel = {{10, 30}};
  contacts.feet[0].ball = {{12, 14}, {20, 40}};
  contacts.feet[0].heel_up = {{31, 40}};
  ContactEdges edges;
  const ContactEdge strike{0.155, FootPart::kHeel, EdgeRule::kSlowing};
  edges.feet[0] = {{{10, 40}, strike, {}}};
  move_to_edges(edges, {100.0}, contacts);
  EXPECT_EQ(contacts.feet[0].stance[0].first, 16);
  EXPECT_EQ(contacts.feet[0].heel[0].first, 16);
  ASSERT_EQ(contacts.feet[0].ball.size(), 1U);
  EXPECT_EQ(contacts.feet[0].ball[0].first, 20);
  EXPECT_EQ(contacts.feet[0].heel_up[0].first, 31);
}

}  // namespace
}  // namespace marey::retarget
