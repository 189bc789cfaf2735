// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Frames of a recording that a page drags in.
#include "app/view/view_handles.h"

#include <fstream>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/humanoid.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using live::ClientId;
using live::DragPhase;

constexpr int kFirst = 7;
constexpr int kFrames = 40;
constexpr ClientId kPage{1};

/// Returns a recording of a person that stands still.
ViewedRecording standing() {
  ViewedRecording out;
  out.rate = {30.0};
  out.first_frame = kFirst;
  out.frames = kFrames;
  ViewedFigure& figure = out.figures.emplace_back();
  figure.name = "man";
  figure.motion = {make_humanoid(average_proportions(1.75)), out.rate, kFirst, {}};
  figure.motion.poses.assign(kFrames, rest_pose(figure.motion.skeleton));
  return out;
}

glm::dvec3 place(const ViewedRecording& recording, const Pose& pose, HumanBone bone) {
  const Skeleton& skeleton = recording.figures[0].motion.skeleton;
  return world_from_joints(skeleton, pose)[index(*skeleton.find(bone))].translation;
}

live::DragRequest drag(const std::string& id, const glm::dvec3& to, int frame) {
  return {id, to, DragPhase::kMove, frame};
}

TEST(ViewHandles, BringAFrameToItsDraggedTargets) {
  const ViewedRecording recording = standing();
  auto made = ViewHandles::make(recording, {});
  ASSERT_TRUE(made) << made.error().message();
  ViewHandles& handles = *made;
  EXPECT_EQ(handles.constraints().size(), 6U);
  EXPECT_TRUE(handles.constraints()[0].joint);
  const glm::dvec3 left(0.35, 1.2, 0.45);
  const glm::dvec3 right(-0.3, 1.1, 0.4);
  ASSERT_TRUE(handles.drag(kPage, drag("left hand", left, kFirst + 20)));
  ASSERT_TRUE(handles.drag(kPage, drag("right hand", right, kFirst + 20)));
  const auto adapted = handles.adapted(kPage);
  ASSERT_TRUE(adapted && *adapted);
  EXPECT_EQ((*adapted)->frame, 20);
  EXPECT_LT(glm::distance(place(recording, (*adapted)->pose, HumanBone::kLeftHand), left),
            1e-3);
  EXPECT_LT(
      glm::distance(place(recording, (*adapted)->pose, HumanBone::kRightHand), right),
      1e-3);
  const Pose& before = recording.figures[0].motion.poses[20];
  for (const HumanBone foot : {HumanBone::kLeftFoot, HumanBone::kRightFoot}) {
    EXPECT_LT(glm::distance(place(recording, (*adapted)->pose, foot),
                            place(recording, before, foot)),
              1e-4);
  }
  // Another page, another frame: nothing of it.
  ASSERT_TRUE(handles.drag(ClientId{2}, drag("head", {0.0, 1.5, 0.1}, kFirst + 20)));
  ASSERT_TRUE(handles.drag(kPage, drag("left hand", left, kFirst + 3)));
  const auto other = handles.adapted(kPage);
  ASSERT_TRUE(other && *other);
  EXPECT_GT(glm::distance(place(recording, (*other)->pose, HumanBone::kRightHand), right),
            0.1);
  EXPECT_FALSE(handles.release(kPage, "right hand"));
  EXPECT_TRUE(handles.release(kPage, "left hand"));
}

TEST(ViewHandles, KeepTheConstraintsOfAFile) {
  const ViewedRecording recording = standing();
  const testing::ScratchFolder folder;
  const auto file = folder / "c.xml";
  std::ofstream(file) << "<ConstraintsSet><Distance><name>gate</name><bodyPoint><segment>"
                         "rightHand</segment></bodyPoint><specif><distance>0</distance>"
                         "<position><X>-0.3</X><Y>1.1</Y><Z>0.4</Z></position></specif>"
                         "</Distance></ConstraintsSet>";
  auto handles = ViewHandles::make(recording, file);
  ASSERT_TRUE(handles) << handles.error().message();
  const auto shown = handles->constraints();
  ASSERT_EQ(shown.size(), 7U);
  EXPECT_EQ(shown[0].id, "gate");
  EXPECT_EQ(shown[0].p_in_world, glm::dvec3(-0.3, 1.1, 0.4));
  ASSERT_TRUE(handles->drag(kPage, drag("left hand", {0.35, 1.2, 0.45}, kFirst)));
  const auto adapted = handles->adapted(kPage);
  ASSERT_TRUE(adapted && *adapted);
  EXPECT_LT(glm::distance(place(recording, (*adapted)->pose, HumanBone::kRightHand),
                          {-0.3, 1.1, 0.4}),
            1e-3);
  ASSERT_TRUE(handles->drag(kPage, drag("gate", {-0.35, 1.2, 0.4}, kFirst)));
  const auto moved = handles->adapted(kPage);
  ASSERT_TRUE(moved && *moved);
  EXPECT_LT(glm::distance(place(recording, (*moved)->pose, HumanBone::kRightHand),
                          {-0.35, 1.2, 0.4}),
            1e-3);
}

TEST(ViewHandles, HaveNothingOfAPageThatSixteenOthersFollowed) {
  auto handles = ViewHandles::make(standing(), {});
  ASSERT_TRUE(handles);
  EXPECT_FALSE(handles->adapted(kPage)) << "this page drags no handle";
  for (int page = 1; page <= 17; ++page) {
    const auto client = static_cast<ClientId>(page);
    ASSERT_TRUE(handles->drag(client, drag("head", {0.0, 1.5, 0.1}, kFirst)));
  }
  EXPECT_FALSE(handles->adapted(kPage));
  EXPECT_TRUE(handles->adapted(ClientId{17}));
}

TEST(ViewHandles, RejectUnknownHandles) {
  const ViewedRecording recording = standing();
  auto handles = ViewHandles::make(recording, {});
  ASSERT_TRUE(handles);
  EXPECT_FALSE(handles->drag(kPage, drag("tail", {}, kFirst)));
  EXPECT_FALSE(handles->drag(kPage, drag("hips", {}, kFirst - 1)));
  EXPECT_FALSE(handles->drag(kPage, drag("hips", {}, kFirst + kFrames)));
  EXPECT_FALSE(handles->drag(kPage, {"hips", {}, DragPhase::kMove, std::nullopt}));
  ViewedRecording nobody;
  const auto none = ViewHandles::make(nobody, {});
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->constraints().empty());
  EXPECT_FALSE(ViewHandles::make(nobody, "c.xml"));
  EXPECT_FALSE(ViewHandles::make(recording, "gone.xml"));
}

}  // namespace
}  // namespace marey::app
