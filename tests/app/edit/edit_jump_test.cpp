// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_jump.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace marey::app {
namespace {

using JumpMessage = nlohmann::json;

dynamics::Jump whole_jump() {
  dynamics::Jump jump;
  jump.start.time_s = 0.5;
  jump.lowest_s = 0.8;
  jump.lowest_m = 0.7;
  jump.takeoff.time_s = 1.0;
  jump.takeoff.p_in_world = {0.0, 1.1, 0.0};
  jump.apex_s = 1.25;
  jump.apex_m = 1.4;
  jump.touchdown = dynamics::ComState{1.5, {0.0, 1.05, 0.0}, {0.0, -2.5, 0.0}};
  jump.takeoff_source = Source::kMeasured;
  jump.fall_m_s2 = -12.2;
  jump.findings.emplace_back();
  jump.findings.back().id = "gravity";
  return jump;
}

EditJump made_jump() {
  EditJump out;
  out.revision = 7;
  out.op = 2;
  out.output = 1;
  out.number = 2;
  edit::JumpGraph& graph = out.graph;
  graph.time_s = {0.5, 0.51};
  graph.height_m = {1.0, 1.000004};
  graph.captured_height_m = {1.0, std::numeric_limits<double>::quiet_NaN()};
  graph.push_g = {1.0, 0.98765432};
  graph.captured_push_g = {1.0, 1.0};
  graph.start_s = 0.5;
  graph.lowest_s = 0.75;
  graph.takeoff_s = 1.0;
  graph.apex_s = 1.3;
  graph.landing_s = 1.6;
  graph.end_s = 2.0;
  graph.strength_g = 3.5;
  graph.space = {
      {0.5,
       {{0.6, dynamics::PushRule::kForce, 0.1}, {0.8, dynamics::PushRule::kRise, 0.9}}},
      {0.51,
       {{0.61, dynamics::PushRule::kFall, 0.0}, {0.79, dynamics::PushRule::kFall, 0.2}}}};
  graph.space_lowest_at = 0.505;
  graph.space_lowest_m = 0.7;
  graph.jumps = {dynamics::Jump{}, whole_jump()};
  return out;
}

TEST(EditJumpMessage, HasTheCurvesThePhasesAndTheSpace) {
  const std::string text = jump_json({1, "jump", "q"}, made_jump());
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const JumpMessage json = JumpMessage::parse(text);
  EXPECT_EQ(json.at("type"), "jump");
  EXPECT_EQ(json.at("id"), "q");
  EXPECT_EQ(json.at("revision"), 7);
  EXPECT_EQ(json.at("op"), 2);
  EXPECT_EQ(json.at("output"), 1);
  EXPECT_EQ(json.at("number"), 2);
  EXPECT_EQ(json.at("refusal"), "");
  EXPECT_EQ(json.at("time_s"), JumpMessage({0.5, 0.51}));
  EXPECT_EQ(json.at("height_m"), JumpMessage({1.0, 1.0}));
  EXPECT_EQ(json.at("captured_height_m"), JumpMessage({1.0, nullptr}));
  EXPECT_EQ(json.at("push_g"), JumpMessage({1.0, 0.9877}));
  EXPECT_EQ(json.at("phases").at("lowest_s"), 0.75);
  EXPECT_EQ(json.at("phases").at("end_s"), 2.0);
  EXPECT_EQ(json.at("strength_g"), 3.5);
  ASSERT_EQ(json.at("space").size(), 2U);
  EXPECT_EQ(json.at("space")[0], JumpMessage({0.5, 0.6, 0.8, "force", "rise"}));
  EXPECT_EQ(json.at("space")[1], JumpMessage({0.51, 0.61, 0.79, "fall", "fall"}));
  EXPECT_EQ(json.at("lowest").at("at"), 0.505);
}

TEST(EditJumpMessage, ListsTheFoundJumpsAsCaptured) {
  const JumpMessage json = JumpMessage::parse(jump_json({}, made_jump()));
  ASSERT_EQ(json.at("jumps").size(), 2U);
  const JumpMessage& cut_off = json.at("jumps")[0];
  EXPECT_TRUE(cut_off.at("airtime_s").is_null());
  EXPECT_TRUE(cut_off.at("landing_s").is_null());
  EXPECT_TRUE(cut_off.at("lowest_at").is_null()) << "the push has no duration";
  const JumpMessage& jump = json.at("jumps")[1];
  EXPECT_EQ(jump.at("airtime_s"), 0.5);
  EXPECT_EQ(jump.at("rise_m"), 0.3);
  EXPECT_EQ(jump.at("fall_m_s2"), -12.2);
  EXPECT_EQ(jump.at("lowest_at"), 0.6);
  EXPECT_EQ(jump.at("takeoff"), "measured");
  EXPECT_EQ(jump.at("landing"), "inferred");
  EXPECT_TRUE(jump.at("end_s").is_null());
  EXPECT_EQ(jump.at("findings")[0].at("id"), "gravity");
}

TEST(EditJumpMessage, HasTheReasonInPlaceOfPhasesIfThereIsNoPlan) {
  EditJump jump = made_jump();
  jump.graph.refusal = "the body does not get that high";
  jump.graph.space.clear();
  jump.graph.strength_g = 0.0;
  const JumpMessage json = JumpMessage::parse(jump_json({}, jump));
  EXPECT_EQ(json.at("refusal"), jump.graph.refusal);
  EXPECT_TRUE(json.at("phases").is_null());
  EXPECT_TRUE(json.at("lowest").is_null());
  EXPECT_TRUE(json.at("strength_g").is_null());
  EXPECT_TRUE(json.at("space").empty());
}

TEST(EditJumpMessage, IsDeclinedForAnotherOperation) {
  EditRecipe recipe;
  recipe.ops.push_back({MirrorOp{}});
  const edit::EditInputs inputs;
  const edit::EditState state;
  for (const int op : {0, 1, -1}) {
    const auto graph = jump_graph_of(recipe, op, inputs, state);
    ASSERT_FALSE(graph) << op;
    EXPECT_NE(graph.error().message().find("is not a jump"), std::string::npos);
  }
}

}  // namespace
}  // namespace marey::app
