// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/support_constraints.h"

#include <algorithm>
#include <set>
#include <string>
#include <variant>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/frame_range.h"
#include "core/floor.h"
#include "retarget/adapt/adapt_motion.h"
#include "retarget/character/make_character.h"
#include "retarget/constraints/activation.h"
#include "retarget/constraints/check_constraints.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/mapped.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

constexpr FrameRate kRate{60.0};

/// A walk whose feet stand still to the bit, and its supports.
struct Planted {
  Planted() {
    const testing::SyntheticWalk walk = testing::synthetic_walk(240, kRate.hz);
    const auto out = retarget_motion(walk.motion, walk.motion.skeleton);
    EXPECT_TRUE(out);
    motion = out->motion;
    map = mapped(motion.skeleton);
    tracks = plan_supports(motion, map, out->report.contacts, {.ramp_s = 0.05});
  }
  Motion motion;
  BodyMap map;
  std::vector<SupportTrack> tracks;
};

TEST(SupportConstraints, AreOnePerStanceWithNamesOfTheirOwn) {
  const Planted planted;
  const ConstraintSet set = support_constraints(planted.tracks, kRate);
  std::size_t stances = 0;
  for (const SupportTrack& track : planted.tracks) stances += track.stands.size();
  EXPECT_EQ(set.constraints.size(), stances);
  std::set<std::string> names;
  for (const Constraint& c : set.constraints) {
    EXPECT_TRUE(names.insert(c.id).second) << c.id;
    EXPECT_TRUE(std::get<Support>(c.goal).footprint_in_world) << c.id;
  }
  EXPECT_TRUE(set.find("leftFoot flat 1") && set.find("rightFoot ball 2"));
}

TEST(SupportConstraints, AreFullyActiveWhereTheirFootBearsAndNotBetweenSteps) {
  const Planted planted;
  const ConstraintSet set = support_constraints(planted.tracks, kRate);
  for (const SupportTrack& track : planted.tracks) {
    for (const FloorStance& stance : track.stands) {
      for (int t = stance.frames.first; t <= stance.frames.last; ++t) {
        const bool holds = std::ranges::any_of(set.constraints, [&](const Constraint& c) {
          const auto& at = *std::get<Support>(c.goal).footprint_in_world;
          return c.point.segment == track.constraint.point.segment &&
                 glm::distance(at, track.p_in_world[static_cast<std::size_t>(t)]) <
                     2e-6 &&
                 activation(c.activation, t / kRate.hz) == 1.0;
        });
        EXPECT_TRUE(holds) << track.constraint.id << " frame " << t;
      }
    }
  }
  // Between steps the foot is free for a tenth of a second: no constraint holds it.
  int free = 0;
  for (int t = 0; t < 240; ++t) {
    free += std::ranges::none_of(set.constraints, [&](const Constraint& c) {
      return c.point.segment == "leftFoot" && activation(c.activation, t / kRate.hz) > 0;
    });
  }
  EXPECT_GT(free, 24);
}

// Feet that stand already move by no more than the rounding of the numbers.
TEST(SupportConstraints, ChangeNothingInAMotionThatStands) {
  const Planted planted;
  const auto character = make_character("walker", planted.motion.skeleton, planted.map);
  ASSERT_TRUE(character);
  const auto adapted = adapt_motion(
      planted.motion, *character, support_constraints(planted.tracks, kRate), {});
  ASSERT_TRUE(adapted) << adapted.error().message();
  for (const KeptConstraint& kept : adapted->constraints) {
    EXPECT_GT(kept.active_frames, 0) << kept.id;
    EXPECT_LT(kept.worst_error_m, 2e-6) << kept.id;
  }
}

constexpr int kRoll = 8;

