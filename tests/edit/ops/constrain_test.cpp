// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/constrain.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "edit/state/apply_contact_edits.h"
#include "edit/state/plant_feet.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/smooth_step.h"
#include "retarget/body/body_volume.h"
#include "retarget/constraints/activation.h"
#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {
namespace {

constexpr double kRate_hz = 60.0;

Constraint hand_at(const std::string& id, const glm::dvec3& p_in_world) {
  Constraint out;
  out.id = id;
  out.point.segment = "leftHand";
  out.goal = DistanceToPoint{0.0, p_in_world};
  out.activation.start_duration_s = 0.3;
  out.activation.stop_duration_s = 0.3;
  return out;
}

OpScene<ConstrainOp> placed(Constraint constraint, bool adapt = false) {
  ConstrainOp op;
  op.constraint = std::move(constraint);
  op.from = AtTime{1.0};
  op.to = AtTime{1.5};
  op.adapt = adapt;
  return OpScene<ConstrainOp>(op);
}

OpScene<ConstrainOp> detection(DetectConstraints kind) {
  ConstrainOp op;
  op.detect = kind;
  return OpScene<ConstrainOp>(op);
}

EditState done(OpScene<ConstrainOp>& scene, const EditState& state) {
  auto out = scene.run(apply_constrain, state);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return out ? *std::move(out) : state;
}

std::string refusal(OpScene<ConstrainOp> scene, const EditState& state) {
  const auto out = scene.run(apply_constrain, state);
  EXPECT_FALSE(out);
  return out ? std::string() : out.error().message();
}

TEST(ConstrainOp, AConstraintIsFullyActiveInItsIntervalAndTheHandIsThere) {
  EditState state = state_of(standing_motion(180));
  state.motion.first_frame = 1000;  // Times are since the first pose.
  const glm::dvec3 target =
      joint_way(state.motion, HumanBone::kLeftHand)[0] + glm::dvec3(0.05, 0.2, 0.2);
  OpScene<ConstrainOp> scene = placed(hand_at("grip", target), true);
  const EditState out = done(scene, state);
  const auto hand = joint_way(out.motion, HumanBone::kLeftHand);
  for (std::size_t t = 60; t <= 90; ++t) {
    EXPECT_LT(glm::distance(hand[t], target), 1e-3 + 2e-5) << t;
  }
  for (std::size_t t = 0; t < 180; ++t) {
    const bool is_outside = t <= 41 || t >= 109;
    EXPECT_EQ(same_pose(out.motion.poses[t], state.motion.poses[t]), is_outside) << t;
  }
  EXPECT_EQ(out.motion.first_frame, 1000);
  EXPECT_LT(scene.figure("error_mm.grip"), 1.02);
  EXPECT_EQ(scene.figure("unmet"), 0.0);
  EXPECT_FALSE(scene.has_finding("constraint"));
}

TEST(ConstrainOp, AnnotationsStateTheInterval) {
  EditState state = state_of(standing_motion(180));
  state.annotations.notes = {{"door", 0.5, 2.0}};
  OpScene<ConstrainOp> scene = placed(hand_at("grip", {0.3, 1.2, 0.3}));
  auto& op = std::get<ConstrainOp>(scene.op.parameters);
  op.from = AtAnnotation{"door", 0};
  op.to = AtAnnotation{"door", 0};
  const EditState out = done(scene, state);
  const Activation& when = out.constraints.find("grip")->activation;
  EXPECT_EQ(retarget::activation(when, 0.5), 1.0);
  EXPECT_EQ(retarget::activation(when, 2.0), 1.0);
  EXPECT_EQ(retarget::activation(when, 0.19), 0.0);
  EXPECT_EQ(retarget::activation(when, 2.31), 0.0);
}

TEST(ConstrainOp, ATargetOutOfReachIsReportedAsUnmet) {
  const EditState state = state_of(standing_motion(180));
  OpScene<ConstrainOp> scene = placed(hand_at("moon", {0.0, 3.5, 0.0}), true);
  (void)done(scene, state);
  ASSERT_TRUE(scene.has_finding("constraint"));
  EXPECT_EQ(scene.report.findings.front().where, "constraint \"moon\"");
  EXPECT_GT(scene.figure("error_mm.moon"), 800.0);
  EXPECT_EQ(scene.figure("unmet"), 1.0);
}

TEST(ConstrainOp, BadConstraintsAreRefused) {
  const EditState state = state_of(standing_motion(180));
  Constraint unknown = hand_at("grip", {0.3, 1.2, 0.3});
  unknown.point.segment = "leftHnad";
  EXPECT_NE(refusal(placed(unknown), state).find("leftHand"), std::string::npos);

  OpScene<ConstrainOp> first = placed(hand_at("grip", {0.3, 1.2, 0.3}));
  const EditState once = done(first, state);
  EXPECT_NE(refusal(first, once).find("already placed"), std::string::npos);

  Constraint inside = hand_at("inside", {});
  inside.goal = AllowedSpace{{0, 0, 0}, {1, 1, 1}};
  Constraint apart = hand_at("apart", {});
  apart.goal = AllowedSpace{{2, 2, 2}, {3, 3, 3}};
  OpScene<ConstrainOp> box = placed(inside);
  const EditState boxed = done(box, state);
  const std::string contradiction = refusal(placed(apart), boxed);
  EXPECT_NE(contradiction.find("inside"), std::string::npos) << contradiction;

  OpScene<ConstrainOp> nothing{ConstrainOp{}};
  EXPECT_NE(refusal(nothing, state).find("nothing to do"), std::string::npos);
  OpScene<ConstrainOp> reversed = placed(hand_at("grip", {0.3, 1.2, 0.3}));
  std::get<ConstrainOp>(reversed.op.parameters).to = AtTime{0.5};
  EXPECT_FALSE(refusal(reversed, state).empty());
  EXPECT_NE(refusal(placed(hand_at("found door 1", {})), state).find("no detection"),
            std::string::npos);
}

/// Stances of the walk that end within the motion, from its own truth.
std::vector<FrameRange> true_stances(const testing::SyntheticWalk& walk,
                                     std::size_t side) {
  std::vector<FrameRange> out;
  const std::vector<char>& ball = walk.feet[side].ball;
  for (int t = 0; t < static_cast<int>(ball.size()); ++t) {
    if (!ball[static_cast<std::size_t>(t)]) continue;
    if (out.empty() || out.back().last + 1 < t) out.push_back({t, t});
    out.back().last = t;
  }
  return out;
}

TEST(ConstrainOp, DetectedSupportsAreTheStancesOfTheWalk) {
  const auto walk = testing::synthetic_walk(300, kRate_hz);
  const EditState state = state_of(walk.motion);
  OpScene<ConstrainOp> scene = detection(DetectConstraints::kSupports);
  const EditState out = done(scene, state);
  EXPECT_FALSE(scene.has_finding("contradiction"));
  for (std::size_t side = 0; side < 2; ++side) {
    const HumanBone foot = side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
    const auto ankle = joint_way(walk.motion, foot);
    for (const FrameRange& run : true_stances(walk, side)) {
      // A foot's supports together are fully active from touch-down to toe-off, to within
      // 3 frames, the window of the detector's speed.
      const auto supported = [&](int frame) {
        double most = 0.0;
        for (const Constraint& c : out.constraints.constraints) {
          if (c.point.segment != name(foot)) continue;
          most = std::max(most, retarget::activation(c.activation, frame / kRate_hz));
        }
        return most;
      };
      for (int t = run.first + 3; t <= run.last - 3; ++t) {
        EXPECT_EQ(supported(t), 1.0) << name(foot) << " frame " << t;
      }
      if (run.first == 0 || run.last == 299) continue;
      EXPECT_LT(supported(run.first - 4), 1.0);
      EXPECT_LT(supported(run.last + 4), 1.0);
      // The footprint is where the flat foot stood.
      const int flat = run.first + (run.last - run.first) / 4;
      bool has_print = false;
      for (const Constraint& c : out.constraints.constraints) {
        const auto* support = std::get_if<Support>(&c.goal);
        if (c.point.segment != name(foot) || support == nullptr || support->turns ||
            retarget::activation(c.activation, flat / kRate_hz) < 1.0) {
          continue;
        }
        has_print = true;
        EXPECT_LT(glm::distance(*support->footprint_in_world,
                                ankle[static_cast<std::size_t>(flat)]),
                  2e-3);
      }
      EXPECT_TRUE(has_print);
    }
  }
}

TEST(ConstrainOp, ASecondDetectionReplacesTheFirstAndKeepsChangesByHand) {
  const EditState state = state_of(testing::synthetic_walk(300, kRate_hz).motion);
  OpScene<ConstrainOp> scene = detection(DetectConstraints::kSupports);
  const EditState once = done(scene, state);
  const std::size_t count = once.constraints.constraints.size();
  const EditState twice = done(scene, once);
  EXPECT_EQ(twice.constraints.constraints.size(), count);

  const Constraint* second = once.constraints.find("found leftFoot flat 2");
  ASSERT_NE(second, nullptr);
  ConstrainOp change;
  change.constraint.emplace().id = second->id;
  const double stop_s = *second->activation.stop_s - 0.05;
  change.to = AtTime{stop_s};
  OpScene<ConstrainOp> by_hand(change);
  const EditState changed = done(by_hand, once);
  ASSERT_NE(changed.constraints.find("leftFoot flat 2"), nullptr);
  EXPECT_EQ(changed.constraints.find("found leftFoot flat 2"), nullptr);

  const EditState again = done(scene, changed);
  EXPECT_EQ(scene.figure("changed_by_hand"), 1.0);
  EXPECT_EQ(again.constraints.constraints.size(), count);
  const Constraint* kept = again.constraints.find("leftFoot flat 2");
  ASSERT_NE(kept, nullptr);
  EXPECT_NEAR(*kept->activation.stop_s, stop_s, 1e-3);
  EXPECT_EQ(again.constraints.find("found leftFoot flat 2"), nullptr);
}

TEST(ConstrainOp, EdgesOfContactsMovedByHandAreThoseOfTheSupports) {
  EditState state = state_of(testing::synthetic_walk(300, kRate_hz).motion);
  const FrameRange run = state.contacts.feet[0].heel[1];
  const double end_s = run.last / kRate_hz;
  state.contact_edits = {
      {ContactEdit::Kind::kMoveEnd, 0, FootPart::kHeel, end_s, end_s - 0.1}};
  detect_contacts_again(state);
  OpScene<ConstrainOp> scene = detection(DetectConstraints::kSupports);
  const EditState out = done(scene, state);
  bool found = false;
  for (const Constraint& c : out.constraints.constraints) {
    if (!c.id.starts_with("found leftFoot flat") || !c.activation.stop_s) continue;
    found = found || std::abs(*c.activation.stop_s - (end_s - 0.1)) < 2e-3;
    EXPECT_GT(std::abs(*c.activation.stop_s - end_s), 0.05);
  }
  EXPECT_TRUE(found);
}

// Supports that fade add a share of their displacement to the moving foot; they do not
// pull it towards the footprint, from which it is 30 cm away half a fade before.
TEST(ConstrainOp, SupportsFoundInAWalkHardlyMoveIt) {
  const EditState state = state_of(testing::synthetic_walk(300, kRate_hz).motion);
  OpScene<ConstrainOp> scene = detection(DetectConstraints::kSupports);
  std::get<ConstrainOp>(scene.op.parameters).adapt = true;
  (void)done(scene, state);
  EXPECT_EQ(scene.figure("unmet"), 0.0);
  // Planting lowers the root where a leg is straighter than it allows.
  EXPECT_LT(scene.figure("displaced_mm"), 30.0);
  EXPECT_LT(scene.figure("slide_mm"), 0.1);
}

TEST(ConstrainOp, ADetectedTouchThatNoPostureMeetsIsLeftOut) {
  EditState state = state_of(standing_motion(180));
  Constraint out_of_reach = hand_at("found left hand still 1", {0.0, 3.5, 0.0});
  out_of_reach.activation = {0.7, 1.5, 0.3, 0.3};
  Constraint near = hand_at("found right hand still 1", {});
  near.point.segment = "rightHand";
  near.activation = out_of_reach.activation;
  near.goal = DistanceToPoint{
      0.0,
      joint_way(state.motion, HumanBone::kRightHand)[0] + glm::dvec3(0.0, 0.05, 0.05)};
  state.constraints.constraints = {out_of_reach, near};
  ConstrainOp adapt;
  adapt.adapt = true;
  OpScene<ConstrainOp> scene(adapt);
  const EditState out = done(scene, state);
  EXPECT_TRUE(scene.has_finding("touch_left_out"));
  EXPECT_EQ(scene.figure("left_out"), 1.0);
  EXPECT_EQ(scene.figure("unmet"), 0.0);
  ASSERT_EQ(out.constraints.constraints.size(), 1U);
  EXPECT_EQ(out.constraints.constraints[0].id, near.id);
  const auto is = joint_way(out.motion, HumanBone::kLeftHand);
  const auto was = joint_way(state.motion, HumanBone::kLeftHand);
  EXPECT_LT(glm::distance(is[75], was[75]), 0.02);
}

// Planting and detection agree on the footprints, so adaptation adds no movement.
TEST(ConstrainOp, SupportsFoundInNoisyWalksAddNoAcceleration) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Motion motion = testing::synthetic_walk(240, kRate_hz).motion;
    add_motion_noise(motion, seed, 0.004, 0.001);
    EditState planted = state_of(motion);
    OpScene<ConstrainOp> scene = detection(DetectConstraints::kSupports);
    std::get<ConstrainOp>(scene.op.parameters).adapt = true;
    const EditState out = done(scene, planted);
    plant_feet(planted);
    for (const HumanBone bone : {HumanBone::kLeftLowerLeg, HumanBone::kRightFoot}) {
      const auto a = joint_way(planted.motion, bone);
      const auto b = joint_way(out.motion, bone);
      for (std::size_t t = 1; t + 1 < a.size(); ++t) {
        const glm::dvec3 bend =
            (b[t + 1] - a[t + 1]) - 2.0 * (b[t] - a[t]) + (b[t - 1] - a[t - 1]);
        EXPECT_LT(glm::length(bend) * kRate_hz * kRate_hz, 10.0)
            << "seed " << seed << " frame " << t;
      }
    }
  }
}

