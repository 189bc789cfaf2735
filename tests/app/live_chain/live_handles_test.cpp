// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_handles.h"

#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/humanoid.h"

namespace marey::app {
namespace {

constexpr double kStep_s = 1.0 / 30.0;
constexpr std::array<retarget::StandingFoot, 2> kBothStand{{{true, true}, {true, true}}};

/// An avatar that sways, with its root 5 cm below the rest pose, and its handles.
class DraggedAvatar : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = LiveHandles::make("man", skeleton_);
    ASSERT_TRUE(made) << made.error().message();
    handles_.emplace(*std::move(made));
  }

  [[nodiscard]] Pose source(int frame) const {
    Pose pose = rest_pose(skeleton_);
    pose.root_in_world.y -= 0.05;
    const double angle = 0.1 * std::sin(0.2 * frame);
    const auto spine = *skeleton_.find(HumanBone::kSpine);
    pose.parent_from_joint[index(spine)] = {std::cos(angle), 0.0, 0.0, std::sin(angle)};
    return pose;
  }

  /// The next frame's posture.
  Pose step() {
    Pose pose = source(frame_++);
    const auto joints = world_from_joints(skeleton_, pose);
    handles_->step(joints, kBothStand, kStep_s, pose);
    return pose;
  }

  [[nodiscard]] glm::dvec3 place(const Pose& pose, const char* id) const {
    for (const HandleState& state : handles_->handles()) {
      if (state.id != id) continue;
      return world_from_joints(skeleton_, pose)[index(state.joint)].translation;
    }
    ADD_FAILURE() << "no handle " << id;
    return {};
  }

  static bool are_same(const Pose& a, const Pose& b) {
    return a.root_in_world == b.root_in_world &&
           a.parent_from_joint == b.parent_from_joint;
  }

  Skeleton skeleton_ = make_humanoid(average_proportions(1.75));
  std::optional<LiveHandles> handles_;
  int frame_ = 0;
};

TEST_F(DraggedAvatar, KeepsTheSourcePoseWhileNoHandleIsDragged) {
  EXPECT_EQ(handles_->handles().size(), 6U);
  for (int i = 0; i < 5; ++i) {
    const Pose pose = step();
    EXPECT_TRUE(are_same(pose, source(i)));
    EXPECT_EQ(handles_->handles()[1].p_in_world, place(pose, "left hand"));
  }
  handles_->ask({"tail", HandleAction::kMove, {}});
  handles_->ask({"hips", HandleAction::kStop, {}});
  EXPECT_TRUE(are_same(step(), source(5)));
  EXPECT_FALSE(handles_->is_busy());
}

TEST_F(DraggedAvatar, ReachesForWhereItIsDraggedOnFeetThatStand) {
  const glm::dvec3 from = place(step(), "left hand");
  const glm::dvec3 to(0.35, 1.25, 0.45);
  Pose before = step();
  for (int i = 0; i <= 30; ++i) {
    const double share = std::min(1.0, i / 15.0);
    handles_->ask({"left hand", HandleAction::kMove, from + share * (to - from)});
    const Pose pose = step();
    // The target moves by 0.62 m in half a second, and the body sways. The hand does not
    // jump.
    EXPECT_LT(glm::distance(place(pose, "left hand"), place(before, "left hand")), 0.12);
    before = pose;
    for (const char* foot : {"left foot", "right foot"}) {
      EXPECT_LT(glm::distance(place(pose, foot), place(source(frame_ - 1), foot)), 1e-4)
          << foot << " in frame " << i;
    }
  }
  EXPECT_LT(glm::distance(place(before, "left hand"), to), 1e-3);
  // The hand stays at its place after its release.
  for (int i = 0; i < 10; ++i) before = step();
  EXPECT_LT(glm::distance(place(before, "left hand"), to), 1e-3);
  EXPECT_TRUE(handles_->handles()[1].active);
}

TEST_F(DraggedAvatar, GoesItsOwnWayAgainAsItIsStopped) {
  step();
  handles_->ask({"left hand", HandleAction::kMove, {0.35, 1.25, 0.45}});
  handles_->ask({"hips", HandleAction::kMove, {0.05, 0.85, 0.0}});
  Pose before = step();
  for (int i = 0; i < 15; ++i) before = step();
  EXPECT_LT(glm::distance(place(before, "hips"), {0.05, 0.85, 0.0}), 1e-3);
  handles_->ask({"left hand", HandleAction::kStop, {}});
  handles_->ask({"hips", HandleAction::kStop, {}});
  for (int i = 0; i < 12; ++i) {
    const Pose pose = step();
    EXPECT_LT(glm::distance(place(pose, "left hand"), place(before, "left hand")), 0.35);
    before = pose;
  }
  EXPECT_FALSE(handles_->is_busy());
  EXPECT_TRUE(are_same(before, source(frame_ - 1)));
}

TEST_F(DraggedAvatar, LiftsAFootThatIsDragged) {
  const glm::dvec3 from = place(step(), "right foot");
  const glm::dvec3 to = from + glm::dvec3(-0.1, 0.25, 0.2);
  handles_->ask({"right foot", HandleAction::kMove, to});
  Pose pose;
  for (int i = 0; i < 20; ++i) pose = step();
  EXPECT_LT(glm::distance(place(pose, "right foot"), to), 1e-3);
  EXPECT_LT(
      glm::distance(place(pose, "left foot"), place(source(frame_ - 1), "left foot")),
      1e-4);
}

TEST_F(DraggedAvatar, HoldsAHandThatIsSwitchedOnWhereItIs) {
  step();
  const glm::dvec3 at = place(step(), "left hand");
  handles_->ask({"left hand", HandleAction::kStart, {}});
  Pose pose;
  for (int i = 0; i < 12; ++i) pose = step();
  EXPECT_GT(glm::distance(place(source(frame_ - 1), "left hand"), at), 0.02);
  EXPECT_LT(glm::distance(place(pose, "left hand"), at), 1e-3);
}

TEST_F(DraggedAvatar, MovesTheSameWayAgain) {
  auto made = LiveHandles::make("man", skeleton_);
  ASSERT_TRUE(made);
  LiveHandles& again = *made;
  for (int i = 0; i < 40; ++i) {
    HandleRequest request{"right hand", HandleAction::kMove, {-0.3, 1.0 + 0.01 * i, 0.4}};
    if (i == 25) request.action = HandleAction::kStop;
    // Requests as a take keeps them.
    LiveRequests asked;
    if (i < 26) asked.add(request);
    const auto replayed = parse_live_requests(live_requests_text(asked), "take");
    ASSERT_TRUE(replayed);
    for (const HandleRequest& one : asked.handles) handles_->ask(one);
    for (const HandleRequest& one : replayed->handles) again.ask(one);
    Pose pose = source(i);
    const auto joints = world_from_joints(skeleton_, pose);
    again.step(joints, kBothStand, kStep_s, pose);
    EXPECT_TRUE(are_same(step(), pose)) << i;
  }
}

}  // namespace
}  // namespace marey::app
