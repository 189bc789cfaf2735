// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/choose_join.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/edit/ops/splice_scene.h"
#include "tests/edit/ops/standing_scene.h"

namespace marey::edit {
namespace {

constexpr double kPi = 3.14159265358979324;

// The largest acceleration of a joint by second differences of its own way. [m/s^2]
struct OwnPeak {
  double m_per_s2 = 0.0;
  HumanBone bone = HumanBone::kHips;
  int frame = 0;
};

OwnPeak own_peak(const Motion& motion) {
  OwnPeak out;
  for (const Joint& joint : motion.skeleton.joints) {
    if (!joint.bone) continue;
    const auto way = joint_way(motion, *joint.bone);
    for (std::size_t t = 1; t + 1 < way.size(); ++t) {
      const double size = glm::length(way[t + 1] - 2.0 * way[t] + way[t - 1]) *
                          motion.rate.hz * motion.rate.hz;
      if (size > out.m_per_s2) out = {size, *joint.bone, static_cast<int>(t)};
    }
  }
  return out;
}

// Stands and swings the right arm with 1 Hz; the left arm is raised by an angle.
EditState waving(int frames, double raised_rad) {
  return state_of(standing_motion(frames, [&](int frame, Pose& pose) {
    const Skeleton skeleton = make_humanoid(average_proportions(1.75));
    const auto turn = [&](HumanBone bone, double angle, const glm::dvec3& axis) {
      glm::dquat& q = pose.parent_from_joint[index(*skeleton.find(bone))];
      q = glm::angleAxis(angle, axis) * q;
    };
    turn(HumanBone::kRightUpperArm,
         0.3 * std::sin(2.0 * kPi * frame / 60.0),
         {0.0, 0.0, 1.0});
    turn(HumanBone::kLeftUpperArm, raised_rad, {0.0, 0.0, 1.0});
  }));
}

double clips_peak(const EditState& a, const EditState& b) {
  return std::max(own_peak(a.motion).m_per_s2, own_peak(b.motion).m_per_s2);
}

TEST(ChooseJoin, PeakIsThatOfACircle) {
  // A hand that circles about the shoulder at a steady rate.
  const double rate_rad_per_s = 4.0;
  const EditState state = state_of(standing_motion(60, [&](int frame, Pose& pose) {
    const Skeleton skeleton = make_humanoid(average_proportions(1.75));
    const auto arm = index(*skeleton.find(HumanBone::kLeftUpperArm));
    pose.parent_from_joint[arm] =
        glm::angleAxis(rate_rad_per_s * frame / 60.0, glm::dvec3(0.0, 0.0, 1.0));
  }));
  const auto hand = joint_way(state.motion, HumanBone::kLeftHand);
  const auto shoulder = joint_way(state.motion, HumanBone::kLeftUpperArm);
  glm::dvec3 arm = hand[0] - shoulder[0];
  arm.z = 0.0;
  const PeakAcceleration peak = peak_acceleration(state.motion);
  EXPECT_EQ(peak.bone, HumanBone::kLeftHand);
  // A chord of 1/60 s is shorter than the arc by 1 - sin(x)^2 / x^2 with x = 4 / 120.
  EXPECT_NEAR(
      peak.m_per_s2 / (glm::length(arm) * rate_rad_per_s * rate_rad_per_s), 1.0, 5e-4);
  EXPECT_EQ(peak_acceleration(state.motion, {59, 59}).m_per_s2, 0.0);
  EXPECT_EQ(peak_acceleration(slice_state(state, {0, 1}).motion).m_per_s2, 0.0);
}

TEST(ChooseJoin, RaisedArmTakesLongerThanTheLegs) {
  const EditState first = waving(240, 0.0);
  const EditState second = waving(240, 1.3);
  auto scene = splice_scene(second);
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined) << joined.error().message();
  EXPECT_LE(own_peak(joined->motion).m_per_s2, 1.1 * clips_peak(first, second));
  EXPECT_FALSE(scene.has_finding("acceleration"));
  EXPECT_NEAR(scene.figure("overlap_s"), 0.3, 1e-9);
  EXPECT_GT(scene.figure("upper_overlap_s"), 0.5);
}

TEST(ChooseJoin, GivenFramesStay) {
  SpliceOp op;
  op.at = AtFrame{120};
  op.enter_at = AtFrame{105};
  auto scene = splice_scene(waving(240, 1.3), op);
  const EditState first = waving(240, 0.0);
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined);
  EXPECT_EQ(scene.figure("leave_frame"), 120.0);
  EXPECT_EQ(scene.figure("enter_frame"), 105.0);
  ASSERT_EQ(joined->frame_count(), 240 + 15);
  const auto hand = joint_way(joined->motion, HumanBone::kRightHand);
  EXPECT_EQ(hand[60], joint_way(first.motion, HumanBone::kRightHand)[60]);
}

TEST(ChooseJoin, GivenOverlapStaysAndItsAccelerationIsReported) {
  const EditState first = waving(240, 0.0);
  const EditState second = waving(240, 1.3);
  SpliceOp op;
  op.overlap_s = 0.3;
  auto scene = splice_scene(second, op);
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined);
  EXPECT_NEAR(scene.figure("overlap_s"), 0.3, 1e-9);
  EXPECT_NEAR(scene.figure("upper_overlap_s"), 0.3, 1e-9);
  const OwnPeak peak = own_peak(joined->motion);
  const double ratio = peak.m_per_s2 / clips_peak(first, second);
  ASSERT_GT(ratio, 1.1);
  ASSERT_TRUE(scene.has_finding("acceleration"));
  for (const Finding& finding : scene.report.findings) {
    if (finding.id != "acceleration") continue;
    EXPECT_NEAR(finding.value.value_or(0.0), ratio, 1e-9);
    EXPECT_EQ(finding.limit, 1.1);
    EXPECT_NE(finding.cause.find("leftHand"), std::string::npos) << finding.cause;
    EXPECT_NE(finding.cause.find("frame " + std::to_string(peak.frame) + " "),
              std::string::npos)
        << finding.cause;
    EXPECT_NE(finding.next.find("overlap_s"), std::string::npos) << finding.next;
  }
}

// Half a second of the second motion has no frames for a longer overlap.
TEST(ChooseJoin, JoinWithoutRoomIsReported) {
  auto scene = splice_scene(waving(20, 1.3));
  const auto joined = scene.run(apply_splice, waving(240, 0.0));
  ASSERT_TRUE(joined) << joined.error().message();
  EXPECT_TRUE(scene.has_finding("acceleration"));
}

TEST(ChooseJoin, DisplacementsWithoutAnOverlapDecayLongerIfTheyNeedTo) {
  const EditState first = waving(240, 0.0);
  const EditState second = waving(240, 0.8);
  SpliceOp op;
  op.overlap_s = 0.0;
  auto chosen = splice_scene(second, op);
  const auto longer = chosen.run(apply_splice, first);
  auto given = splice_scene(second, op);
  given.op.blend_s = 0.3;
  const auto shorter = given.run(apply_splice, first);
  ASSERT_TRUE(longer && shorter);
  const double limit = 1.1 * clips_peak(first, second);
  EXPECT_LE(own_peak(longer->motion).m_per_s2, limit);
  EXPECT_GT(own_peak(shorter->motion).m_per_s2, limit);
  EXPECT_TRUE(given.has_finding("acceleration"));
}

}  // namespace
}  // namespace marey::edit