/// A hand goes down on the top of a table, rests there from frame 90 to 150, and leaves.
/// The gap between the hand's surface and the table is 1 cm.
struct TableScene {
  EditObject table{"table", {-1.0, 0.0, 0.1}, {1.0, 0.9, 1.0}};
  Motion motion;

  TableScene() {
    motion = standing_motion(240);
    const auto map = retarget::map_body(motion.skeleton);
    const auto volume = retarget::average_volume(motion.skeleton, *map);
    const retarget::Capsule& hand = *volume[retarget::VolumePart::kLeftHand];
    LimbBender bender(motion.skeleton, *map);
    const glm::dquat level(1, 0, 0, 0);
    const glm::dvec3 middle = retarget::axis_point_in_joint(hand, 0.0);
    for (int t = 0; t < 240; ++t) {
      const double share = smooth_step((t - 40) / 50.0) *
                           smooth_step((200 - t) / 50.0);
      const double height_m = 0.9 + hand.radius_m + 0.01 + 0.3 * (1.0 - share);
      const glm::dvec3 wrist =
          glm::dvec3(0.25, height_m, 0.3) - glm::dvec3(middle.x, middle.y, middle.z);
      bender.move_end(0, wrist, level, motion.poses[static_cast<std::size_t>(t)]);
    }
  }
};

