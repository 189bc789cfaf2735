// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/features/body_features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "tests/library/moved_motion.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::library {
namespace {

retarget::BodyMap mapped(const Motion& motion) {
  auto map = retarget::map_body(motion.skeleton);
  EXPECT_TRUE(map.has_value());
  return *map;
}

std::vector<float> rows_of_motion(const Motion& motion) {
  return body_features(motion, mapped(motion)).rows;
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    largest = std::max(largest, std::abs(static_cast<double>(a[k]) - b[k]));
  }
  return largest;
}

bool all_finite(const std::vector<float>& values) {
  return std::all_of(
      values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

// Positions of a bone in the world, over the frames.
std::vector<glm::dvec3> track(const Motion& motion, HumanBone bone) {
  std::vector<glm::dvec3> out;
  for (const Pose& pose : motion.poses) {
    out.push_back(
        world_from_joints(motion.skeleton, pose)[index(*motion.skeleton.find(bone))]
            .translation);
  }
  return out;
}

// The definition, written with the angle of the body in place of its axes: everything is
// turned about the vertical by minus the heading.
struct PlainFeatures {
  std::vector<double> heading;
  std::vector<glm::dvec3> hips;
  double leg_m = 0.0;

  explicit PlainFeatures(const Motion& motion) : hips(track(motion, HumanBone::kHips)) {
    using enum HumanBone;
    leg_m = leg_length_m(proportions_of(motion.skeleton));
    const auto la = track(motion, kLeftUpperArm);
    const auto ra = track(motion, kRightUpperArm);
    const auto ll = track(motion, kLeftUpperLeg);
    const auto rl = track(motion, kRightUpperLeg);
    for (std::size_t k = 0; k < la.size(); ++k) {
      const glm::dvec3 across = la[k] - ra[k] + ll[k] - rl[k];
      heading.push_back(std::atan2(-across.z, across.x));
    }
  }
  [[nodiscard]] glm::dvec3 turned(const glm::dvec3& v, std::size_t k) const {
    const double c = std::cos(heading[k]);
    const double s = std::sin(heading[k]);
    return {c * v.x - s * v.z, v.y, s * v.x + c * v.z};
  }
  [[nodiscard]] glm::dvec3 place(const glm::dvec3& p, std::size_t k) const {
    return turned({p.x - hips[k].x, p.y, p.z - hips[k].z}, k) / leg_m;
  }
};

TEST(BodyFeatures, AreThoseOfTheDefinition) {
  using enum HumanBone;
  const Motion motion = random_motion(3, 40, 10.0);
  const std::vector<float> rows = rows_of_motion(motion);
  const PlainFeatures plain(motion);
  ASSERT_EQ(rows.size(), 40U * kFeatureStride);
  constexpr HumanBone kPoints[] = {kHips,
                                   kChest,
                                   kHead,
                                   kLeftLowerArm,
                                   kRightLowerArm,
                                   kLeftHand,
                                   kRightHand,
                                   kLeftLowerLeg,
                                   kRightLowerLeg,
                                   kLeftFoot,
                                   kRightFoot,
                                   kLeftToes,
                                   kRightToes};
  constexpr HumanBone kMoved[] = {kHead, kLeftHand, kRightHand, kLeftFoot, kRightFoot};
  for (std::size_t k = 1; k + 1 < 40; ++k) {
    const float* row = rows.data() + k * kFeatureStride;
    for (std::size_t p = 0; p < 13; ++p) {
      const glm::dvec3 truth = plain.place(track(motion, kPoints[p])[k], k);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(row[3 * p + static_cast<std::size_t>(c)], truth[c], 1e-6);
      }
    }
    for (std::size_t p = 0; p < 5; ++p) {
      const auto path = track(motion, kMoved[p]);
      const glm::dvec3 truth =
          plain.place(path[k + 1], k + 1) - plain.place(path[k - 1], k - 1);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(row[39 + 3 * p + static_cast<std::size_t>(c)], truth[c], 1e-6);
      }
    }
    const glm::dvec3 velocity =
        plain.turned((plain.hips[k + 1] - plain.hips[k - 1]) / 0.2, k) / plain.leg_m;
    EXPECT_NEAR(row[54], 0.5 * velocity.x, 1e-5);
    EXPECT_NEAR(row[55], 0.5 * velocity.z, 1e-5);
    EXPECT_TRUE(std::all_of(row + 57, row + 64, [](float v) { return v == 0.0F; }));
  }
}

