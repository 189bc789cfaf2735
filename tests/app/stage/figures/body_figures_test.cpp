// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/body_figures.h"

#include <gtest/gtest.h>

#include "core/human/centre_of_mass.h"
#include "tests/app/stage/figures/made_figure_body.h"

namespace marey::app {
namespace {

TEST(BodyFigures, FeetOfAStillBodyAreFlatAndStill) {
  const MadeFigureBody made;
  for (const auto& foot : foot_steps(made.body(), {})) {
    ASSERT_EQ(foot.size(), 120U);
    EXPECT_EQ(foot[50].stance, FootStance::kFlat);
    EXPECT_NEAR(foot_slide_mm(foot).value, 0.0, 1e-9);
  }
}

TEST(BodyFigures, ARaisedHeelStandsOnItsBall) {
  MadeFigureBody made;
  for (std::size_t i = 60; i < 120; ++i) {
    made.turn(i, HumanBone::kLeftFoot, glm::angleAxis(0.3, glm::dvec3(1, 0, 0)));
    made.stands[i][1] = false;
  }
  const auto feet = foot_steps(made.body(), {});
  EXPECT_EQ(feet[0][59].stance, FootStance::kFlat);
  EXPECT_EQ(feet[0][60].stance, FootStance::kBall);
  EXPECT_EQ(feet[1][60].stance, FootStance::kNone);
}

TEST(BodyFigures, AFloorThatMovesCarriesTheFeet) {
  MadeFigureBody made;
  std::vector<std::array<FigureFloor, 2>> floor;
  for (std::size_t i = 0; i < 120; ++i) {
    const glm::dvec3 by(0.002 * static_cast<double>(i), 0.0, 0.0);
    made.poses[i].root_in_world += by;
    floor.push_back({FigureFloor{by}, FigureFloor{by}});
  }
  FigureBody body = made.body();
  EXPECT_NEAR(foot_slide_mm(foot_steps(body, {})[0]).value, 238.0, 1e-6);
  body.floor = floor;
  EXPECT_NEAR(foot_slide_mm(foot_steps(body, {})[0]).value, 0.0, 1e-9);
}

TEST(BodyFigures, ALoadThatIsNotBalancedMovesTheCentreOfMass) {
  MadeFigureBody made;
  EXPECT_NEAR(com_error_mm(made.body(), {}).value, 0.0, 1e-9);
  Load load;
  load.name = "bag";
  load.mass.joint = *made.map.joint_of[index(HumanBone::kRightHand)];
  load.mass.mass_kg = 8.0;
  made.character.loads.push_back(load);
  double body_kg = 0.0;
  for (const PointMass& mass : made.character.masses) body_kg += mass.mass_kg;
  const auto joints = world_from_joints(made.character.skeleton, made.poses[0]);
  const glm::dvec3 com = centre_of_mass(made.character.masses, joints);
  const glm::dvec3 hand = made.place(HumanBone::kRightHand);
  const double expected_mm =
      1000.0 * std::hypot(hand.x - com.x, hand.z - com.z) * 8.0 / (8.0 + body_kg);
  EXPECT_NEAR(com_error_mm(made.body(), {}).value, expected_mm, 1e-6);
}

TEST(BodyFigures, ABodyThatIsCarriedKeepsItsCentreOfMassOverItsFeet) {
  MadeFigureBody made;
  for (std::size_t i = 0; i < 120; ++i) made.poses[i].root_in_world.x += 0.01;
  EXPECT_NEAR(com_error_mm(made.body(), {}).value, 0.0, 1e-9);
}

TEST(BodyFigures, HipsThatMoveBackOverStillFeetAreMeasured) {
  MadeFigureBody made;
  // Both legs lean: the hips move back over the ankles.
  const glm::dvec3 hips_before = made.place(HumanBone::kHips);
  const glm::dvec3 feet_before = made.place(HumanBone::kLeftFoot);
  for (std::size_t i = 0; i < 120; ++i) {
    for (const HumanBone leg : {HumanBone::kLeftUpperLeg, HumanBone::kRightUpperLeg}) {
      made.turn(i, leg, glm::angleAxis(-0.1, glm::dvec3(1, 0, 0)));
    }
  }
  const auto joints = world_from_joints(made.character.skeleton, made.poses[0]);
  const glm::dvec3 feet_after =
      joints[index(*made.map.joint_of[index(HumanBone::kLeftFoot)])].translation;
  const double expected_mm =
      1000.0 * ((hips_before.z - feet_before.z) - (hips_before.z - feet_after.z));
  ASSERT_GT(expected_mm, 10.0);
  EXPECT_NEAR(pelvis_back_mm(made.body(), {}).value, expected_mm, 1e-6);
}

TEST(BodyFigures, ArrivalIsTheDistanceOnTheFloor) {
  const MadeFigureBody made;
  const glm::dvec3 hips = made.place(HumanBone::kHips);
  const std::vector<glm::dvec3> targets(120, {hips.x + 0.3, 0.0, hips.z + 0.4});
  EXPECT_NEAR(hips_distance_m(made.body(), targets, 1.0), 0.5, 1e-9);
}

TEST(BodyFigures, ABodyThatPlaysItsClipHasTheRatioOne) {
  MadeFigureBody made;
  const MotionClip clip = leaning_clip(made, 2.0, 1.0, 0.15, 0.0);
  ClipOnBody on_body(clip, PostureLayout{}, made.character.skeleton, made.map);
  for (std::size_t i = 0; i < 120; ++i) {
    on_body.joints_at(made.times_s[i]);
    made.poses[i] = on_body.pose();
  }
  const std::array<PlayedClip, 1> played{PlayedClip{&clip, 2.0}};
  const auto ratio = jerk_ratio(made.body(), played, PostureLayout{}, {}, 1.0 / 60);
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(*ratio, 1.0, 0.02);
}

TEST(BodyFigures, TheSwayOfAClipDeviatesLittleAndHalfOfItByHalf) {
  MadeFigureBody made;
  const MotionClip clip = leaning_clip(made, 4.0, 0.75, 0.2, 1.0);
  const MotionClip half = leaning_clip(made, 4.0, 0.75, 0.1, 1.0);
  made.times_s.clear();
  made.poses.clear();
  ClipOnBody on_body(clip, PostureLayout{}, made.character.skeleton, made.map);
  for (int i = 0; i < 1200; ++i) {
    made.times_s.push_back(i / 60.0);
    on_body.joints_at(1.3 + i / 60.0);
    made.poses.push_back(on_body.pose());
  }
  const auto same =
      sway_deviation_percent(made.body(), clip, PostureLayout{}, {}, 1.0 / 60);
  const auto twice =
      sway_deviation_percent(made.body(), half, PostureLayout{}, {}, 1.0 / 60);
  ASSERT_TRUE(same && twice);
  EXPECT_LT(*same, 2.0);
  EXPECT_NEAR(*twice, 100.0, 3.0);
}

TEST(BodyFigures, ABodyThatStandsHasNoSway) {
  const MadeFigureBody made;
  const MotionClip clip = leaning_clip(made, 2.0, 1.0, 0.1, 1.0);
  EXPECT_FALSE(sway_deviation_percent(made.body(), clip, PostureLayout{}, {}, 1.0 / 60));
}

}  // namespace
}  // namespace marey::app
