// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/normalized_skeleton.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using testing::Dice;

glm::dquat t_pose_turn(const BodyMap& map,
                       const std::vector<RigidTransform>& frames,
                       JointIndex joint) {
  return frames[index(joint)].rotation *
         glm::conjugate(map.joints[index(joint)].t_pose_from_joint);
}

TEST(Normalize, ScalesTheRootHeightWithTheLegs) {
  Dice dice(21);
  const Skeleton source = testing::random_humanoid(dice);
  const Skeleton avatar = testing::giant();
  const BodyMap from = mapped(source);
  const BodyMap to = mapped(avatar);
  const Pose pose = testing::random_pose(source, dice);
  const Pose adapted = expand(normalize(source, from, pose), avatar, to);
  EXPECT_NEAR(adapted.root_in_world.y,
              pose.root_in_world.y * to.leg_length_m / from.leg_length_m,
              1e-12);
}

TEST(Normalize, ScalesTheRootWithTheArmsWhenWalkingOnHands) {
  Dice dice(22);
  const Skeleton source = testing::random_humanoid(dice);
  const Skeleton avatar = testing::child();
  const BodyMap from = mapped(source);
  const BodyMap to = mapped(avatar);
  const Pose pose = testing::random_pose(source, dice);
  const Pose adapted =
      expand(normalize(source, from, pose, RootNormalization::kArmLength), avatar, to);
  EXPECT_NEAR(adapted.root_in_world.y,
              pose.root_in_world.y * to.arm_length_m / from.arm_length_m,
              1e-12);
}

TEST(Normalize, LeavesTheRootInMetresWhenAskedTo) {
  Dice dice(23);
  const Skeleton source = testing::random_humanoid(dice);
  const Skeleton avatar = testing::child();
  const Pose pose = testing::random_pose(source, dice);
  const Pose adapted =
      expand(normalize(source, mapped(source), pose, RootNormalization::kNone),
             avatar,
             mapped(avatar));
  EXPECT_LT(glm::distance(adapted.root_in_world, pose.root_in_world), 1e-12);
}

TEST(Normalize, KeepsAStraightLimbStraightOnAnyBody) {
  Dice dice(24);
  for (int k = 0; k < 50; ++k) {
    const Skeleton source = testing::random_humanoid(dice);
    const BodyMap from = mapped(source);
    Pose pose = rest_pose(source);
    const LimbMap& leg = from.leg(0);
    pose.parent_from_joint[index(leg.upper)] = dice.turn(1.5);
    // A limb is straight if both bones lie in one line, for any rest directions.
    const glm::dvec3 upper = source[leg.lower].parent_from_joint.translation;
    const glm::dvec3 lower = source[leg.end].parent_from_joint.translation;
    pose.parent_from_joint[index(leg.lower)] = rotation_between(lower, upper);
    const Skeleton avatar = testing::random_humanoid(dice);
    const BodyMap to = mapped(avatar);
    const auto frames =
        world_from_joints(avatar, expand(normalize(source, from, pose), avatar, to));
    const double reach = glm::distance(frames[index(to.leg(0).upper)].translation,
                                       frames[index(to.leg(0).end)].translation);
    EXPECT_NEAR(reach, to.leg(0).length_m(), 1e-9);
  }
}

// A bent knee stays in the half-plane that the source's knee is in.
TEST(Normalize, KeepsTheHalfPlaneOfABentLimb) {
  Dice dice(25);
  for (int k = 0; k < 200; ++k) {
    const Skeleton source = testing::random_humanoid(dice);
    const BodyMap from = mapped(source);
    const Pose pose = testing::random_pose(source, dice);
    const auto source_frames = world_from_joints(source, pose);
    const Skeleton avatar = testing::random_humanoid(dice);
    const BodyMap to = mapped(avatar);
    const auto frames =
        world_from_joints(avatar, expand(normalize(source, from, pose), avatar, to));
    for (std::size_t i = 0; i < 4; ++i) {
      const auto side = [](const LimbMap& limb, const std::vector<RigidTransform>& f) {
        const glm::dvec3 root = f[index(limb.upper)].translation;
        const glm::dvec3 axis = glm::normalize(f[index(limb.end)].translation - root);
        const glm::dvec3 mid = f[index(limb.lower)].translation - root;
        return (mid - axis * glm::dot(mid, axis)) / limb.length_m();
      };
      const glm::dvec3 wanted = side(*from.limbs[i], source_frames);
      const glm::dvec3 got = side(*to.limbs[i], frames);
      if (glm::length(wanted) < 0.06 || glm::length(got) < 0.06) continue;
      EXPECT_LT(glm::distance(glm::normalize(wanted), glm::normalize(got)), 1e-6);
    }
  }
}

