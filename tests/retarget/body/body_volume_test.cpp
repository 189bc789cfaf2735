// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/body_volume.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/body/volume_of_skin.h"
#include "tests/retarget/hand_scenes.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using P = VolumePart;

Capsule capsule(double half_length_m, double radius_m) {
  return {JointIndex{0}, {}, half_length_m, radius_m};
}

BodyVolume volume_of(const Skeleton& body) {
  return average_volume(body, mapped(body));
}

TEST(BodyVolume, MeasuresADistanceFromTheSideAndFromTheEnd) {
  const Capsule c = capsule(0.2, 0.1);
  EXPECT_NEAR(side_of(c, {0.3, 0, 0.1}).distance_m, 0.2, 1e-15);
  EXPECT_NEAR(side_of(c, {0, 0, 0.5}).distance_m, 0.2, 1e-15);
  EXPECT_NEAR(side_of(c, {0.05, 0, 0}).distance_m, -0.05, 1e-15);
  EXPECT_NEAR(side_of(c, {0, -0.4, 0}).outward.y, -1.0, 1e-15);
  EXPECT_NEAR(side_of(c, {0, 0, 0.5}).outward.z, 1.0, 1e-15);
}

// A point on the axis has no direction; the result is one without NaN.
TEST(BodyVolume, AnswersOnTheAxis) {
  const CapsuleSide side = side_of(capsule(0.2, 0.1), {0, 0, 0.1});
  EXPECT_EQ(side.distance_m, -0.1);
  EXPECT_EQ(glm::length(side.outward), 1.0);
}

TEST(BodyVolume, CarriesAPlaceOverToItselfUnchanged) {
  testing::Dice dice(1);
  const Capsule c = capsule(0.2, 0.1);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 p = dice.between(0.01, 0.6) * dice.direction();
    EXPECT_LT(glm::distance(carried_over(c, p, 0.02, c, 0.02), p), 1e-14);
  }
}

TEST(BodyVolume, CarriesDistancesOverToAnyOtherCapsule) {
  testing::Dice dice(2);
  for (int i = 0; i < 200; ++i) {
    const Capsule from = capsule(dice.between(0.0, 0.3), dice.between(0.05, 0.2));
    const Capsule to = capsule(dice.between(0.0, 0.3), dice.between(0.05, 0.2));
    const glm::dvec3 p = dice.between(0.5, 0.8) * dice.direction();
    const double gap = side_of(from, p).distance_m - 0.02;
    const glm::dvec3 q = carried_over(from, p, 0.02, to, 0.03);
    EXPECT_NEAR(side_of(to, q).distance_m - 0.03, gap, 1e-12);
  }
}

TEST(BodyVolume, FindsPlacesOfItsSurfaceAgain) {
  testing::Dice dice(3);
  const Capsule c = capsule(0.2, 0.1);
  for (int i = 0; i < 200; ++i) {
    const PlaceOnPart place{dice.between(-0.99, 0.99), dice.between(-3.1, 3.1)};
    const glm::dvec3 p = surface_point_in_joint(c, place);
    EXPECT_NEAR(side_of(c, p).distance_m, 0.0, 1e-12);
    const PlaceOnPart again = place_on(c, p);
    EXPECT_NEAR(again.along, place.along, 1e-9);
    EXPECT_NEAR(again.around_rad, place.around_rad, 1e-9);
  }
}

// Girths of a man or woman of 1.75 m, to two centimetres.
TEST(BodyVolume, HasTheGirthsOfAnAdult) {
  const BodyVolume v = volume_of(adult());
  const auto breadth_m = [&](P part) {
    return 2.0 * (v[part]->half_length_m + v[part]->radius_m);
  };
  EXPECT_NEAR(breadth_m(P::kChest), 0.29, 0.02);
  EXPECT_NEAR(breadth_m(P::kAbdomen), 0.32, 0.02);
  EXPECT_NEAR(breadth_m(P::kPelvis), 0.355, 0.02);
  EXPECT_NEAR(2.0 * v[P::kAbdomen]->radius_m, 0.235, 0.02);
  EXPECT_NEAR(2.0 * v[P::kHead]->radius_m, 0.175, 0.02);
  EXPECT_NEAR(6.283 * v[P::kLeftUpperArm]->radius_m, 0.32, 0.02);
  EXPECT_NEAR(6.283 * v[P::kLeftThigh]->radius_m, 0.52, 0.03);
}

