// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <variant>

#include "edit/ops/constrain.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {
namespace {

OpScene<ConstrainOp> support_detection() {
  ConstrainOp op;
  op.detect = DetectConstraints::kSupports;
  return OpScene<ConstrainOp>(op);
}

EditState constrained(OpScene<ConstrainOp>& scene, const EditState& state) {
  auto out = scene.run(apply_constrain, state);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return out ? *std::move(out) : state;
}

TEST(ConstraintChanges, ChangesByHandMoveEdgesAndPlacesAndSurviveANewDetection) {
  const EditState state = state_of(testing::synthetic_walk(300, 60.0).motion);
  OpScene<ConstrainOp> detect = support_detection();
  const EditState once = constrained(detect, state);
  const Constraint was = *once.constraints.find("found leftFoot flat 2");
  ConstraintChange change{was.id};
  const double start_s = *was.activation.start_s - 0.07;
  const double stop_s = *was.activation.stop_s - 0.04;
  change.start = AtTime{start_s};
  change.stop = AtTime{stop_s};
  const glm::dvec3 by(0.03, 0.0, -0.02);
  change.p_in_world = *std::get<Support>(was.goal).footprint_in_world + by;
  OpScene<ConstrainOp> both = support_detection();
  std::get<ConstrainOp>(both.op.parameters).changes = {change};
  const EditState changed = constrained(both, state);
  const EditState again = constrained(detect, changed);
  for (const EditState* s : {&changed, &again}) {
    EXPECT_EQ(s->constraints.constraints.size(), once.constraints.constraints.size());
    EXPECT_EQ(s->constraints.find("found leftFoot flat 2"), nullptr);
    const Constraint* is = s->constraints.find("leftFoot flat 2");
    ASSERT_NE(is, nullptr);
    EXPECT_EQ(is->activation.start_s, start_s);
    EXPECT_EQ(is->activation.stop_s, stop_s);
    EXPECT_EQ(is->activation.start_duration_s, was.activation.start_duration_s);
    EXPECT_EQ(std::get<Support>(is->goal).footprint_in_world, change.p_in_world);
    // The ball of the same stance moves along; the stances before and after stay.
    int moved = 0;
    for (const Constraint& c : once.constraints.constraints) {
      const Constraint* now = s->constraints.find(c.id);
      if (now == nullptr) now = s->constraints.find(c.id.substr(c.id.find(' ') + 1));
      ASSERT_NE(now, nullptr) << c.id;
      const glm::dvec3 way = *std::get<Support>(now->goal).footprint_in_world -
                             *std::get<Support>(c.goal).footprint_in_world;
      if (glm::length(way) == 0.0) continue;
      ++moved;
      EXPECT_LT(glm::distance(way, by), 1e-12) << c.id;
      EXPECT_EQ(c.point.segment, "leftFoot");
    }
    EXPECT_EQ(moved, 2);
  }
}

TEST(ConstraintChanges, AChangeOfAFadeKeepsTheFullTime) {
  const EditState state = state_of(testing::synthetic_walk(300, 60.0).motion);
  OpScene<ConstrainOp> scene = support_detection();
  const Constraint was =
      *constrained(scene, state).constraints.find("found rightFoot flat 2");
  ConstraintChange change{was.id};
  change.start_duration_s = 0.3;
  std::get<ConstrainOp>(scene.op.parameters).changes = {change};
  const EditState out = constrained(scene, state);
  const Activation& is = out.constraints.find("rightFoot flat 2")->activation;
  EXPECT_EQ(is.start_duration_s, 0.3);
  EXPECT_NEAR(*is.start_s + 0.3,
              *was.activation.start_s + was.activation.start_duration_s,
              1e-12);
  EXPECT_EQ(is.stop_s, was.activation.stop_s);
}

TEST(ConstraintChanges, AChangeOfAnUnknownConstraintIsRefusedWithTheNearestName) {
  const EditState state = state_of(testing::synthetic_walk(300, 60.0).motion);
  OpScene<ConstrainOp> scene = support_detection();
  ConstraintChange change{"found leftFoot falt 2"};
  change.stop = AtTime{1.0};
  std::get<ConstrainOp>(scene.op.parameters).changes = {change};
  const auto out = scene.run(apply_constrain, state);
  ASSERT_FALSE(out);
  const std::string text = out.error().message();
  EXPECT_NE(text.find("found leftFoot flat 2"), std::string::npos) << text;
}

}  // namespace
}  // namespace marey::edit