// Just before straight, the hinge decides the direction of the knee; there is no jump on
// the way from bent to straight.
TEST(Normalize, TurnsTheHalfPlaneOfAStraighteningLimbContinuously) {
  const Skeleton body = testing::long_legs();
  const BodyMap map = mapped(body);
  Pose pose = rest_pose(body);
  std::optional<glm::dquat> before;
  for (double bend = 0.6; bend > -1e-9; bend -= 0.002) {
    // The knee bends 40 degrees away from its hinge.
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 0.0, 0.8391));
    pose.parent_from_joint[index(map.leg(0).lower)] = glm::angleAxis(bend, axis);
    const glm::dquat frame = normalize(body, map, pose).limbs[2]->world_from_limb;
    if (before) {
      EXPECT_LT(glm::length(rotation_vector(glm::conjugate(*before) * frame)), 0.03);
    }
    before = frame;
  }
  const glm::dvec3 knee_side = *before * glm::dvec3(1, 0, 0);
  EXPECT_GT(knee_side.z, 0.99);
}

TEST(Normalize, KeepsTheTurnOfEveryLimbBoneAboutItself) {
  Dice dice(26);
  const Skeleton source = testing::random_humanoid(dice);
  const Skeleton avatar = testing::in_a_pose(testing::giant(), 0.7);
  const BodyMap from = mapped(source);
  const BodyMap to = mapped(avatar);
  Pose pose = rest_pose(source);
  // Palm turned up: the forearm turns about its own axis.
  const glm::dquat palm_up = glm::angleAxis(1.2, glm::dvec3(1, 0, 0));
  const std::size_t forearm = index(from.limbs[0]->lower);
  pose.parent_from_joint[forearm] = pose.parent_from_joint[forearm] *
                                    glm::inverse(from.joints[forearm].t_pose_from_joint) *
                                    palm_up * from.joints[forearm].t_pose_from_joint;
  const NormalizedPose posture = normalize(source, from, pose);
  const NormalizedPose again = normalize(avatar, to, expand(posture, avatar, to));
  // Other segment ratios change the elbow's bend a little, which turns the two untwisted
  // frames by the product of two small angles.
  EXPECT_NEAR(again.limbs[0]->lower_twist_rad, posture.limbs[0]->lower_twist_rad, 1e-4);
  EXPECT_NEAR(again.limbs[0]->upper_twist_rad, posture.limbs[0]->upper_twist_rad, 1e-4);
}

// The T-pose of an A-posed avatar is the T-pose.
TEST(Normalize, StretchesTheArmsOfAnAPosedAvatarWhenTheSourceDoes) {
  const Skeleton source = testing::child();
  Dice dice(27);
  const Skeleton avatar =
      testing::with_random_axes(testing::in_a_pose(testing::giant(), 0.8), dice);
  const BodyMap to = mapped(avatar);
  const auto frames = world_from_joints(
      avatar, expand(normalize(source, mapped(source), rest_pose(source)), avatar, to));
  const glm::dvec3 arm = frames[index(to.limbs[0]->end)].translation -
                         frames[index(to.limbs[0]->upper)].translation;
  EXPECT_LT(glm::distance(glm::normalize(arm), glm::dvec3(1, 0, 0)), 1e-9);
}

TEST(Normalize, KeepsTheEndsOfTheSpineFromThreeVertebraeToFiveAndBack) {
  Dice dice(28);
  const Skeleton plain = testing::random_humanoid(dice);
  const Skeleton three = testing::with_vertebrae(plain, 3);
  const Skeleton five = testing::with_vertebrae(plain, 5);
  const BodyMap map3 = mapped(three);
  const BodyMap map5 = mapped(five);
  for (int k = 0; k < 50; ++k) {
    const Pose pose = testing::random_pose(three, dice);
    const Pose over = expand(normalize(three, map3, pose), five, map5);
    const Pose back = expand(normalize(five, map5, over), three, map3);
    const auto before = world_from_joints(three, pose);
    const auto after = world_from_joints(three, back);
    for (const JointIndex joint : {JointIndex{0}, JointIndex{3}}) {
      const glm::dquat turned = glm::conjugate(t_pose_turn(map3, before, joint)) *
                                t_pose_turn(map3, after, joint);
      EXPECT_LT(glm::length(rotation_vector(turned)), 1e-9);
    }
  }
}

// Four vertebrae that bend by 0.2 each.
struct SteadyBend {
  Skeleton few = testing::with_vertebrae(testing::giant(), 4);
  Pose pose = rest_pose(few);

  SteadyBend() {
    for (std::size_t k = 1; k <= 4; ++k) {
      pose.parent_from_joint[k] = glm::angleAxis(0.2, glm::dvec3(1, 0, 0));
    }
  }
};

// A uniform bend stays uniform for any number of vertebrae, if the curve does not contain
// the spine's end.
TEST(Normalize, SharesASteadyBendOutOverMoreVertebrae) {
  const SteadyBend bend;
  const Skeleton many = testing::with_vertebrae(testing::giant(), 8);
  const BodyMap map = mapped(many);
  NormalizedPose posture = normalize(bend.few, mapped(bend.few), bend.pose);
  posture.spine.reset();
  const Pose adapted = expand(posture, many, map);
  for (std::size_t k = 1; k <= 8; ++k) {
    EXPECT_NEAR(glm::length(rotation_vector(adapted.parent_from_joint[k])), 0.1, 1e-6);
  }
}

