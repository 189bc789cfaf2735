// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/fit_markers.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "reconstruct/markers/hip_regression.h"
#include "reconstruct/markers/solve_markers.h"
#include "tests/reconstruct/markers/moving_body.h"

namespace marey::reconstruct {
namespace {

using marey::testing::moving_body;
using marey::testing::MovingBody;
using marey::testing::MovingBodyOptions;

constexpr std::array<HumanBone, 6> kLongBones{HumanBone::kLeftLowerArm,
                                              HumanBone::kRightLowerArm,
                                              HumanBone::kLeftLowerLeg,
                                              HumanBone::kRightLowerLeg,
                                              HumanBone::kLeftFoot,
                                              HumanBone::kRightFoot};

const LabelVerdict& verdict(const MarkersFit& fit, std::string_view label) {
  return *std::find_if(fit.labels.begin(), fit.labels.end(), [&](const auto& v) {
    return v.label == label;
  });
}

TEST(FitMarkers, MeasuresAMovingBody) {
  MovingBodyOptions options;
  options.noise_m = 0.001;
  const MovingBody moving = moving_body(options);
  const auto fit = fit_markers({}, std::span(&moving.tracks, 1), moving.labels);
  ASSERT_TRUE(fit) << fit.error().cause;
  // Statures are estimated from landmarks that are 6 mm off and limbs that differ by 4 %.
  EXPECT_NEAR(fit->body.stature_m, 1.75, 0.06);
  EXPECT_LT(fit->rms_m, 0.004);
  for (const HumanBone bone : kLongBones) {
    const double found = glm::length(fit->body.proportions[bone]);
    const double real = glm::length(moving.body.proportions[bone]);
    EXPECT_NEAR(found, real, 0.012) << name(bone);
    EXPECT_LT(std::abs(found - real), 4.0 * fit->body.joint_centre_sigma_m[index(bone)])
        << name(bone);
  }
  ASSERT_EQ(fit->joints.size(), 21U);
  for (const JointEvidence& joint : fit->joints) {
    if (joint.joint == HumanBone::kLeftLowerLeg) {
      EXPECT_EQ(joint.origin, JointOrigin::kMovement);
      EXPECT_GT(joint.range_rad, 0.8);
    }
    if (joint.joint == HumanBone::kLeftToes) {
      EXPECT_EQ(joint.origin, JointOrigin::kProportions);
    }
  }
  for (const LabelVerdict& label : fit->labels) EXPECT_EQ(label.use, LabelUse::kNamed);
}

TEST(FitMarkers, PutsTheJointsWhereTheyAre) {
  const MovingBody moving = moving_body();
  const auto fit = fit_markers({}, std::span(&moving.tracks, 1), moving.labels);
  ASSERT_TRUE(fit);
  const auto solved = solve_markers(fit->body, moving.tracks);
  ASSERT_TRUE(solved);
  std::vector<double> errors;
  for (std::size_t f = 0; f < moving.tracks.frames(); f += 10) {
    const auto found = world_from_joints(solved->estimate.motion.skeleton,
                                         solved->estimate.motion.poses[f]);
    const auto real = world_from_joints(moving.motion.skeleton, moving.motion.poses[f]);
    for (const HumanLimb& limb : human_limbs()) {
      for (const HumanBone bone : {limb.upper, limb.lower, limb.end}) {
        errors.push_back(
            glm::length(found[index(bone)].translation - real[index(bone)].translation));
      }
    }
  }
  std::sort(errors.begin(), errors.end());
  // The place of a joint along its hinge is determined by landmarks alone, to their 6 mm.
  EXPECT_LT(errors[errors.size() / 2], 0.008);
  EXPECT_LT(errors.back(), 0.03);
}

TEST(FitMarkers, IsContentWithAStaticTrial) {
  MovingBodyOptions options;
  options.frames = 5;
  const MovingBody moving = moving_body(options);
  const auto fit = fit_markers({}, std::span(&moving.tracks, 1), moving.labels);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->rms_m, 0.004);
  for (const JointEvidence& joint : fit->joints) {
    EXPECT_NE(joint.origin, JointOrigin::kMovement) << name(joint.joint);
  }
  for (const HumanBone bone : kLongBones) {
    EXPECT_NEAR(glm::length(fit->body.proportions[bone]),
                glm::length(moving.body.proportions[bone]),
                0.025)
        << name(bone);
  }
}

TEST(FitMarkers, FindsTheSegmentOfALabelWithoutMeaning) {
  MovingBody moving = moving_body();
  for (NamedMarker& marker : moving.labels) {
    if (marker.label == "left_tibial_tuberosity") marker.landmark = nullptr;
  }
  const auto fit = fit_markers({}, std::span(&moving.tracks, 1), moving.labels);
  ASSERT_TRUE(fit);
  const LabelVerdict& found = verdict(*fit, "left_tibial_tuberosity");
  EXPECT_EQ(found.use, LabelUse::kFound);
  EXPECT_EQ(found.segment, HumanBone::kLeftLowerLeg);
}

TEST(FitMarkers, MovesALabelThatIsOnAnotherSegment) {
  MovingBody moving = moving_body();
  for (NamedMarker& marker : moving.labels) {
    if (marker.label == "left_tibial_tuberosity") {
      marker.landmark = find_landmark("right_upper_arm");
    }
  }
  const auto fit = fit_markers({}, std::span(&moving.tracks, 1), moving.labels);
  ASSERT_TRUE(fit);
  const LabelVerdict& found = verdict(*fit, "left_tibial_tuberosity");
  EXPECT_EQ(found.use, LabelUse::kMoved);
  EXPECT_EQ(found.segment, HumanBone::kLeftLowerLeg);
}

TEST(FitMarkers, GivesTheSameBodyAgain) {
  const MovingBody moving = moving_body();
  const auto one = fit_markers({}, std::span(&moving.tracks, 1), moving.labels);
  const auto two = fit_markers({}, std::span(&moving.tracks, 1), moving.labels);
  ASSERT_TRUE(one && two);
  for (std::size_t m = 0; m < one->body.markers.size(); ++m) {
    EXPECT_EQ(one->body.markers[m].p_in_segment, two->body.markers[m].p_in_segment);
  }
}

TEST(FitMarkers, DeclinesLabelsWithoutMeaning) {
  MovingBody moving = moving_body();
  for (NamedMarker& marker : moving.labels) marker.landmark = nullptr;
  const auto fit = fit_markers({}, std::span(&moving.tracks, 1), moving.labels);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().cause, "only 0 labels have a known place on the body");
}

TEST(FitMarkers, DeclinesMarkersThatAreNeverSeen) {
  MovingBody moving = moving_body();
  for (auto& sample : moving.tracks.samples) sample.reset();
  const auto fit = fit_markers({}, std::span(&moving.tracks, 1), moving.labels);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().cause, "no frame shows six markers whose places are known");
}

TEST(HipsFromSpines, IsHarringtonsRegression) {
  // The bones' width and depth: 240 and 160 mm. His equations by hand: 48.3 mm behind,
  // 82.9 mm below, 86.5 mm to the side; markers lie 7.5 mm off the bone.
  const HipRegression hips = hips_from_spines(0.240, 0.175);
  EXPECT_NEAR(hips.half_hip_width_m, 0.0865, 1e-4);
  EXPECT_NEAR(
      glm::length(hips.anterior_in_hips), std::hypot(0.0483 + 0.0075, 0.0829), 1e-4);
  EXPECT_NEAR(glm::length(hips.anterior_in_hips - hips.posterior_in_hips), 0.175, 1e-12);
  EXPECT_GT(hips.anterior_in_hips.z, 0.0);
  EXPECT_LT(hips.posterior_in_hips.z, 0.0);
}

}  // namespace
}  // namespace marey::reconstruct
