// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/support_constraints.h"

#include <algorithm>
#include <set>
#include <string>
#include <variant>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "retarget/activation.h"
#include "retarget/adapt_motion.h"
#include "retarget/make_character.h"
#include "retarget/retarget_motion.h"
#include "tests/retarget/mapped.h"
#include "tests/support/synthetic_walk.h"

namespace marey::retarget {
namespace {

constexpr FrameRate kRate{60.0};

/// A walk whose feet stand to the bit, and its supports.
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
  // Between steps the foot is free: nobody holds it for a tenth of a second.
  int free = 0;
  for (int t = 0; t < 240; ++t) {
    free += std::ranges::none_of(set.constraints, [&](const Constraint& c) {
      return c.point.segment == "leftFoot" && activation(c.activation, t / kRate.hz) > 0;
    });
  }
  EXPECT_GT(free, 24);
}

// What is planted already is not moved by more than what the numbers were rounded to.
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

TEST(SupportConstraints, AreNoneWithoutSupports) {
  EXPECT_TRUE(support_constraints({}, kRate).constraints.empty());
}

}  // namespace
}  // namespace marey::retarget