// Same places in the T-pose, for any rest pose and joint axes.
TEST(BodyVolume, DoesNotDependOnHowABodyRests) {
  testing::Dice dice(4);
  const Skeleton body = adult();
  const Skeleton other = testing::with_random_axes(testing::in_a_pose(body, 0.8), dice);
  const BodyVolume a = volume_of(body);
  const BodyVolume b = volume_of(other);
  const auto a_joints = t_pose_joints(body, mapped(body));
  const auto b_joints = t_pose_joints(other, mapped(other));
  for (int i = 0; i < kVolumePartCount; ++i) {
    const P part = static_cast<P>(i);
    ASSERT_TRUE(a[part] && b[part]) << name(part);
    EXPECT_NEAR(a[part]->radius_m, b[part]->radius_m, 1e-9) << name(part);
    for (const double along : {-1.0, 1.0}) {
      const glm::dvec3 p =
          a_joints[index(a[part]->joint)] * axis_point_in_joint(*a[part], along);
      const glm::dvec3 q =
          b_joints[index(b[part]->joint)] * axis_point_in_joint(*b[part], along);
      EXPECT_LT(glm::distance(p - a_joints[0].translation, q - b_joints[0].translation),
                1e-9)
          << name(part);
    }
  }
}

TEST(BodyVolume, LeavesOutWhatABodyLacks) {
  const BodyVolume v = volume_of(testing::without(
      testing::without(adult(), HumanBone::kLeftHand), HumanBone::kHead));
  EXPECT_FALSE(v[P::kLeftHand]);
  EXPECT_FALSE(v[P::kHead]);
  EXPECT_TRUE(v[P::kRightHand]);
}

// Returns points on known capsules, as skin vertices.
std::vector<SkinPoint> skin_of(const BodyVolume& volume, const Skeleton& body) {
  const auto rest = world_from_joints(body, rest_pose(body));
  std::vector<SkinPoint> skin;
  for (const auto& part : volume.parts) {
    for (int i = -12; i <= 12; ++i) {
      for (int k = 0; k < 24; ++k) {
        const PlaceOnPart place{i / 12.5, 0.2618 * k};
        skin.push_back({rest[index(part->joint)] * surface_point_in_joint(*part, place),
                        part->joint});
      }
    }
  }
  return skin;
}

TEST(VolumeOfSkin, FindsABellyInASkin) {
  testing::Dice dice(5);
  const Skeleton body = testing::with_random_axes(testing::in_a_pose(adult(), 0.8), dice);
  const BodyMap map = mapped(body);
  const BodyVolume average = average_volume(body, map);
  BodyVolume truth = with_belly(average, 1.4);
  truth[P::kLeftForearm]->radius_m *= 1.3;
  const BodyVolume found = volume_of_skin(body, map, skin_of(truth, body));
  // Slices lie over each other, hence centimetres.
  for (const P part : {P::kAbdomen, P::kPelvis}) {
    EXPECT_NEAR(found[part]->radius_m, truth[part]->radius_m, 0.02) << name(part);
    EXPECT_NEAR(found[part]->half_length_m + found[part]->radius_m,
                truth[part]->half_length_m + truth[part]->radius_m,
                0.03)
        << name(part);
  }
  EXPECT_NEAR(found[P::kLeftForearm]->radius_m, truth[P::kLeftForearm]->radius_m, 0.001);
  EXPECT_NEAR(found[P::kRightThigh]->radius_m, truth[P::kRightThigh]->radius_m, 0.001);
}

TEST(VolumeOfSkin, KeepsTheAverageWhereThereIsNoSkin) {
  const Skeleton body = adult();
  const BodyVolume average = volume_of(body);
  const BodyVolume found = volume_of_skin(body, mapped(body), {});
  for (int i = 0; i < kVolumePartCount; ++i) {
    const P part = static_cast<P>(i);
    EXPECT_EQ(found[part]->radius_m, average[part]->radius_m);
  }
}

}  // namespace
}  // namespace marey::retarget
