// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Live sources as actions of an engine.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/sources/stride_phase.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/split_mix.h"
#include "tests/engine/made_performer.h"
#include "tests/support/program/count_allocations.h"

namespace marey::engine {
namespace {

constexpr double kRate_hz = 60.0;

Engine live_engine() {
  return *Engine::make(made_base(), {.step_hz = kRate_hz});
}

CharacterSpec blended_character() {
  CharacterSpec spec = made_character();
  spec.level = DetailLevel::kBlended;
  return spec;
}

ActionWish of_clip(std::string clip) {
  ActionWish wish;
  wish.clip = std::move(clip);
  return wish;
}

// Plays a performer's posture of the next step, and returns it.
LivePosture perform(Engine& engine, CharacterId who, const MadePerformer& performer) {
  const LivePosture out = performer.at(engine.time_s() + engine.step_s());
  EXPECT_TRUE(engine.push(who, out));
  return out;
}

TEST(LiveAction, ShowsThePerformerWithoutDelay) {
  Engine engine = live_engine();
  const CharacterId ann = *engine.add(blended_character());
  const ActionId live = *engine.play(ann, LiveWish{});
  EXPECT_EQ(engine.phase(ann, live), ActionPhase::kQueued);
  const MadePerformer performer;
  perform(engine, ann, performer);
  engine.advance();
  EXPECT_EQ(engine.phase(ann, live), ActionPhase::kQueued);
  for (int step = 0; step < 150; ++step) {
    const LivePosture truth = perform(engine, ann, performer);
    engine.advance();
    EXPECT_TRUE(engine.player(ann).blend().posture() == truth.posture) << step;
  }
  const double leg_m = engine.player(ann).blend().rig().leg_length_m;
  const double way = performer.at(151 / kRate_hz).root_legs.z_m -
                     performer.at(1 / kRate_hz).root_legs.z_m;
  EXPECT_NEAR(engine.player(ann).blend().root().z_m, leg_m * way, 1e-3 * leg_m);
}

TEST(LiveAction, LeavesTheLegsToAClip) {
  Engine engine = live_engine();
  const CharacterId ann = *engine.add(blended_character());
  const CharacterId bob = *engine.add(blended_character());
  for (const CharacterId who : {ann, bob}) {
    ASSERT_TRUE(engine.play(who, of_clip("walk")));
  }
  LiveWish arms;
  arms.action.priority = only(EditGroup::kLeftArm);
  arms.action.fade_in_s = 0.1;
  ASSERT_TRUE(engine.play(ann, arms));
  const MadePerformer performer{.clip = "still"};
  for (int step = 0; step < 60; ++step) {
    perform(engine, ann, performer);
    engine.advance();
    const BlendPosture& a = engine.player(ann).blend().posture();
    const BlendPosture& b = engine.player(bob).blend().posture();
    EXPECT_EQ(a.fold_rad[2], b.fold_rad[2]);
    EXPECT_EQ(a.height_legs, b.height_legs);
    if (step > 10) {
      EXPECT_FLOAT_EQ(a.fold_rad[0], performer.at(engine.time_s()).posture.fold_rad[0]);
    }
  }
}

// Speeds of the joints of a posture in the last step.
class JointSpeeds {
 public:
  // Returns the largest change of a joint's velocity from the step before. [m/s]
  double change(std::span<const RigidTransform> joints) {
    double worst = 0.0;
    const bool is_known = before_.size() == joints.size();
    std::vector<glm::dvec3> velocity(joints.size());
    for (std::size_t i = 0; i < joints.size() && is_known; ++i) {
      velocity[i] = (joints[i].translation - before_[i]) * kRate_hz;
      if (velocity_.size() == joints.size()) {
        worst = std::max(worst, glm::distance(velocity[i], velocity_[i]));
      }
    }
    before_.clear();
    for (const RigidTransform& joint : joints) before_.push_back(joint.translation);
    velocity_ = is_known ? velocity : std::vector<glm::dvec3>();
    return worst;
  }

 private:
  std::vector<glm::dvec3> before_, velocity_;
};

TEST(LiveAction, GivesWayAndReturnsWithoutPops) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SplitMix random(seed);
    Engine engine = live_engine();
    const CharacterId ann = *engine.add(blended_character());
    // The performer alone: whose velocities change as they do.
    const CharacterId bob = *engine.add(blended_character());
    ASSERT_TRUE(engine.play(ann, of_clip(seed % 2 == 0 ? "walk" : "stroll")));
    for (const CharacterId who : {ann, bob}) ASSERT_TRUE(engine.play(who, LiveWish{}));
    const MadePerformer performer{.tempo = 0.8 + 0.4 * random.unit(),
                                  .start_s = random.unit()};
    JointSpeeds of_ann, of_bob;
    double worst = 0.0;
    double own = 0.0;
    int bad_steps = 0;
    int lost_steps = 0;
    std::size_t bad_group = 0;
    for (int step = 0; step < 500; ++step) {
      if (bad_steps == 0 && lost_steps == 0 && step > 60) {
        if (random.below(60) == 0) bad_steps = 5 + static_cast<int>(random.below(60));
        if (random.below(60) == 0) lost_steps = 3 + static_cast<int>(random.below(60));
        bad_group = random.below(kGroupCount + 1);
      }
      perform(engine, bob, performer);
      LivePosture posture = performer.at(engine.time_s() + engine.step_s());
      for (std::size_t g = 0; g < kGroupCount && bad_steps > 0; ++g) {
        if (g == bad_group || bad_group == kGroupCount) posture.sigma_m[g] = 0.3F;
      }
      if (lost_steps == 0) {
        ASSERT_TRUE(engine.push(ann, posture));
      }
      bad_steps = std::max(0, bad_steps - 1);
      lost_steps = std::max(0, lost_steps - 1);
      engine.advance();
      const double a = of_ann.change(engine.player(ann).world_from_joint());
      const double b = of_bob.change(engine.player(bob).world_from_joint());
      if (step < 3) continue;
      worst = std::max(worst, a);
      own = std::max(own, b);
    }
    // A cut between the two would change velocities by more than 10 m/s.
    EXPECT_LT(worst, own + 1.3) << seed;
  }
}