// A body that turns on the spot by a known rate.
TEST(BodyFeatures, HaveTheTurnRatePositiveToTheLeft) {
  const Skeleton body = make_humanoid(average_proportions(1.75));
  Motion motion{body, FrameRate{30.0}, 0, {}};
  for (int n = 0; n < 90; ++n) {
    Pose pose = rest_pose(body);
    pose.parent_from_joint[0] = glm::angleAxis(2.0 * n / 30.0, glm::dvec3(0, 1, 0));
    motion.poses.push_back(pose);
  }
  const std::vector<float> rows = rows_of_motion(motion);
  for (std::size_t k = 0; k < rows.size(); k += kFeatureStride) {
    EXPECT_NEAR(rows[k + 56], 0.8 * 2.0, 1e-5);
  }
}

TEST(BodyFeatures, DoNotChangeByAMoveAndATurnOnTheFloor) {
  const Motion motion = random_motion(4, 100, 30.0);
  const std::vector<float> rows = rows_of_motion(motion);
  for (const double turn : {0.3, 2.0, -3.0}) {
    EXPECT_LT(largest_difference(rows, rows_of_motion(moved(motion, turn, 30.0, -7.0))),
              1e-5);
  }
}

TEST(BodyFeatures, DoNotChangeWithTheSizeOfTheBody) {
  const Motion motion = random_motion(5, 100, 30.0);
  const std::vector<float> rows = rows_of_motion(motion);
  for (const double factor : {0.6, 1.7}) {
    EXPECT_LT(largest_difference(rows, rows_of_motion(scaled(motion, factor))), 1e-5);
  }
}

TEST(BodyFeatures, MirrorWithoutTheMirroredMotion) {
  const Motion motion = random_motion(6, 100, 30.0);
  const std::vector<float> rows = rows_of_motion(motion);
  const std::vector<float> mirrored = mirrored_features(rows);
  EXPECT_LT(largest_difference(mirrored, rows_of_motion(reflected(motion))), 1e-5);
  EXPECT_GT(largest_difference(mirrored, rows), 0.1);
  EXPECT_EQ(mirrored_features(mirrored), rows);
}

TEST(BodyFeatures, AreTheSameInAPartBetweenItsEnds) {
  const Motion motion = random_motion(7, 200, 30.0);
  const std::vector<float> whole = rows_of_motion(motion);
  Motion part = motion;
  part.first_frame = 37;
  part.poses.assign(motion.poses.begin() + 37, motion.poses.begin() + 140);
  const BodyFeatures features = body_features(part, mapped(part));
  // Frame 39 is at 1.3 s.
  EXPECT_NEAR(features.start_s, 2.0 / 30.0, 1e-9);
  for (int k = 1; k + 1 < features.count(); ++k) {
    for (std::size_t c = 0; c < kFeatureCount; ++c) {
      EXPECT_EQ(features.rows[static_cast<std::size_t>(k) * kFeatureStride + c],
                whole[static_cast<std::size_t>(k + 13) * kFeatureStride + c]);
    }
  }
}

TEST(BodyFeatures, AreOneRowWithoutRatesForOneFrame) {
  Motion motion = random_motion(8, 1, 30.0);
  for (const int first : {0, 1}) {
    motion.first_frame = first;
    const BodyFeatures features = body_features(motion, mapped(motion));
    ASSERT_EQ(features.count(), 1);
    EXPECT_EQ(features.start_s, 0.0);
    EXPECT_TRUE(std::all_of(features.rows.begin() + 39, features.rows.end(), [](float v) {
      return v == 0.0F;
    }));
  }
  motion.poses.clear();
  EXPECT_EQ(body_features(motion, mapped(motion)).count(), 0);
}

