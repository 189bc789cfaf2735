// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The preview of balance on made motions. Zero moment points are judged by code that
// shares nothing with it.
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
#include "tests/support/program/count_allocations.h"
#include "tests/support/simulation/synthetic_walk.h"
#include "tests/support/truth/zmp_judge.h"

namespace marey::app {
namespace {

using reconstruct::TrackReport;
using reconstruct::TrackState;

constexpr double kPreviewRate_hz = 60.0;
constexpr std::int64_t kPreviewDelay = 48;

const TrackReport kSeen{TrackState::kTracked, 20, 0, 0.5};
const TrackReport kUnseen{TrackState::kLost, 0, 0, 0.0};

/// A person who stands and sways in the hips, so that the feet stay where they are.
Motion swaying(int frames, const glm::dvec3& axis, double angle_rad, double sway_hz) {
  Motion out{make_humanoid(average_proportions(1.75)), FrameRate{kPreviewRate_hz}, 0, {}};
  const auto spine = index(*out.skeleton.find(HumanBone::kSpine));
  for (int t = 0; t < frames; ++t) {
    Pose pose = rest_pose(out.skeleton);
    const double time_s = t / kPreviewRate_hz;
    const double grown = std::min(1.0, time_s);
    const double angle =
        grown * angle_rad * std::sin(2.0 * 3.141592653589793 * sway_hz * time_s);
    pose.parent_from_joint[spine] = glm::angleAxis(angle, axis);
    out.poses.push_back(std::move(pose));
  }
  return out;
}

/// One instant of a stream.
struct Sent {
  std::int64_t number = 0;
  TrackReport track = kSeen;
  Pose pose;
};

std::vector<Sent> stream_of(const Motion& motion) {
  std::vector<Sent> out;
  for (const Pose& pose : motion.poses) {
    out.push_back({static_cast<std::int64_t>(out.size()), kSeen, pose});
  }
  return out;
}

bool have_same_bits(const Pose& a, const Pose& b) {
  return a.root_in_world == b.root_in_world && a.parent_from_joint == b.parent_from_joint;
}

class PreviewOfAPerson : public ::testing::Test {
 protected:
  struct Shown {
    PreviewedFrame frame;
    glm::dvec2 shift_xz_m{0.0};
  };

  static LivePreview preview_of(const Skeleton& skeleton) {
    const std::array<const Skeleton*, 2> bodies{&skeleton, &skeleton};
    auto made = LivePreview::make(bodies, FrameRate{kPreviewRate_hz});
    EXPECT_TRUE(made);
    return *std::move(made);
  }

  /// The performer's poses are also the avatar's.
  static void step(LivePreview& preview, const Sent& sent) {
    preview.step(sent.number, sent.track, {}, sent.pose, {&sent.pose, 1});
  }

  static std::vector<Shown> run(const Skeleton& skeleton, const std::vector<Sent>& sent) {
    LivePreview preview = preview_of(skeleton);
    std::vector<Shown> out;
    for (const Sent& one : sent) {
      step(preview, one);
      out.push_back({preview.frame(), preview.shift_xz_m(1)});
    }
    return out;
  }

  /// The balanced motion without its delay, of the same frames as the source; the last
  /// frames are missing.
  static Motion balanced(const Motion& motion) {
    Motion out = motion;
    out.poses.clear();
    for (const Shown& shown : run(motion.skeleton, stream_of(motion))) {
      if (shown.frame.track.state == TrackState::kWaiting) continue;
      out.poses.push_back(shown.frame.avatars[0]);
    }
    return out;
  }
};

/// Judgement of a motion with the contacts of its source.
struct Judged {
  int supported = 0;
  int outside = 0;
  double sum_outside_m = 0.0;
};

Judged judge(const Motion& source, const Motion& motion) {
  Judged out;
  const auto map = retarget::map_body(source.skeleton);
  const auto masses = retarget::place_masses(source.skeleton, *map, {});
  const Contacts contacts = retarget::detect_contacts(source, *map);
  const auto judged = testing::judge_zmp(
      motion, testing::judged_feet(*map), *masses, contacts, 0.0, 0.16);
  // The ends have one-sided derivatives.
  for (std::size_t t = 10; t + 10 < judged.size(); ++t) {
    if (judged[t].vertical_force_g < 0.2 || !judged[t].outside_m) continue;
    ++out.supported;
    out.outside += *judged[t].outside_m > 0.0 ? 1 : 0;
    out.sum_outside_m += *judged[t].outside_m;
  }
  return out;
}

glm::dvec3 ankle_of(const Skeleton& skeleton, const Pose& pose, std::size_t side) {
  const HumanBone foot = side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
  return world_from_joints(skeleton, pose)[index(*skeleton.find(foot))].translation;
}

glm::dvec3 centre_of(const Skeleton& skeleton, const Pose& pose) {
  const auto map = retarget::map_body(skeleton);
  const auto masses = retarget::place_masses(skeleton, *map, {});
  return centre_of_mass(*masses, world_from_joints(skeleton, pose));
}

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