TEST(LiveAction, LeadsTheStepsOfAWalk) {
  const auto base = made_base();
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SplitMix random(seed);
    const MadePerformer performer{.tempo = 0.75 + 0.6 * random.unit(),
                                  .start_s = random.unit()};
    const std::string clip = seed % 2 == 0 ? "walk" : "stroll";
    const MotionClip& follower = base->clip(*base->find(clip));
    const MotionClip& leader = base->clip(*base->find("walk"));
    Engine engine = live_engine();
    const CharacterId ann = *engine.add(blended_character());
    const ActionId walk = *engine.play(ann, of_clip(clip));
    ASSERT_TRUE(engine.play(ann, LiveWish{}));
    double worst = 0.0;
    for (int step = 0; step < 720; ++step) {
      perform(engine, ann, performer);
      engine.advance();
      if (step < 360) continue;
      const double t = engine.time_s();
      const PhaseWarp& warp = *engine.player(ann).blend().warp(walk);
      const double lead = *stride_phase(leader, performer.start_s + performer.tempo * t);
      const double own = *stride_phase(follower, warp.source_s(t));
      worst = std::max(worst, std::abs(std::remainder(lead - own, 1.0)));
      EXPECT_NEAR(warp.rate(t) * 1.1 / follower.duration_s() / performer.tempo, 1.0, 0.2);
    }
    EXPECT_LT(worst, 0.05) << seed;
  }
}

TEST(LiveAction, LetsAWalkBeginInStep) {
  const auto base = made_base();
  const MotionClip& walk_clip = base->clip(*base->find("walk"));
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const MadePerformer performer{.start_s = 0.1 * static_cast<double>(seed)};
    Engine engine = live_engine();
    const CharacterId ann = *engine.add(blended_character());
    ASSERT_TRUE(engine.play(ann, LiveWish{}));
    for (int step = 0; step < 240; ++step) {
      perform(engine, ann, performer);
      engine.advance();
    }
    const ActionId walk = *engine.play(ann, of_clip("walk"));
    perform(engine, ann, performer);
    engine.advance();
    EXPECT_TRUE(engine.player(ann).report().transition.is_synchronised);
    const double t = engine.time_s();
    const double lead = *stride_phase(walk_clip, performer.start_s + t);
    const double own =
        *stride_phase(walk_clip, engine.player(ann).blend().warp(walk)->source_s(t));
    EXPECT_LT(std::abs(std::remainder(lead - own, 1.0)), 0.03) << seed;
  }
}

TEST(LiveAction, RefusesBadRequests) {
  Engine engine = live_engine();
  const CharacterId ann = *engine.add(blended_character());
  const MadePerformer performer;
  EXPECT_FALSE(engine.push(ann, performer.at(0.0)));
  EXPECT_FALSE(engine.push(CharacterId{3}, performer.at(0.0)));
  LiveWish wish;
  wish.action.clip = "walk";
  EXPECT_FALSE(engine.play(ann, wish));
  wish = {};
  wish.action.priority = {};
  EXPECT_FALSE(engine.play(ann, wish));
  wish = {};
  wish.options.max_sigma_m = -1.0;
  EXPECT_FALSE(engine.play(ann, wish));
  const ActionId live = *engine.play(ann, LiveWish{});
  EXPECT_FALSE(engine.push(ann, performer.at(1.0)));
  EXPECT_TRUE(engine.push(ann, performer.at(0.0)));
  ActionWish after = of_clip("walk");
  after.start = {.kind = ActionStart::Kind::kAfter, .action = live, .event = {}};
  EXPECT_FALSE(engine.play(ann, after));
  ASSERT_TRUE(engine.stop(ann, live));
  engine.advance();
  EXPECT_FALSE(engine.push(ann, performer.at(0.01)));
}

TEST(LiveAction, AllocatesNothingInAStep) {
  Engine engine = live_engine();
  const CharacterId ann = *engine.add(made_character());
  ASSERT_TRUE(engine.play(ann, of_clip("walk")));
  ASSERT_TRUE(engine.play(ann, LiveWish{}));
  const MadePerformer performer;
  std::vector<LivePosture> postures;
  for (int step = 1; step <= 200; ++step)
    postures.push_back(performer.at(step / kRate_hz));
  const long before = testing::allocations();
  for (int step = 0; step < 200; ++step) {
    if (step < 100 || step > 130) {
      if (!engine.push(ann, postures[static_cast<std::size_t>(step)])) FAIL();
    }
    engine.advance();
  }
  EXPECT_EQ(testing::allocations(), before);
}

}  // namespace
}  // namespace marey::engine
