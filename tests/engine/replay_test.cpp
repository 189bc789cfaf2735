// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Recorded runs of an engine.
#include <cstring>
#include <string>
#include <vector>

#include "engine/engine_recorder.h"
#include <gtest/gtest.h>

#include "core/base/split_mix.h"
#include "tests/engine/made_performer.h"

namespace marey::engine {
namespace {

constexpr int kCast = 3;

Engine engine_with_cast() {
  Engine engine = *Engine::make(made_base(), {.step_hz = 60.0});
  for (int i = 0; i < kCast; ++i) {
    CharacterSpec spec = made_character();
    spec.reaches = i == 0;
    EXPECT_TRUE(engine.add(spec));
  }
  return engine;
}

// Bytes of all poses.
std::string bytes_of(const Engine& engine) {
  std::string out;
  const auto append = [&](const auto& value) {
    char bytes[sizeof(value)];
    std::memcpy(bytes, &value, sizeof(value));
    out.append(bytes, sizeof(value));
  };
  for (int i = 0; i < kCast; ++i) {
    const Pose& pose = engine.pose(CharacterId{i});
    append(pose.root_in_world);
    for (const glm::dquat& q : pose.parent_from_joint) append(q);
  }
  return out;
}

ActionWish random_wish(SplitMix& random, const std::vector<ActionId>& known) {
  constexpr std::array<const char*, 4> kNames{"walk", "stroll", "steps", "still"};
  ActionWish wish;
  wish.clip = kNames[random.below(4)];
  if (random.below(3) == 0) wish.priority = only(kEditGroups[random.below(7)]);
  wish.weight = 0.1 + random.unit();
  wish.fade_in_s = random.unit();
  wish.rate = 0.5 + random.unit();
  wish.transition = static_cast<TransitionKind>(random.below(5));
  if (random.below(4) == 0 && !known.empty()) {
    wish.start.kind = ActionStart::Kind::kAfter;
    wish.start.action = known[random.below(known.size())];
  }
  return wish;
}

// One random request or none; refused ones are part of it.
void request_something(EngineRecorder& run,
                       SplitMix& random,
                       std::vector<ActionId>& known) {
  const CharacterId who{static_cast<int>(random.below(kCast))};
  const auto remember = [&](const Result<ActionId>& id) {
    if (id) known.push_back(*id);
  };
  const auto of = [&](double scale) { return scale * (random.unit() - 0.5); };
  ReachWish reach;
  reach.action.clip = "still";
  reach.side = static_cast<int>(random.below(2));
  reach.target.p_in_world = {of(1.0), 1.0 + of(1.0), of(1.0)};
  SteerWish steer;
  steer.action.clip = "walk";
  steer.goal_xz_m = {of(10.0), of(10.0)};
  switch (random.below(20)) {
    case 0:
      return remember(run.play(who, random_wish(random, known)));
    case 1:
      return remember(run.play(who, steer));
    case 2:
      return remember(run.play(CharacterId{0}, reach));
    case 3:
      (void)run.aim(who, {of(10.0), of(10.0)});
      return;
    case 4:
      (void)run.aim(CharacterId{0}, reach.side, reach.target);
      return;
    case 5:
      if (!known.empty()) (void)run.stop(who, known[random.below(known.size())]);
      return;
    case 6:
      if (random.below(4) == 0)
        (void)run.stop_all(who, static_cast<int>(random.below(2)));
      return;
    case 7:
      if (random.below(3) == 0) remember(run.play(CharacterId{1}, LiveWish{}));
      return;
    case 8:
      (void)run.set_level(who, static_cast<DetailLevel>(random.below(2)));
      return;
    default:
      return;
  }
}

TEST(Replay, RepeatsRandomRunsToTheByte) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SplitMix random(seed);
    Engine engine = engine_with_cast();
    EngineRecorder run(engine);
    ASSERT_TRUE(run.play(CharacterId{1}, LiveWish{}));
    const MadePerformer performer{.tempo = 0.9};
    std::vector<ActionId> known;
    std::vector<std::string> poses;
    for (int step = 0; step < 600; ++step) {
      request_something(run, random, known);
      if (step % 100 < 80) {
        (void)run.push(CharacterId{1}, performer.at(engine.time_s() + engine.step_s()));
      }
      engine.advance();
      poses.push_back(bytes_of(engine));
    }
    const EngineLog log = run.log();
    EXPECT_EQ(log.steps, 600);
    Engine again = engine_with_cast();
    auto replay = EngineReplay::make(log, again);
    ASSERT_TRUE(replay) << replay.error().message();
    for (std::size_t step = 0; !replay->is_over(); ++step) {
      const Status done = replay->step();
      ASSERT_TRUE(done) << done.error().message();
      ASSERT_TRUE(bytes_of(again) == poses[step]) << seed << ' ' << step;
    }
  }
}

TEST(Replay, RefusesOtherEnginesAndDamagedLogs) {
  Engine engine = engine_with_cast();
  EngineRecorder run(engine);
  ActionWish walk;
  walk.clip = "walk";
  ASSERT_TRUE(run.play(CharacterId{0}, walk));
  engine.advance(3);
  const EngineLog log = run.log();
  const auto is_refused = [&](const EngineLog& bad) {
    Engine again = engine_with_cast();
    auto replay = EngineReplay::make(bad, again);
    return !replay || !replay->step();
  };
  EXPECT_FALSE(is_refused(log));
  EXPECT_FALSE(EngineReplay::make(log, engine));
  const auto spoiled = [&](auto&& spoil) {
    EngineLog bad = log;
    spoil(bad);
    return is_refused(bad);
  };
  EXPECT_TRUE(spoiled([](EngineLog& l) { l.step_hz = 30.0; }));
  EXPECT_TRUE(spoiled([](EngineLog& l) { l.characters.pop_back(); }));
  EXPECT_TRUE(spoiled([](EngineLog& l) { l.clips[0] += "x"; }));
  EXPECT_TRUE(spoiled([](EngineLog& l) { l.requests[0].step = -1; }));
  EXPECT_TRUE(spoiled([](EngineLog& l) { l.requests[0].character = 3; }));
  EXPECT_TRUE(spoiled([](EngineLog& l) { l.requests[0].kind = "sing"; }));
  EXPECT_TRUE(spoiled([](EngineLog& l) { l.requests[0].texts.clear(); }));
  EXPECT_TRUE(spoiled([](EngineLog& l) { l.requests[0].numbers.pop_back(); }));
  EXPECT_TRUE(spoiled([](EngineLog& l) { l.requests[0].numbers.push_back(0.0); }));
}

}  // namespace
}  // namespace marey::engine
