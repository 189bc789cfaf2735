// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "reconstruct/posture/posture.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"
#include "tests/support/bodies/random_bodies.h"

// A limb has two descriptions. The solver of reconstruct/ stores a rotation from the
// T-pose, the flexion and two twists (LimbParameters); retarget/ stores Kulpa's frame
// (2005, 1.1.2) (Z from root to end, X towards elbow or knee), the extension and two
// twists (NormalizedLimb). A motion goes from one to the other through its joints.
namespace marey {
namespace {

using reconstruct::kLimbParameters;
using reconstruct::LimbParameters;
using reconstruct::PoseParameter;
using testing::Dice;

/// A limb of the solver, and the same limb as retarget/ sees it.
struct TwoDescriptions {
  glm::dquat frame;
  double flexion_rad;
  double upper_twist_rad;
  double lower_twist_rad;
  double upper_m;
  double lower_m;
  retarget::NormalizedLimb normalized;
};

/// Describes the four limbs of a random body in a random posture whose elbows and knees
/// bend by `flexion_rad`.
std::vector<TwoDescriptions> describe_limbs(unsigned seed, double flexion_rad) {
  Dice dice(seed);
  const double stature_m = dice.between(1.0, 2.1);
  const Proportions average = average_proportions(stature_m);
  reconstruct::Lengths lengths = reconstruct::lengths_of(average);
  for (double& length_m : lengths) length_m *= dice.between(0.9, 1.1);
  const reconstruct::BodyConstants body = reconstruct::body_constants(average);
  reconstruct::Posture posture;
  for (const LimbParameters& limb : kLimbParameters) {
    posture.set_rotation(limb.frame, dice.turn(3.0));
    posture.set_rotation(limb.extremity, dice.turn(3.0));
    *posture.block(limb.flexion) = flexion_rad;
    *posture.block(limb.upper_twist) = dice.between(-1.2, 1.2);
    *posture.block(limb.lower_twist) = dice.between(-1.2, 1.2);
  }
  const Skeleton skeleton =
      make_humanoid(reconstruct::to_proportions(lengths, body, average));
  const Pose pose = reconstruct::to_pose(posture, skeleton, lengths, body);
  const auto map = retarget::map_body(skeleton);
  EXPECT_TRUE(map) << (map ? "" : map.error().message());
  if (!map) return {};
  const retarget::NormalizedPose normalized = retarget::normalize(skeleton, *map, pose);
  std::vector<TwoDescriptions> limbs;
  for (std::size_t i = 0; i < kLimbParameters.size(); ++i) {
    const LimbParameters& limb = kLimbParameters[i];
    EXPECT_TRUE(normalized.limbs[i]);
    if (!normalized.limbs[i]) continue;
    limbs.push_back({posture.rotation(limb.frame),
                     *posture.block(limb.flexion),
                     *posture.block(limb.upper_twist),
                     *posture.block(limb.lower_twist),
                     lengths[index(limb.upper)],
                     lengths[index(limb.lower)],
                     *normalized.limbs[i]});
  }
  return limbs;
}

TEST(LimbDescriptions, AgreeOnTheFrameForBentLimbs) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    const auto limbs = describe_limbs(seed, 0.3 + 2.0 * (seed % 100) / 100.0);
    ASSERT_EQ(limbs.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", limb " + std::to_string(i));
      const glm::dvec3 z = reconstruct::limb_axis(i);
      // Bending about the hinge n moves the middle joint towards X = Z x n.
      const glm::dvec3 x = glm::cross(z, human_limbs()[i].hinge_axis);
      const glm::dquat& now = limbs[i].normalized.world_from_limb;
      EXPECT_LT(glm::distance(now * glm::dvec3(0, 0, 1), limbs[i].frame * z), 1e-9);
      EXPECT_LT(glm::distance(now * glm::dvec3(1, 0, 0), limbs[i].frame * x), 1e-9);
    }
  }
}

TEST(LimbDescriptions, AgreeOnExtensionAndFlexion) {
  for (unsigned seed = 301; seed <= 600; ++seed) {
    for (const TwoDescriptions& limb : describe_limbs(seed, 2.3 * (seed - 301) / 300.0)) {
      // Law of cosines: the angle between the bones is pi - flexion.
      const double distance_m =
          std::sqrt(limb.upper_m * limb.upper_m + limb.lower_m * limb.lower_m +
                    2.0 * limb.upper_m * limb.lower_m * std::cos(limb.flexion_rad));
      EXPECT_NEAR(
          limb.normalized.extension, distance_m / (limb.upper_m + limb.lower_m), 1e-12)
          << "seed " << seed;
    }
  }
}

TEST(LimbDescriptions, AgreeOnBothTwists) {
  for (unsigned seed = 601; seed <= 900; ++seed) {
    for (const TwoDescriptions& limb :
         describe_limbs(seed, 0.3 + 2.0 * (seed % 100) / 100.0)) {
      EXPECT_NEAR(limb.normalized.upper_twist_rad, limb.upper_twist_rad, 1e-9)
          << "seed " << seed;
      EXPECT_NEAR(limb.normalized.lower_twist_rad, limb.lower_twist_rad, 1e-9)
          << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace marey