// If it does: eight vertebrae that bend by 0.1 each would leave the neck of this giant
// five millimetres high, because four begin to bend further from the hips. The neck is at
// the position of the four, and every one of the eight still bends that way.
TEST(Normalize, SharesASteadyBendOutSoThatTheNeckIsWhereItWas) {
  const SteadyBend bend;
  const Skeleton many = testing::with_vertebrae(testing::giant(), 8);
  const BodyMap map = mapped(many);
  const Pose adapted =
      expand(normalize(bend.few, mapped(bend.few), bend.pose), many, map);
  const auto neck = [](const Skeleton& body, const Pose& pose) {
    return world_from_joints(body, pose)[index(*body.find(HumanBone::kNeck))].translation;
  };
  EXPECT_LT(glm::distance(neck(bend.few, bend.pose), neck(many, adapted)), 1e-3);
  for (std::size_t k = 1; k <= 8; ++k) {
    const glm::dvec3 turn = rotation_vector(adapted.parent_from_joint[k]);
    EXPECT_GT(turn.x, 0.03);
    EXPECT_LT(turn.x, 0.13);
    EXPECT_LT(std::abs(turn.y) + std::abs(turn.z), 1e-6);
  }
}

// Some files have a vertebra without length: it turns apart from its neighbours, also on
// a body that is smaller all over.
TEST(Normalize, SharesASpineOutAlikeOnBodiesOfAllSizes) {
  Dice dice(31);
  for (const std::size_t coincident : {2U, 3U, 4U}) {
    Skeleton source = testing::with_vertebrae(testing::giant(), 4);
    source.joints[coincident].parent_from_joint.translation = glm::dvec3(0.0);
    Skeleton small = source;
    for (Joint& joint : small.joints) {
      joint.parent_from_joint.translation *= 0.7;
      if (joint.tip_in_joint) *joint.tip_in_joint *= 0.7;
    }
    const Pose pose = testing::random_pose(source, dice);
    const Pose adapted =
        expand(normalize(source, mapped(source), pose), small, mapped(small));
    for (std::size_t k = 1; k <= 4; ++k) {
      const glm::dquat& was = pose.parent_from_joint[k];
      const glm::dquat& is = adapted.parent_from_joint[k];
      EXPECT_LT(glm::length(rotation_vector(glm::conjugate(was) * is)), 1e-7)
          << "vertebra " << k << ", without length: " << coincident;
    }
  }
}

TEST(Normalize, GivesTheMirrorImageOfTheMirrorImage) {
  Dice dice(29);
  const Skeleton source = testing::random_humanoid(dice);
  const Skeleton avatar = testing::random_humanoid(dice);
  const Skeleton source_m = testing::mirrored_body(source);
  const Skeleton avatar_m = testing::mirrored_body(avatar);
  const Pose pose = testing::random_pose(source, dice);
  Pose pose_m = pose;
  pose_m.root_in_world.x *= -1.0;
  for (glm::dquat& q : pose_m.parent_from_joint) q = {q.w, q.x, -q.y, -q.z};
  const auto frames = world_from_joints(
      avatar, expand(normalize(source, mapped(source), pose), avatar, mapped(avatar)));
  const auto frames_m = world_from_joints(
      avatar_m,
      expand(normalize(source_m, mapped(source_m), pose_m), avatar_m, mapped(avatar_m)));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const glm::dvec3 reflected = frames_m[i].translation * glm::dvec3(-1, 1, 1);
    EXPECT_LT(glm::distance(frames[i].translation, reflected), 1e-9);
  }
}

// A target out of reach: the leg is straight and points to it.
TEST(Expand, StretchesALimbThatCannotReach) {
  const Skeleton body = testing::child();
  const BodyMap map = mapped(body);
  NormalizedPose posture = normalize(body, map, rest_pose(body));
  posture.limbs[2]->extension = 1.7;
  const auto frames = world_from_joints(body, expand(posture, body, map));
  EXPECT_NEAR(glm::distance(frames[index(map.leg(0).upper)].translation,
                            frames[index(map.leg(0).end)].translation),
              map.leg(0).length_m(),
              1e-12);
}

TEST(Expand, LeavesFingersAsTheyRest) {
  Dice dice(30);
  const Skeleton source = testing::random_humanoid(dice);
  const Skeleton avatar = testing::with_extra_joints(testing::giant());
  const Pose adapted =
      expand(normalize(source, mapped(source), testing::random_pose(source, dice)),
             avatar,
             mapped(avatar));
  const auto finger = avatar.find("leftHandFinger");
  ASSERT_TRUE(finger);
  EXPECT_EQ(adapted.parent_from_joint[index(*finger)],
            avatar[*finger].parent_from_joint.rotation);
}

}  // namespace
}  // namespace marey::retarget
