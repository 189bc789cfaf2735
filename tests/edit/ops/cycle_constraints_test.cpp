// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "edit/ops/constrain.h"
#include "edit/ops/cyclify.h"
#include "edit/state/adapt_state.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "retarget/constraints/activation.h"
#include "retarget/constraints/check_constraints.h"
#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"
#include "tests/edit/varied_walk.h"

namespace marey::edit {
namespace {

constexpr int kFirst = 60;
constexpr int kPeriod = 66;  // Frames of one cycle of the walk at 60 Hz.
constexpr int kCopies = 4;

/// A walk of 1.1 s per cycle at 60 Hz that turns, and a loop of its frames 60 to 126.
struct LoopScene {
  EditState state;
  OpScene<CyclifyOp> loop;

  LoopScene() : loop(CyclifyOp{}) {
    VariedWalkOptions options;
    options.turn_rad = 0.3;
    state = state_of(varied_walk(options).motion);
    auto& op = std::get<CyclifyOp>(loop.op.parameters);
    op.from = AtFrame{kFirst};
    op.to = AtFrame{kFirst + kPeriod};
    op.cycles = kCopies;
  }

  EditState looped() {
    auto out = loop.run(apply_cyclify, state);
    EXPECT_TRUE(out) << (out ? "" : out.error().message());
    return out ? *std::move(out) : state;
  }
};

/// A constraint that is fully active in these frames.
Constraint in_frames(const std::string& id, Goal goal, int first, int last) {
  Constraint out;
  out.id = id;
  out.point.segment = "leftHand";
  out.goal = std::move(goal);
  out.activation = {first / 60.0 - 0.05, last / 60.0, 0.05, 0.05};
  return out;
}

double full_at(const Constraint& constraint, std::size_t frame) {
  return retarget::activation(constraint.activation, static_cast<double>(frame) / 60.0);
}

void expect_valid(const EditState& state) {
  std::set<std::string> ids;
  for (const Constraint& c : state.constraints.constraints) {
    EXPECT_TRUE(ids.insert(c.id).second) << c.id;
  }
  const auto character = character_of(state);
  ASSERT_TRUE(character);
  const Status ok = retarget::check_constraints(state.constraints, *character);
  EXPECT_TRUE(ok) << (ok ? "" : ok.error().message());
}

TEST(CycleConstraints, EachCopyHasThePlaceThatItsHandTouches) {
  LoopScene scene;
  const auto hand = joint_way(scene.state.motion, HumanBone::kLeftHand);
  constexpr int kMiddle = 20;  // Frame of the cycle.
  scene.state.constraints.constraints = {
      in_frames("rail",
                DistanceToPoint{0.0, hand[kFirst + kMiddle]},
                kFirst + kMiddle - 4,
                kFirst + kMiddle + 4)};
  const EditState out = scene.looped();
  expect_valid(out);
  ASSERT_EQ(out.constraints.constraints.size(), std::size_t{kCopies});
  EXPECT_FALSE(scene.loop.has_finding("constraints_dropped"));
  const auto way = joint_way(out.motion, HumanBone::kLeftHand);
  for (std::size_t copy = 0; copy < kCopies; ++copy) {
    const Constraint& c = out.constraints.constraints[copy];
    EXPECT_EQ(c.id, copy == 0 ? "rail" : "rail." + std::to_string(copy + 1));
    const std::size_t start = copy * kPeriod;
    const glm::dvec3 target = std::get<DistanceToPoint>(c.goal).p_in_world;
    EXPECT_LT(glm::distance(target, way[start + kMiddle]), 1e-9) << copy;
    EXPECT_EQ(full_at(c, start + kMiddle - 3), 1.0);
    EXPECT_EQ(full_at(c, start + kMiddle + 3), 1.0);
    EXPECT_EQ(full_at(c, start + kMiddle - 8), 0.0);
    EXPECT_EQ(full_at(c, start + kMiddle + 8), 0.0);
  }
}

TEST(CycleConstraints, AMissKeepsItsDistance) {
  LoopScene scene;
  const auto hand = joint_way(scene.state.motion, HumanBone::kLeftHand);
  const glm::dvec3 miss(0.03, 0.05, -0.02);
  scene.state.constraints.constraints = {
      in_frames("rail", DistanceToPoint{0.0, hand[kFirst + 30] + miss}, 88, 92)};
  const EditState out = scene.looped();
  const auto way = joint_way(out.motion, HumanBone::kLeftHand);
  for (std::size_t copy = 0; copy < out.constraints.constraints.size(); ++copy) {
    const auto& goal = std::get<DistanceToPoint>(out.constraints.constraints[copy].goal);
    EXPECT_NEAR(glm::distance(goal.p_in_world, way[copy * kPeriod + 30]),
                glm::length(miss),
                1e-9);
  }
}

TEST(CycleConstraints, DropsAndCountsConstraintsOutsideTheCycle) {
  LoopScene scene;
  const glm::dvec3 place(0.0, 1.0, 0.0);
  Constraint follower =
      in_frames("follower", DistanceToConstraint{0.1, "before"}, 70, 80);
  follower.point.segment = "rightHand";
  scene.state.constraints.constraints = {
      in_frames("before", DistanceToPoint{0.0, place}, 20, 40),
      in_frames("within", DistanceToPoint{0.0, place}, 70, 80),
      in_frames("after", DistanceToPoint{0.0, place}, 140, 150),
      in_frames("fades in at the end", DistanceToPoint{0.0, place}, 128, 150),
      follower};
  const EditState out = scene.looped();
  EXPECT_EQ(out.constraints.constraints.size(), std::size_t{kCopies});
  ASSERT_TRUE(scene.loop.has_finding("constraints_dropped"));
  EXPECT_NE(scene.loop.report.findings.front().cause.find("4 of 5 constraints"),
            std::string::npos)
      << scene.loop.report.findings.front().cause;
}

TEST(CycleConstraints, AConstraintOnTheBodyLastsOverTheSeams) {
  LoopScene scene;
  Constraint always;
  always.id = "hand on hip";
  always.point.segment = "leftHand";
  always.goal = DistanceToBody{0.2, {"hips", {0.15, 0.0, 0.0}}};
  scene.state.constraints.constraints = {always};
  const EditState out = scene.looped();
  ASSERT_EQ(out.constraints.constraints.size(), 1U);
  const Activation& when = out.constraints.constraints[0].activation;
  EXPECT_FALSE(when.start_s || when.stop_s);
}

TEST(CycleConstraints, APlaceThatIsHeldAlwaysChangesAtTheSeams) {
  LoopScene scene;
  Constraint always;
  always.id = "box";
  always.point.segment = "leftHand";
  always.goal = AllowedSpace{{-0.4, 0.0, -0.4}, {0.4, 2.0, 0.4}};
  scene.state.constraints.constraints = {always};
  const EditState out = scene.looped();
  expect_valid(out);
  ASSERT_EQ(out.constraints.constraints.size(), std::size_t{kCopies});
  for (std::size_t t = 0; t < out.motion.poses.size(); ++t) {
    double sum = 0.0;
    for (const Constraint& c : out.constraints.constraints) sum += full_at(c, t);
    EXPECT_NEAR(sum, 1.0, 1e-9) << t;
  }
}

TEST(CycleConstraints, InPlaceOnlyThoseWithoutAPlaceStay) {
  LoopScene scene;
  std::get<CyclifyOp>(scene.loop.op.parameters).drift = CycleDrift::kNone;
  scene.state.constraints.constraints = {
      in_frames("rail", DistanceToPoint{0.0, {0, 1, 0}}, 70, 80),
      in_frames("hip", DistanceToBody{0.2, {"hips", {}}}, 90, 100)};
  const EditState out = scene.looped();
  EXPECT_EQ(out.constraints.constraints.size(), std::size_t{kCopies});
  EXPECT_NE(out.constraints.find("hip.2"), nullptr);
  EXPECT_NE(scene.loop.report.findings.front().cause.find("1 of 2 constraints"),
            std::string::npos);
}

TEST(CycleConstraints, AFootprintThatWasMovedByHandStaysMoved) {
  LoopScene scene;
  ConstrainOp detect;
  detect.detect = DetectConstraints::kSupports;
  OpScene<ConstrainOp> detection(detect);
  scene.state = *detection.run(apply_constrain, scene.state);
  const EditState own = scene.looped();
  const glm::dvec3 by(0.02, 0.0, 0.015);
  for (Constraint& c : scene.state.constraints.constraints) {
    *std::get<Support>(c.goal).footprint_in_world += by;
  }
  const EditState moved = scene.looped();
  ASSERT_EQ(moved.constraints.constraints.size(), own.constraints.constraints.size());
  for (std::size_t k = 0; k < own.constraints.constraints.size(); ++k) {
    const auto print = [k](const EditState& state) {
      return *std::get<Support>(state.constraints.constraints[k].goal).footprint_in_world;
    };
    EXPECT_NEAR(glm::distance(print(moved), print(own)), glm::length(by), 1e-9);
  }
}

// The supports of a walk are those of its loop: one per stance over all copies, stances
// across seams included, and each footprint is where the foot stands.
TEST(CycleConstraints, SupportsOfAWalkAreMetByItsLoop) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    VariedWalkOptions options = random_walk_options(seed);
    options.noise_rad = 0.003;
    EditState state = state_of(varied_walk(options).motion);
    ConstrainOp detect;
    detect.detect = DetectConstraints::kSupports;
    OpScene<ConstrainOp> detection(detect);
    const auto found = detection.run(apply_constrain, state);
    ASSERT_TRUE(found);
    CyclifyOp cycle;
    cycle.cycles = 5;
    OpScene<CyclifyOp> loop(cycle);
    const auto looped = loop.run(apply_cyclify, *found);
    ASSERT_TRUE(looped) << looped.error().message();
    expect_valid(*looped);
    // Five cycles have five stances per foot, or six if one is cut by both ends.
    for (const char* foot : {"leftFoot", "rightFoot"}) {
      int flat = 0;
      for (const Constraint& c : looped->constraints.constraints) {
        const auto* support = std::get_if<Support>(&c.goal);
        flat += c.point.segment == foot && support != nullptr && !support->turns ? 1 : 0;
      }
      EXPECT_GE(flat, 5) << "seed " << seed;
      EXPECT_LE(flat, 6) << "seed " << seed;
    }
    ConstrainOp adapt;
    adapt.adapt = true;
    OpScene<ConstrainOp> now(adapt);
    const auto adapted = now.run(apply_constrain, *looped);
    ASSERT_TRUE(adapted) << adapted.error().message();
    EXPECT_EQ(now.figure("unmet"), 0.0) << "seed " << seed;
    EXPECT_LT(now.figure("displaced_mm"), 10.0) << "seed " << seed;
    EXPECT_LT(now.figure("slide_mm"), 0.1) << "seed " << seed;
  }
}

}  // namespace
}  // namespace marey::edit
