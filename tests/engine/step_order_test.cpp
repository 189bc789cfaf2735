// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "engine/engine.h"
#include <gtest/gtest.h>

#include "tests/engine/made_base.h"

namespace marey::engine {
namespace {

Engine engine_of_three() {
  Engine engine = *Engine::make(made_base(), {.step_hz = 60.0});
  for (int i = 0; i < 3; ++i) {
    CharacterSpec spec = made_character();
    spec.start = {1.0 * i, 0.0, 0.3 * i};
    const CharacterId who = *engine.add(std::move(spec));
    ActionWish wish;
    wish.clip = "walk";
    wish.entry_s = 0.1 * i;
    EXPECT_TRUE(engine.play(who, wish).has_value());
  }
  return engine;
}

bool have_equal_poses(const Engine& a, const Engine& b) {
  for (int i = 0; i < 3; ++i) {
    const Pose& p = a.pose(CharacterId{i});
    const Pose& q = b.pose(CharacterId{i});
    if (p.root_in_world != q.root_in_world ||
        p.parent_from_joint != q.parent_from_joint) {
      return false;
    }
  }
  return true;
}

TEST(EngineStepOrder, GivesTheSameBytesInAnyOrder) {
  Engine whole = engine_of_three();
  Engine single = engine_of_three();
  for (int step = 0; step < 60; ++step) {
    whole.advance();
    single.begin_step();
    EXPECT_EQ(single.time_s(), whole.time_s());
    single.step(CharacterId{2});
    if (step % 2 == 0) single.step(CharacterId{0});
    single.end_step();
    ASSERT_TRUE(have_equal_poses(whole, single)) << step;
  }
}

TEST(EngineStepOrder, BeginsRequestsBetweenCharactersInTheSameStep) {
  Engine whole = engine_of_three();
  Engine single = engine_of_three();
  whole.advance(20);
  single.advance(20);
  ActionWish wish;
  wish.clip = "walk";
  wish.transition = TransitionKind::kCut;
  wish.entry_s = 0.4;
  ASSERT_TRUE(whole.play(CharacterId{1}, wish).has_value());
  single.begin_step();
  single.step(CharacterId{0});
  ASSERT_TRUE(single.play(CharacterId{1}, wish).has_value());
  single.end_step();
  whole.advance();
  EXPECT_TRUE(have_equal_poses(whole, single));
}

}  // namespace
}  // namespace marey::engine