/// A walk whose feet land on their heels, toes up by 0.35 rad at first, and roll down in
/// kRoll frames: flat feet, and feet on the heel and on the ball alone.
struct HeelFirst {
  HeelFirst() {
    testing::SyntheticWalk walk = testing::synthetic_walk(240, kRate.hz);
    map = mapped(walk.motion.skeleton);
    contacts = detect_contacts(walk.motion, map);
    for (std::size_t side = 0; side < 2; ++side) {
      FootContacts& foot = contacts.feet[side];
      const JointIndex ankle = map.leg(static_cast<int>(side)).end;
      for (FrameRange& ball : foot.ball) {
        if (ball.first == 0) continue;
        for (int k = 0; k < kRoll; ++k) {
          const double up_rad = 0.35 * (kRoll - k) / kRoll;
          glm::dquat& turn = walk.motion.poses[static_cast<std::size_t>(ball.first + k)]
                                 .parent_from_joint[index(ankle)];
          turn = turn * glm::angleAxis(-up_rad, glm::dvec3(1, 0, 0));
        }
        ball.first += kRoll;
      }
    }
    motion = walk.motion;
    tracks = plan_supports(motion, map, contacts, {.ramp_s = 0.05});
  }
  Motion motion;
  BodyMap map;
  Contacts contacts;
  std::vector<SupportTrack> tracks;
};

// A foot on its heel alone rises on it by the distance of its sole behind the ankle.
TEST(SupportConstraints, DoNotContradictEachOtherWhereFeetRollFromHeelToBall) {
  const HeelFirst walk;
  double rises_m = 0.0;
  for (const SupportTrack& track : walk.tracks) {
    if (track.constraint.id != "found leftFoot heel before flat") continue;
    for (const FloorStance& stance : track.stands) {
      const auto at = [&](int t) {
        return track.p_in_world[static_cast<std::size_t>(t)];
      };
      rises_m = std::max(rises_m,
                         glm::distance(at(stance.frames.first), at(stance.frames.last)));
    }
  }
  EXPECT_GT(rises_m, 1e-3);  // Otherwise there is no contradiction to test.
  const ConstraintSet set = support_constraints(walk.tracks, kRate);
  ASSERT_TRUE(set.find("leftFoot heel 1") && set.find("leftFoot flat 2") &&
              set.find("leftFoot ball 2"));
  const auto character = make_character("walker", walk.motion.skeleton, walk.map);
  ASSERT_TRUE(character);
  const Status checked = check_constraints(set, *character);
  EXPECT_TRUE(checked) << checked.error().message();
  for (int t = 0; t < 240; ++t) {
    for (const Constraint& a : set.constraints) {
      for (const Constraint& b : set.constraints) {
        if (a.point.segment != b.point.segment ||
            activation(a.activation, t / kRate.hz) < 1.0 ||
            activation(b.activation, t / kRate.hz) < 1.0) {
          continue;
        }
        const double points_m =
            glm::distance(a.point.offset_in_t_pose, b.point.offset_in_t_pose);
        const double prints_m =
            glm::distance(*std::get<Support>(a.goal).footprint_in_world,
                          *std::get<Support>(b.goal).footprint_in_world);
        EXPECT_NEAR(points_m, prints_m, points_m > 0.0 ? 4e-6 : 0.0)
            << a.id << " and " << b.id << " in frame " << t;
      }
    }
  }
}

// On moving footprints, those of each stance belong to one moment.
TEST(SupportConstraints, DoNotContradictEachOtherOnAFloorThatMoves) {
  const HeelFirst walk;
  Floor belt;
  belt.parts.push_back({"belt", {-5, -20}, {5, 20}, 0.0, {}, {}});
  belt.parts.back().path = {{0.0, {0, 0, 0}}, {10.0, {0, 0, -5}}};
  const ConstraintSet set = support_constraints(
      plan_supports(
          walk.motion, walk.map, walk.contacts, {.ramp_s = 0.05, .floor = &belt}),
      kRate);
  ASSERT_TRUE(set.find("leftFoot heel 1") && set.find("leftFoot flat 2"));
  const auto character = make_character("walker", walk.motion.skeleton, walk.map);
  ASSERT_TRUE(character);
  const Status checked = check_constraints(set, *character);
  EXPECT_TRUE(checked) << checked.error().message();
}

TEST(SupportConstraints, AreNoneWithoutSupports) {
  EXPECT_TRUE(support_constraints({}, kRate).constraints.empty());
}

}  // namespace
}  // namespace marey::retarget
