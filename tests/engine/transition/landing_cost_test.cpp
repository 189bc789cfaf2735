// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/transition/landing_cost.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/made_base.h"

namespace marey::engine {
namespace {

struct Choice {
  std::shared_ptr<const MotionBase> base = made_base();
  Rig rig = make_rig(made_skeleton(), *retarget::map_body(made_skeleton()));

  [[nodiscard]] const MotionClip& clip(const char* name) const {
    return base->clip(*base->find(name));
  }
  [[nodiscard]] EntryQuestion question(double now_s) const {
    EntryQuestion out;
    out.rig = &rig;
    out.from = &clip("walk");
    out.from_source_s = now_s;
    out.to = &clip("walk");
    out.anywhere = true;
    return out;
  }
};

TEST(LandingCost, IsZeroForTheSameFeet) {
  const Choice choice;
  for (double t = 0.0; t < 1.1; t += 0.02) {
    ClipFeet feet = clip_feet(choice.rig, choice.clip("walk"), t, 1.0);
    const ClipFeet to = feet;
    feet.bears_now = {true, true};
    EXPECT_DOUBLE_EQ(landing_cost(feet, to), 0.0);
  }
}

TEST(LandingCost, CountsTheWayAndTheMotionOfAFootThatHasToStand) {
  ClipFeet from;
  ClipFeet to;
  from.ankle_m[0] = {0.0, 0.3, 0.0};
  from.velocity_m_s[0] = {0.0, 0.0, 2.0};
  to.bears = {true, false};
  EXPECT_NEAR(landing_cost(from, to), 0.3 + 0.2, 1e-12);
  from.bears_now = {true, false};
  EXPECT_NEAR(landing_cost(from, to), 0.3, 1e-12);
  to.bears = {false, false};
  EXPECT_NEAR(landing_cost(from, to), 0.09, 1e-12);
}

TEST(LandingCost, GivesAStandingFootNoVelocity) {
  const Choice choice;
  const MotionClip& clip = choice.clip("walk");
  for (double t = 0.0; t < 1.1; t += 0.01) {
    const ClipFeet feet = clip_feet(choice.rig, clip, t, 1.0);
    // Detected contacts begin and end with feet that still move.
    const unsigned bits =
        bearing_at(clip, t - 0.06) & bearing_at(clip, t) & bearing_at(clip, t + 0.06);
    // Heel and ball bear: the foot is flat.
    if ((bits & 3U) == 3U) {
      EXPECT_LT(glm::length(feet.velocity_m_s[0]), 0.05) << t;
    }
    if ((bits & 12U) == 12U) {
      EXPECT_LT(glm::length(feet.velocity_m_s[1]), 0.05) << t;
    }
  }
}

// A clip goes on in itself where it is.
TEST(ChooseEntry, FindsThePhaseOfTheSameClip) {
  const Choice choice;
  const double duration_s = choice.clip("walk").duration_s();
  for (double now_s = 0.0; now_s < duration_s; now_s += 0.07) {
    const EntryAnswer answer = choose_entry(choice.question(now_s));
    EXPECT_LT(std::abs(std::remainder(answer.entry_s - now_s, duration_s)), 0.05)
        << now_s;
    EXPECT_EQ(answer.delay_s, 0.0);
  }
}

TEST(ChooseEntry, StaysWithinItsRangeAndDelay) {
  const Choice choice;
  for (double now_s = 0.0; now_s < 1.1; now_s += 0.05) {
    EntryQuestion question = choice.question(now_s);
    question.anywhere = false;
    question.to = &choice.clip("steps");
    question.asked_s = 0.5;
    question.first_s = 0.3;
    question.last_s = 0.7;
    question.max_delay_s = 0.12;
    const EntryAnswer answer = choose_entry(question);
    EXPECT_GE(answer.entry_s, 0.3);
    EXPECT_LE(answer.entry_s, 0.7);
    EXPECT_GE(answer.delay_s, 0.0);
    EXPECT_LE(answer.delay_s, 0.12 + 1e-12);
    EXPECT_LE(answer.cost_m,
              entry_landing_cost(question, 0.0, 0.5 + 0.5 * question.fade_s) + 1e-12);
  }
}

}  // namespace
}  // namespace marey::engine
