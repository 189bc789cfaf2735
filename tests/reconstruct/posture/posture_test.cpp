// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/posture.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <ceres/jet.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "reconstruct/clusters/sightings.h"
#include "tests/reconstruct/random_posture.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Dice;

double turn_between_rad(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b));
}

TEST(PostureStorage, HoldsEveryBlockOnceAndNothingElse) {
  std::set<const double*> numbers;
  const Posture posture;
  int freedom = 0;
  for (const PoseParameter parameter : kAllPoseParameters) {
    for (int i = 0; i < block_size(parameter); ++i)
      numbers.insert(posture.block(parameter) + i);
    freedom += tangent_size(parameter);
  }
  EXPECT_EQ(numbers.size(), static_cast<std::size_t>(kPostureStorage));
  EXPECT_EQ(*numbers.begin(), posture.values.data());
  EXPECT_EQ(*numbers.rbegin(), posture.values.data() + kPostureStorage - 1);
  EXPECT_EQ(freedom, kPostureFreedom);
}

TEST(PostureStorage, GivesBackRotations) {
  Dice dice(1);
  Posture posture;
  const glm::dquat q = dice.turn(3.0);
  posture.set_rotation(PoseParameter::kRightFoot, q);
  EXPECT_EQ(posture.rotation(PoseParameter::kRightFoot), q);
}

TEST(ToProportions, IsUndoneByLengthsOf) {
  Dice dice(2);
  const Lengths lengths = random_lengths(dice);
  const BodyConstants frame = average_frame();
  const Proportions p = to_proportions(lengths, frame, average_proportions(1.75));
  const Lengths back = lengths_of(p);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    EXPECT_NEAR(back[i], lengths[i], 1e-15);
  }
  EXPECT_EQ(body_constants(p).hips_above_hip_centres_m, frame.hips_above_hip_centres_m);
}

TEST(BoneFrameOfPosture, AgreesWithThePosesForwardKinematics) {
  Dice dice(3);
  for (int run = 0; run < 10; ++run) {
    const Lengths lengths = random_lengths(dice);
    const BodyConstants frame = average_frame();
    const Skeleton skeleton =
        make_humanoid(to_proportions(lengths, frame, average_proportions(1.75)));
    const Posture posture = random_posture(dice);
    const auto world =
        world_from_joints(skeleton, to_pose(posture, skeleton, lengths, frame));
    for (const HumanBone bone : human_bones()) {
      // Toes have no posture of their own.
      if (solved_segment(bone) != bone) continue;
      const RigidTransform found = world_from_bone(bone, posture, lengths, frame);
      EXPECT_LT(glm::distance(found.translation, world[index(bone)].translation), 1e-12)
          << name(bone);
      EXPECT_LT(turn_between_rad(found.rotation, world[index(bone)].rotation), 1e-12)
          << name(bone);
    }
  }
}

TEST(BoneFrameOfPosture, ClosesTheTriangleOfEveryLimb) {
  Dice dice(4);
  const Lengths lengths = random_lengths(dice);
  const BodyConstants frame = average_frame();
  const Posture posture = random_posture(dice);
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    const LimbParameters& parameters = kLimbParameters[limb];
    const HumanLimb& bones = human_limbs()[limb];
    const auto at = [&](HumanBone bone) {
      return world_from_bone(bone, posture, lengths, frame).translation;
    };
    const glm::dvec3 reach = at(bones.end) - at(bones.upper);
    const double l1 = lengths[index(parameters.upper)];
    const double l2 = lengths[index(parameters.lower)];
    const double flexion = *posture.block(parameters.flexion);
    // The law of cosines, along the limb's frame.
    const double reach_m =
        std::sqrt(l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * std::cos(flexion));
    EXPECT_LT(
        glm::distance(reach,
                      reach_m * (posture.rotation(parameters.frame) * limb_axis(limb))),
        1e-12);
    EXPECT_NEAR(glm::distance(at(bones.lower), at(bones.upper)), l1, 1e-12);
    EXPECT_NEAR(glm::distance(at(bones.end), at(bones.lower)), l2, 1e-12);
  }
}

TEST(BoneFrameOfPosture, BendsTheSpineHalfWayAtItsMiddle) {
  Dice dice(5);
  const Posture posture = random_posture(dice);
  const glm::dquat spine =
      world_from_bone(HumanBone::kSpine, posture, random_lengths(dice), average_frame())
          .rotation;
  const double whole = turn_between_rad(posture.rotation(PoseParameter::kHips),
                                        posture.rotation(PoseParameter::kAbdomenEnd));
  EXPECT_NEAR(turn_between_rad(posture.rotation(PoseParameter::kHips), spine),
              0.5 * whole,
              1e-12);
  EXPECT_NEAR(turn_between_rad(spine, posture.rotation(PoseParameter::kAbdomenEnd)),
              0.5 * whole,
              1e-12);
}