TEST(ConstrainOp, AHandThatRestsOnATableIsFoundAndMeetsItsSurface) {
  const TableScene scene;
  const EditState state = state_of(scene.motion);
  OpScene<ConstrainOp> op = detection(DetectConstraints::kTouches);
  std::get<ConstrainOp>(op.op.parameters).objects = {scene.table};
  const EditState out = done(op, state);
  const Constraint* touch = out.constraints.find("found left hand on table 1");
  ASSERT_NE(touch, nullptr);
  EXPECT_EQ(out.constraints.find("found left hand on table 2"), nullptr);
  EXPECT_EQ(out.constraints.find("found right hand on table 1"), nullptr);
  const auto& goal = std::get<DistanceToPoint>(touch->goal);
  EXPECT_NEAR(goal.p_in_world.y, 0.9, 1e-9);
  // The hand rests from frame 90 to 150; it is within 3 cm and slow a little longer.
  for (int t = 90; t <= 150; ++t) {
    EXPECT_EQ(retarget::activation(touch->activation, t / kRate_hz), 1.0) << t;
  }
  const double start_s = *touch->activation.start_s + touch->activation.start_duration_s;
  EXPECT_GT(start_s, 70.0 / kRate_hz);
  EXPECT_LT(*touch->activation.stop_s, 170.0 / kRate_hz);
  const auto way = joint_way(scene.motion, HumanBone::kLeftHand);
  const auto fade_start =
      static_cast<std::size_t>(std::ceil(*touch->activation.start_s * kRate_hz));
  EXPECT_LT(glm::distance(way[fade_start], way[120]), 0.06);

  // Adapted, the hand's surface is on the table, 1 cm lower.
  ConstrainOp adapt;
  adapt.adapt = true;
  OpScene<ConstrainOp> now(adapt);
  const EditState adapted = done(now, out);
  const auto was = joint_way(scene.motion, HumanBone::kLeftHand);
  const auto is = joint_way(adapted.motion, HumanBone::kLeftHand);
  EXPECT_LT(now.figure("error_mm.found left hand on table 1"), 5.02);
  EXPECT_LT(is[120].y, was[120].y - 0.004);
}