TEST(BodyFeatures, HaveNoRatesAtRest) {
  Motion motion = random_motion(9, 1, 30.0);
  motion.poses.resize(60, motion.poses[0]);
  const BodyFeatures features = body_features(motion, mapped(motion));
  ASSERT_EQ(features.count(), 20);
  for (std::size_t k = 0; k < 20; ++k) {
    for (std::size_t c = 39; c < 57; ++c) {
      EXPECT_NEAR(features.rows[k * kFeatureStride + c], 0.0, 1e-7);
    }
  }
}

// Turned about its long axis, a lying body has no level direction from right to left.
TEST(BodyFeatures, AreFiniteForABodyOnItsSide) {
  const Skeleton body = make_humanoid(average_proportions(1.75));
  Motion motion{body, FrameRate{10.0}, 0, {}};
  const glm::dquat down = glm::angleAxis(-std::numbers::pi / 2, glm::dvec3(1, 0, 0));
  for (int n = 0; n <= 36; ++n) {
    Pose pose = rest_pose(body);
    pose.root_in_world = {0.0, 0.2, 0.0};
    pose.parent_from_joint[0] =
        down * glm::angleAxis(n * std::numbers::pi / 18, glm::dvec3(0, 1, 0));
    motion.poses.push_back(pose);
  }
  const std::vector<float> rows = rows_of_motion(motion);
  EXPECT_TRUE(all_finite(rows));
  // The direction of `forward` flips, but that is no turn of the body.
  for (const float v : rows) EXPECT_LT(std::abs(v), 7.0F);
  // The result depends on no axis of the world but the vertical.
  EXPECT_LT(largest_difference(rows, rows_of_motion(moved(motion, 1.0, 0.0, 0.0))), 1e-5);
}

TEST(BodyFeatures, UseTheNearestBoneForAMissingOne) {
  const Motion motion = random_motion(10, 60, 30.0);
  const std::vector<float> rows = rows_of_motion(motion);
  struct Case {
    HumanBone missing;
    std::size_t column;
    std::size_t other;
  };
  using enum HumanBone;
  for (const Case& c : {Case{kChest, 3, 99},
                        Case{kHead, 6, 99},
                        Case{kLeftToes, 33, 99},
                        Case{kRightToes, 36, 99}}) {
    Motion less = motion;
    less.skeleton = testing::without(motion.skeleton, c.missing);
    const auto gone = index(*motion.skeleton.find(c.missing));
    for (Pose& pose : less.poses) {
      pose.parent_from_joint.erase(pose.parent_from_joint.begin() +
                                   static_cast<std::ptrdiff_t>(gone));
    }
    const std::vector<float> fewer = rows_of_motion(less);
    ASSERT_EQ(fewer.size(), rows.size());
    EXPECT_TRUE(all_finite(fewer));
    // Within half a leg of the missing joint.
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(fewer[c.column + k], rows[c.column + k], 0.5);
    }
  }
}

TEST(BodyFeatures, UseTheForearmsTipWithoutHands) {
  using enum HumanBone;
  Motion motion = random_motion(11, 60, 30.0);
  const std::vector<float> rows = rows_of_motion(motion);
  Skeleton body = motion.skeleton;
  for (const HumanBone hand : {kLeftHand, kRightHand}) {
    const Joint& joint = motion.skeleton[*motion.skeleton.find(hand)];
    const auto forearm =
        index(*body.find(hand == kLeftHand ? kLeftLowerArm : kRightLowerArm));
    body.joints[forearm].tip_in_joint = joint.parent_from_joint.translation;
    body.joints[index(*body.find(hand))].bone.reset();
  }
  motion.skeleton = body;
  const std::vector<float> with_tips = rows_of_motion(motion);
  EXPECT_LT(largest_difference(rows, with_tips), 1e-5);
  for (Joint& joint : motion.skeleton.joints) joint.tip_in_joint.reset();
  const std::vector<float> without = rows_of_motion(motion);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(without[15 + k], without[9 + k]);   // Left hand, left elbow.
    EXPECT_EQ(without[18 + k], without[12 + k]);  // Right hand, right elbow.
  }
}

}  // namespace
}  // namespace marey::library