TEST(SlotsOf, ListsExactlyTheParametersThatMoveTheBone) {
  Dice dice(6);
  const Lengths lengths = random_lengths(dice);
  const BodyConstants frame = average_frame();
  const Posture posture = random_posture(dice);
  for (const HumanBone bone : human_bones()) {
    if (solved_segment(bone) != bone) continue;
    const std::vector<PoseParameter> parameters = parameters_of(bone);
    EXPECT_TRUE(std::is_sorted(parameters.begin(), parameters.end())) << name(bone);
    const RigidTransform before = world_from_bone(bone, posture, lengths, frame);
    for (const PoseParameter parameter : kAllPoseParameters) {
      Posture other = posture;
      if (is_rotation(parameter)) {
        other.set_rotation(parameter,
                           glm::normalize(posture.rotation(parameter) * dice.turn(0.5)));
      } else {
        *other.block(parameter) += 0.1;
      }
      const RigidTransform after = world_from_bone(bone, other, lengths, frame);
      const bool moved = glm::distance(before.translation, after.translation) > 1e-6 ||
                         turn_between_rad(before.rotation, after.rotation) > 1e-6;
      const bool listed =
          std::find(parameters.begin(), parameters.end(), parameter) != parameters.end();
      EXPECT_EQ(moved, listed) << name(bone) << ", slot " << static_cast<int>(parameter);
    }
  }
}

/// One bone's frame as seven numbers, every number of the posture a Jet.
using Jet = ceres::Jet<double, kPostureStorage>;

std::array<Jet, 7> jet_frame(HumanBone bone,
                             const Posture& posture,
                             const Lengths& lengths,
                             const BodyConstants& body) {
  std::array<Jet, kPostureStorage> values;
  for (int i = 0; i < kPostureStorage; ++i) {
    values[static_cast<std::size_t>(i)] =
        Jet(posture.values[static_cast<std::size_t>(i)], i);
  }
  std::array<const Jet*, kPoseParameterCount> blocks{};
  for (const PoseParameter parameter : kAllPoseParameters) {
    blocks[index(parameter)] =
        &values[static_cast<std::size_t>(storage_offset(parameter))];
  }
  const BoneFrame<Jet> f = bone_frame<Jet, double>(bone, blocks, lengths.data(), body);
  return {f.rotation.x(),
          f.rotation.y(),
          f.rotation.z(),
          f.rotation.w(),
          f.origin.x(),
          f.origin.y(),
          f.origin.z()};
}

std::array<double, 7> plain_frame(HumanBone bone,
                                  const Posture& posture,
                                  const Lengths& lengths,
                                  const BodyConstants& body) {
  std::array<const double*, kPoseParameterCount> blocks{};
  for (const PoseParameter parameter : kAllPoseParameters)
    blocks[index(parameter)] = posture.block(parameter);
  const auto f = bone_frame<double, double>(bone, blocks, lengths.data(), body);
  return {f.rotation.x(),
          f.rotation.y(),
          f.rotation.z(),
          f.rotation.w(),
          f.origin.x(),
          f.origin.y(),
          f.origin.z()};
}

TEST(BoneFrameOfPosture, HasTheDerivativesThatFiniteDifferencesShow) {
  Dice dice(7);
  const Lengths lengths = random_lengths(dice);
  const BodyConstants body = average_frame();
  const Posture posture = random_posture(dice);
  constexpr double kDifferenceStep = 1e-6;
  for (const HumanBone bone : human_bones()) {
    if (solved_segment(bone) != bone) continue;
    const auto jets = jet_frame(bone, posture, lengths, body);
    for (std::size_t i = 0; i < posture.values.size(); ++i) {
      Posture low = posture;
      Posture high = posture;
      low.values[i] -= kDifferenceStep;
      high.values[i] += kDifferenceStep;
      const auto before = plain_frame(bone, low, lengths, body);
      const auto after = plain_frame(bone, high, lengths, body);
      for (std::size_t row = 0; row < jets.size(); ++row) {
        // Rounding 1e-16 over the step, and the step squared.
        EXPECT_NEAR(jets[row].v[static_cast<Eigen::Index>(i)],
                    (after[row] - before[row]) / (2.0 * kDifferenceStep),
                    1e-8)
            << name(bone) << ", number " << i;
      }
    }
  }
}

}  // namespace
}  // namespace marey::reconstruct
