// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/initial_posture.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "reconstruct/clusters/sightings.h"
#include "tests/reconstruct/random_posture.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Dice;

double turn_rad(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b));
}

std::map<HumanBone, RigidTransform> segments_of(const Posture& posture,
                                                const Lengths& lengths,
                                                const BodyConstants& body) {
  std::map<HumanBone, RigidTransform> segments;
  for (const HumanBone bone : human_bones()) {
    if (solved_segment(bone) != bone) continue;
    segments[bone] = world_from_bone(bone, posture, lengths, body);
  }
  return segments;
}

TEST(PostureFromSegments, IsExactWhenTheSegmentsFitTogether) {
  Dice dice(1);
  const BodyConstants body = average_frame();
  for (int run = 0; run < 20; ++run) {
    const Lengths lengths = random_lengths(dice);
    const Posture truth = random_posture(dice);
    const auto segments = segments_of(truth, lengths, body);
    const Posture found = posture_from_segments(segments, lengths, body, Posture{});
    for (const auto& [bone, expected] : segments) {
      const RigidTransform placed = world_from_bone(bone, found, lengths, body);
      EXPECT_LT(glm::distance(placed.translation, expected.translation), 1e-9)
          << name(bone);
      // The end of collar bones is determined, not their rotation.
      const bool collar =
          bone == HumanBone::kLeftShoulder || bone == HumanBone::kRightShoulder;
      if (!collar) {
        EXPECT_LT(turn_rad(placed.rotation, expected.rotation), 1e-9) << name(bone);
      }
    }
  }
}

TEST(PostureFromSegments, KeepsALimbThatWasNotFoundAgainstItsTrunk) {
  Dice dice(2);
  const Lengths lengths = random_lengths(dice);
  const BodyConstants body = average_frame();
  const Posture before = random_posture(dice);
  auto segments = segments_of(before, lengths, body);
  // The whole body turned and moved; the left leg is not seen.
  const RigidTransform motion{dice.turn(1.0), {0.3, -0.1, 0.2}};
  for (auto& [bone, pose] : segments) pose = motion * pose;
  const auto all = segments;
  for (const HumanBone bone :
       {HumanBone::kLeftUpperLeg, HumanBone::kLeftLowerLeg, HumanBone::kLeftFoot}) {
    segments.erase(bone);
  }
  const Posture found = posture_from_segments(segments, lengths, body, before);
  const RigidTransform foot = world_from_bone(HumanBone::kLeftFoot, found, lengths, body);
  EXPECT_LT(glm::distance(foot.translation, all.at(HumanBone::kLeftFoot).translation),
            1e-9);
  EXPECT_LT(turn_rad(foot.rotation, all.at(HumanBone::kLeftFoot).rotation), 1e-9);
}

TEST(PostureFromSegments, IsTheFallbackWhenNothingWasFound) {
  Dice dice(3);
  const Lengths lengths = random_lengths(dice);
  const BodyConstants body = average_frame();
  const Posture fallback = random_posture(dice);
  const Posture found = posture_from_segments(FoundSegments{}, lengths, body, fallback);
  for (const HumanBone bone : {HumanBone::kHips,
                               HumanBone::kUpperChest,
                               HumanBone::kHead,
                               HumanBone::kLeftHand,
                               HumanBone::kRightFoot}) {
    EXPECT_LT(turn_rad(world_from_bone(bone, found, lengths, body).rotation,
                       world_from_bone(bone, fallback, lengths, body).rotation),
              1e-9)
        << name(bone);
  }
}

TEST(Extrapolate, GoesOnAsBeforeAtAFullShare) {
  Dice dice(4);
  const Posture first = random_posture(dice);
  Posture second = first;
  const glm::dquat step = rotation_from_vector({0.05, -0.02, 0.03});
  second.set_rotation(PoseParameter::kLeftArm,
                      step * first.rotation(PoseParameter::kLeftArm));
  second.block(PoseParameter::kHipsPosition)[0] += 0.02;
  *second.block(PoseParameter::kLeftKnee) += 0.1;
  const Posture third = extrapolate(first, second, 1.0);
  EXPECT_LT(turn_rad(third.rotation(PoseParameter::kLeftArm),
                     step * step * first.rotation(PoseParameter::kLeftArm)),
            1e-12);
  EXPECT_NEAR(third.block(PoseParameter::kHipsPosition)[0],
              first.block(PoseParameter::kHipsPosition)[0] + 0.04,
              1e-12);
  EXPECT_NEAR(*third.block(PoseParameter::kLeftKnee),
              *first.block(PoseParameter::kLeftKnee) + 0.2,
              1e-12);
}

TEST(Extrapolate, StandsStillAtNoShare) {
  Dice dice(5);
  const Posture first = random_posture(dice);
  const Posture second = random_posture(dice);
  const Posture third = extrapolate(first, second, 0.0);
  for (std::size_t i = 0; i < third.values.size(); ++i) {
    EXPECT_NEAR(third.values[i], second.values[i], 1e-12);
  }
}

}  // namespace
}  // namespace marey::reconstruct