TEST(ConstrainOp, AHandThatOnlyPassesOrStaysAwayIsNotFound) {
  TableScene scene;
  scene.table.max_in_world.y = 0.85;  // 6 cm below the hand.
  OpScene<ConstrainOp> op = detection(DetectConstraints::kTouches);
  std::get<ConstrainOp>(op.op.parameters).objects = {scene.table};
  const EditState out = done(op, state_of(scene.motion));
  EXPECT_EQ(out.constraints.find("found left hand on table 1"), nullptr);
}

TEST(ConstrainOp, BadObjectsAreRefusedWithTheirName) {
  const EditState state = state_of(standing_motion(60));
  OpScene<ConstrainOp> op = detection(DetectConstraints::kTouches);
  auto& objects = std::get<ConstrainOp>(op.op.parameters).objects;
  objects = {{"door", {1, 0, 0}, {0, 1, 1}}};
  EXPECT_NE(refusal(op, state).find("door"), std::string::npos);
  objects = {{"door", {0, 0, 0}, {1, 1, 1}}, {"door", {0, 0, 0}, {1, 1, 1}}};
  EXPECT_NE(refusal(op, state).find("twice"), std::string::npos);
  OpScene<ConstrainOp> supports = detection(DetectConstraints::kSupports);
  std::get<ConstrainOp>(supports.op.parameters).objects = {
      {"door", {0, 0, 0}, {1, 1, 1}}};
  EXPECT_NE(refusal(supports, state).find("objects"), std::string::npos);
}

TEST(ConstrainOp, ADetectionLimitedToASpanLeavesTheRest) {
  const EditState state = state_of(testing::synthetic_walk(300, kRate_hz).motion);
  OpScene<ConstrainOp> scene = detection(DetectConstraints::kSupports);
  const EditState whole = done(scene, state);
  scene.op.span = {AtTime{0.0}, AtTime{2.0}};
  const EditState part = done(scene, state);
  EXPECT_LT(part.constraints.constraints.size(), whole.constraints.constraints.size());
  const EditState again = done(scene, whole);
  EXPECT_EQ(again.constraints.constraints.size(), whole.constraints.constraints.size());
}

}  // namespace
}  // namespace marey::edit
