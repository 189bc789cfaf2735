// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Switches between clips on bodies unlike that of the clips.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "engine/engine.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/made_base.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::engine {
namespace {

constexpr double kSwitchHz = 120.0;

struct SwitchFigures {
  double hips_m = 0.0;     ///< Farthest from the blend's.
  double extension = 0.0;  ///< Greatest, of a leg.
  double slide_m_s = 0.0;  ///< For feet that stand longer than 0.1 s.
  double settled_s = 0.0;  ///< Until the new clip has 0.9 of the weight.
};

Action action_of(const CharacterPlayer& player, ActionId id) {
  const Action* action = player.blend().find(id);
  return action == nullptr ? Action{} : *action;
}

void add_pose(const CharacterPlayer& player, SwitchFigures& out) {
  const auto joints = player.world_from_joint();
  const auto place = [&](JointIndex joint) { return joints[index(joint)].translation; };
  out.hips_m =
      std::max(out.hips_m,
               glm::distance(place(player.map().hips()), player.blend_hips_in_world()));
  for (const int side : {0, 1}) {
    const retarget::LimbMap& leg = player.map().leg(side);
    out.extension = std::max(
        out.extension, glm::distance(place(leg.upper), place(leg.end)) / leg.length_m());
  }
}

// Walks, then switches to another clip after some time.
SwitchFigures play_switch(const Skeleton& body, const std::string& to, int at) {
  Engine engine = *Engine::make(made_base(), {.step_hz = kSwitchHz});
  const CharacterId who = *engine.add(made_character(body));
  ActionWish walk;
  walk.clip = "walk";
  (void)*engine.play(who, walk);
  const CharacterPlayer& player = engine.player(who);
  SwitchFigures out;
  std::optional<ActionId> next;
  std::array<int, 2> stood{};
  std::array<glm::dvec3, 2> ball_before{};
  std::array<glm::dvec3, 2> ankle_before{};
  for (int step = 0; step < at + 100; ++step) {
    if (step == at) {
      ActionWish wish;
      wish.clip = to;
      next = *engine.play(who, wish);
    }
    engine.advance();
    add_pose(player, out);
    for (std::size_t side = 0; side < 2; ++side) {
      const HumanBone bone = side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
      const auto joints = player.world_from_joint();
      const glm::dvec3 ball =
          joints[index(*player.map().joint_of[index(bone)])].translation;
      const glm::dvec3 ankle =
          joints[index(player.map().leg(static_cast<int>(side)).end)].translation;
      stood[side] = player.report().stands[side] ? stood[side] + 1 : 0;
      // A foot stands on its heel or on its ball.
      if (stood[side] > 12) {
        out.slide_m_s =
            std::max(out.slide_m_s,
                     kSwitchHz * std::min(glm::distance(ball, ball_before[side]),
                                          glm::distance(ankle, ankle_before[side])));
      }
      ball_before[side] = ball;
      ankle_before[side] = ankle;
    }
    if (next && action_of(player, *next).fade(engine.time_s()) < 0.9) {
      out.settled_s = (step - at + 1) / kSwitchHz;
    }
  }
  return out;
}

TEST(Switches, KeepFeetHipsAndLegsOnFiveBodies) {
  testing::Dice dice(22);
  std::vector<Skeleton> bodies;
  for (int i = 0; i < 5; ++i) bodies.push_back(testing::random_humanoid(dice));
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (int i = 0; i < 8; ++i) {
      const int at = 130 + 17 * i;
      for (const char* to : {"stroll", "steps"}) {
        const SwitchFigures figures = play_switch(bodies[b], to, at);
        EXPECT_LT(figures.hips_m, 0.031) << b << " " << to << " " << at;
        EXPECT_LE(figures.extension, 0.999) << b << " " << to << " " << at;
        EXPECT_LT(figures.slide_m_s, 0.01) << b << " " << to << " " << at;
        EXPECT_LE(figures.settled_s, 0.35) << b << " " << to << " " << at;
      }
    }
  }
}

// The fade begins later only if the weights pass in time.
TEST(Switches, DoNotDelayLongFades) {
  for (int at = 130; at < 270; at += 23) {
    Engine engine = *Engine::make(made_base(), {.step_hz = kSwitchHz});
    const CharacterId who = *engine.add(made_character());
    ActionWish walk;
    walk.clip = "walk";
    (void)*engine.play(who, walk);
    for (int step = 0; step < at; ++step) engine.advance();
    ActionWish wish;
    wish.clip = "stroll";
    wish.fade_in_s = 0.6;
    const ActionId id = *engine.play(who, wish);
    const double now_s = engine.time_s();
    engine.advance();
    EXPECT_LE(action_of(engine.player(who), id).started_s, now_s + 1e-9);
  }
}

}  // namespace
}  // namespace marey::engine
