// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/labels/landmarks.h"

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/skeleton.h"
#include "tests/support/program/paths.h"

namespace marey::reconstruct {
namespace {

/// Returns the place of the landmark on an average adult in the T-pose, in shares of
/// stature.
glm::dvec3 p_in_t_pose(std::string_view name) {
  const Landmark* landmark = find_landmark(name);
  if (landmark == nullptr) {
    ADD_FAILURE() << name;
    return {};
  }
  const Proportions body = average_proportions(1.0);
  glm::dvec3 p = landmark->p_in_segment_per_stature;
  for (std::optional<HumanBone> bone = landmark->segment; bone; bone = parent(*bone)) {
    p += body[*bone];
  }
  return p;
}

double apart(std::string_view a, std::string_view b) {
  return glm::distance(p_in_t_pose(a), p_in_t_pose(b));
}

TEST(Landmarks, HaveDifferentNamesThatFindThem) {
  std::set<std::string_view> names;
  for (const Landmark& landmark : landmarks()) {
    EXPECT_TRUE(names.insert(landmark.name).second) << landmark.name;
    EXPECT_EQ(find_landmark(landmark.name), &landmark);
  }
  EXPECT_GT(names.size(), 100U);
  EXPECT_EQ(find_landmark("asis"), nullptr);
  EXPECT_EQ(find_landmark(""), nullptr);
}

TEST(Landmarks, MirrorTheLeftSideOnTheRight) {
  std::size_t left = 0;
  std::size_t right = 0;
  for (const Landmark& landmark : landmarks()) {
    if (landmark.name.starts_with("right_")) ++right;
    if (!landmark.name.starts_with("left_")) continue;
    ++left;
    const Landmark* twin = find_landmark("right_" + std::string(landmark.name.substr(5)));
    ASSERT_NE(twin, nullptr) << landmark.name;
    EXPECT_EQ(twin->segment, mirrored(landmark.segment));
    EXPECT_EQ(twin->sigma_per_stature, landmark.sigma_per_stature);
    const glm::dvec3 p = landmark.p_in_segment_per_stature;
    EXPECT_EQ(twin->p_in_segment_per_stature, glm::dvec3(-p.x, p.y, p.z));
  }
  EXPECT_EQ(left, right);
}

TEST(Landmarks, LieInTheMiddlePlaneWithoutASide) {
  for (const Landmark& landmark : landmarks()) {
    if (landmark.name.starts_with("left_") || landmark.name.starts_with("right_"))
      continue;
    EXPECT_EQ(mirrored(landmark.segment), landmark.segment) << landmark.name;
    EXPECT_EQ(landmark.p_in_segment_per_stature.x, 0.0) << landmark.name;
  }
}

TEST(Landmarks, AreAsPreciseAsPalpatingAndGluingIs) {
  for (const Landmark& landmark : landmarks()) {
    EXPECT_GE(landmark.sigma_per_stature, 0.006) << landmark.name;
    EXPECT_LE(landmark.sigma_per_stature, 0.06) << landmark.name;
  }
}

TEST(Landmarks, ThereIsOneSomewhereOnEveryBone) {
  for (const HumanBone bone : human_bones()) {
    EXPECT_EQ(somewhere_on(bone).segment, bone);
    EXPECT_GE(somewhere_on(bone).sigma_per_stature, kSomewhereSigma) << name(bone);
  }
  EXPECT_EQ(somewhere_on(HumanBone::kLeftUpperLeg).name, "left_thigh");
  EXPECT_EQ(somewhere_on(HumanBone::kRightLowerArm).name, "right_forearm");
  EXPECT_EQ(somewhere_on(HumanBone::kHips).name, "hips");
}

// T-pose: palms down, so that the thumb is in front and the elbow's outer side above.
TEST(Landmarks, AreOnTheirAnatomicalSides) {
  EXPECT_GT(p_in_t_pose("left_lateral_malleolus").x,
            p_in_t_pose("left_medial_malleolus").x);
  EXPECT_GT(p_in_t_pose("left_lateral_epicondyle_femur").x,
            p_in_t_pose("left_medial_epicondyle_femur").x);
  EXPECT_GT(p_in_t_pose("left_lateral_epicondyle_humerus").y,
            p_in_t_pose("left_medial_epicondyle_humerus").y);
  EXPECT_GT(p_in_t_pose("left_radial_styloid").z, p_in_t_pose("left_ulnar_styloid").z);
  EXPECT_GT(p_in_t_pose("left_metacarpal_2_head").z,
            p_in_t_pose("left_metacarpal_5_head").z);
  EXPECT_LT(p_in_t_pose("left_olecranon").z, p_in_t_pose("left_upper_arm").z);
  EXPECT_GT(p_in_t_pose("left_metatarsal_5_head").x,
            p_in_t_pose("left_metatarsal_1_head").x);
  EXPECT_LT(p_in_t_pose("left_heel").z, p_in_t_pose("left_big_toe").z);
  EXPECT_LT(p_in_t_pose("left_psis").z, p_in_t_pose("left_asis").z);
  EXPECT_LT(p_in_t_pose("c7").z, p_in_t_pose("suprasternal_notch").z);
  EXPECT_LT(p_in_t_pose("left_back_head").z, p_in_t_pose("left_front_head").z);
}

// Means and spread (two standard deviations) of adults: Harrington et al. (2007) for the
// pelvis, ANSUR (Gordon et al. 1989) for the rest, with two marker radii of 8 mm.
TEST(Landmarks, AreAsFarApartAsOnAdults) {
  EXPECT_NEAR(apart("left_asis", "right_asis"), 0.140, 0.020);
  EXPECT_NEAR(apart("left_psis", "right_psis"), 0.055, 0.020);
  EXPECT_NEAR(apart("left_lateral_epicondyle_femur", "left_medial_epicondyle_femur"),
              0.066,
              0.008);
  EXPECT_NEAR(apart("left_lateral_malleolus", "left_medial_malleolus"), 0.051, 0.006);
  EXPECT_NEAR(apart("left_lateral_epicondyle_humerus", "left_medial_epicondyle_humerus"),
              0.050,
              0.008);
  EXPECT_NEAR(apart("left_radial_styloid", "left_ulnar_styloid"), 0.042, 0.006);
  EXPECT_NEAR(
      apart("left_lateral_epicondyle_femur", "left_lateral_malleolus"), 0.25, 0.02);
  EXPECT_NEAR(apart("left_asis", "left_lateral_epicondyle_femur"), 0.29, 0.03);
}

TEST(Landmarks, AreListedInTheDocumentation) {
  const std::string section = marey::testing::formats_page("markers");
  ASSERT_FALSE(section.empty());
  for (const Landmark& landmark : landmarks()) {
    std::string_view name = landmark.name;
    if (name.starts_with("right_")) continue;
    if (name.starts_with("left_")) name.remove_prefix(5);
    std::string quoted = std::string("`").append(name).append("`");
    if (landmark.sigma_per_stature >= kSomewhereSigma) {
      quoted = std::string("*").append(quoted).append("*");
    }
    EXPECT_NE(section.find(quoted), std::string::npos) << quoted;
  }
}

TEST(Landmarks, AreAboveTheFloorAndBelowTheCrown) {
  for (const Landmark& landmark : landmarks()) {
    const double height = p_in_t_pose(landmark.name).y;
    EXPECT_GT(height, 0.008) << landmark.name;
    EXPECT_LT(height, 1.01) << landmark.name;
  }
}

}  // namespace
}  // namespace marey::reconstruct
