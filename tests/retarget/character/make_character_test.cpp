// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/character/make_character.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/joint_ranges.h"
#include "core/pose.h"
#include "retarget/character/check_character.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/paths.h"
#include "tests/support/truth/truth_motion.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using testing::Dice;

Character made(const Skeleton& skeleton, const CharacterTraits& traits = {}) {
  Result<Character> character =
      make_character("test", skeleton, mapped(skeleton), traits);
  EXPECT_TRUE(character) << (character ? "" : character.error().message());
  return character ? *std::move(character) : Character{};
}

// "left arm: S hand, L upper lower hand, S shoulder"
std::string in_words(const Character& character, const BodyGroup& group) {
  std::string text = group.name + ":";
  for (const BodyPart& part : group.parts) {
    text += part.kind == PartKind::kLimb      ? " L"
            : part.kind == PartKind::kSection ? " V"
                                              : " S";
    for (const JointIndex joint : part.joints) {
      text += "." + character.skeleton[joint].name;
    }
  }
  return text;
}

TEST(MakeCharacter, HasTheGroupsOfTheThesisInItsOrder) {
  const Character character = made(testing::giant());
  std::vector<std::string> words;
  for (const BodyGroup& group : character.groups) {
    words.push_back(in_words(character, group));
  }
  const std::vector<std::string> wanted{
      "head: S.head S.neck",
      "right arm: S.rightHand L.rightUpperArm.rightLowerArm.rightHand S.rightShoulder",
      "left arm: S.leftHand L.leftUpperArm.leftLowerArm.leftHand S.leftShoulder",
      "right leg: S.rightToes S.rightFoot L.rightUpperLeg.rightLowerLeg.rightFoot",
      "left leg: S.leftToes S.leftFoot L.leftUpperLeg.leftLowerLeg.leftFoot",
      "trunk: V.spine V.chest.upperChest",
      "root: S.hips"};
  EXPECT_EQ(words, wanted);
}

TEST(MakeCharacter, HangsItsGroupsAsFigure44) {
  const Character character = made(testing::child());
  const std::vector<int> levels{3, 3, 3, 2, 2, 2, 1};
  const std::vector<int> parents{5, 5, 5, 6, 6, 6, -1};
  ASSERT_EQ(character.groups.size(), 7U);
  for (std::size_t g = 0; g < 7; ++g) {
    const BodyGroup& group = character.groups[g];
    EXPECT_EQ(group.level, levels[g]);
    EXPECT_EQ(group.parent.value_or(-1), parents[g]);
    EXPECT_EQ(group.can_support, g == 3 || g == 4) << group.name;
    EXPECT_EQ(group.balances, g != 0) << group.name;
  }
}

TEST(MakeCharacter, DoesWithoutWhatABodyLacks) {
  Skeleton body = testing::child();
  for (const B bone : {B::kNeck, B::kLeftShoulder, B::kRightToes, B::kLeftHand}) {
    body = testing::without(body, bone);
  }
  const Character character = made(body);
  ASSERT_EQ(character.groups.size(), 7U);
  EXPECT_EQ(in_words(character, character.groups[0]), "head: S.head");
  EXPECT_EQ(in_words(character, character.groups[2]),
            "left arm: S.leftLowerArm S.leftUpperArm");
  EXPECT_EQ(in_words(character, character.groups[3]),
            "right leg: S.rightFoot L.rightUpperLeg.rightLowerLeg.rightFoot");
}

// In a body without vertebrae, arms and head are children of the root.
TEST(MakeCharacter, HangsArmsOnTheRootWithoutATrunk) {
  Skeleton body = testing::child();
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest}) {
    body = testing::without(body, bone);
  }
  const Character character = made(body);
  ASSERT_EQ(character.groups.size(), 6U);
  for (std::size_t g = 0; g < 5; ++g) {
    EXPECT_EQ(character.groups[g].level, 2);
    EXPECT_EQ(character.groups[g].parent, 5);
  }
}

class EveryCharacter : public ::testing::TestWithParam<int> {};

// With any number of vertebrae and any axes of joints.
TEST_P(EveryCharacter, PassesItsOwnCheck) {
  Dice dice(51);
  for (int k = 0; k < 10; ++k) {
    const Skeleton body = testing::with_random_axes(
        testing::in_a_pose(
            testing::with_vertebrae(testing::random_humanoid(dice), GetParam()), 0.6),
        dice);
    const Character character = made(body);
    EXPECT_TRUE(check_character(character));
    EXPECT_TRUE(check_supports(character));
  }
}

INSTANTIATE_TEST_SUITE_P(Vertebrae, EveryCharacter, ::testing::Range(1, 16));

// Rotating the lower joint about the hinge moves the end, relative to the upper joint, in
// the limb's natural direction: elbows forward, knees backward, in the T-pose.
TEST(MakeCharacter, BendsLimbsTheNaturalWayAboutTheirHinges) {
  Dice dice(52);
  const Skeleton body = testing::with_random_axes(
      testing::in_a_pose(testing::with_extra_joints(testing::random_humanoid(dice)), 0.6),
      dice);
  const BodyMap map = mapped(body);
  const Character character = made(body);
  int limbs = 0;
  for (const BodyGroup& group : character.groups) {
    for (const BodyPart& part : group.parts) {
      if (part.kind != PartKind::kLimb) continue;
      ++limbs;
      const JointIndex upper = part.joints[0];
      const glm::dvec3 hinge_in_t_pose =
          character.t_pose_from_joint[index(upper)] * part.hinge_in_upper;
      const bool leg = group.can_support;
      const glm::dvec3 along =
          leg ? glm::dvec3(0, -1, 0)
              : glm::dvec3(group.name == "left arm" ? 1.0 : -1.0, 0, 0);
      const glm::dvec3 bends = glm::cross(hinge_in_t_pose, along);
      EXPECT_LT(glm::distance(bends, glm::dvec3(0, 0, leg ? -1 : 1)), 1e-9);
    }
  }
  EXPECT_EQ(limbs, 4);
}

// Returns the rotation of a joint from the T-pose, as defined by JointLimit.
glm::dvec3 turned(const Character& character, const Pose& pose, const JointLimit& limit) {
  const auto& t_pose = character.t_pose_from_joint;
  const auto parent = character.skeleton[limit.joint].parent;
  return rotation_vector(t_pose[index(*parent)] *
                         pose.parent_from_joint[index(limit.joint)] *
                         glm::conjugate(t_pose[index(limit.joint)]));
}

// An elbow bends 145 degrees and not back by 10, on any rig.
TEST(MakeCharacter, LimitsElbowsAndKneesToTheirHinges) {
  Dice dice(53);
  const Skeleton body = testing::with_random_axes(
      testing::in_a_pose(testing::random_humanoid(dice), 0.6), dice);
  const Character character = made(body);
  const BodyMap map = mapped(body);
  const auto within = [&](const JointLimit& limit, const Pose& pose) {
    const glm::dvec3 v = turned(character, pose, limit);
    return glm::all(glm::lessThanEqual(limit.min_rad, v + 1e-9)) &&
           glm::all(glm::lessThanEqual(v, limit.max_rad + 1e-9));
  };
  int found = 0;
  for (const JointLimit& limit : character.limits) {
    for (const auto& limb : map.limbs) {
      if (!limb || limb->lower != limit.joint) continue;
      ++found;
      const auto bent = [&](double deg) {
        Pose pose = rest_pose(body);
        const auto& t_pose = character.t_pose_from_joint;
        const JointIndex parent = *body[limit.joint].parent;
        pose.parent_from_joint[index(limit.joint)] =
            glm::conjugate(t_pose[index(parent)]) *
            glm::angleAxis(glm::radians(deg), limb->hinge_in_t_pose) *
            t_pose[index(limit.joint)];
        return pose;
      };
      EXPECT_TRUE(within(limit, bent(0.0)));
      EXPECT_TRUE(within(limit, bent(145.0)));
      EXPECT_FALSE(within(limit, bent(160.0)));
      EXPECT_FALSE(within(limit, bent(-10.0)));
    }
  }
  EXPECT_EQ(found, 4);
}

// Walking, jumping, reaching, and every joint to its end (rom): limits do not affect
// captured people. Each axis separately, as adaptation clamps them: tangents of a quarter
// of the angle.
TEST(MakeCharacter, LimitsNothingThatCapturedPeopleDo) {
  for (const char* trial : {"walk", "jump", "reach", "rom"}) {
    const auto motion =
        testing::truth_motion(marey::testing::shared_data().string() + "/blender/dev/" +
                              trial + "/truth/segments.csv");
    if (!motion) GTEST_SKIP() << "the recordings with truth are missing";
    const Character character = made(motion->skeleton);
    double worst_rad = 0.0;
    std::string whose;
    for (const JointLimit& limit : character.limits) {
      for (const Pose& pose : motion->poses) {
        const glm::dvec3 v = turned(character, pose, limit);
        const double angle = glm::length(v);
        if (angle < 1e-9) continue;
        for (const int axis : {0, 1, 2}) {
          const double about = 4.0 * std::atan(std::tan(angle / 4.0) * v[axis] / angle);
          const double over =
              std::max(limit.min_rad[axis] - about, about - limit.max_rad[axis]);
          if (over <= worst_rad) continue;
          worst_rad = over;
          whose = character.skeleton[limit.joint].name + " " + "XYZ"[axis];
        }
      }
    }
    EXPECT_EQ(worst_rad, 0.0) << trial << ": " << whose;
  }
}

TEST(MakeCharacter, SharesTheSpinesRangeOutOverItsVertebrae) {
  const auto maximum = [](int vertebrae) {
    const Skeleton body = testing::with_vertebrae(testing::giant(), vertebrae);
    const Character character = made(body);
    double sum = 0.0;
    for (const JointLimit& limit : character.limits) {
      if (body[limit.joint].name.starts_with("vertebra")) sum += limit.max_rad.x;
    }
    return sum;
  };
  const double whole = spine_range(1).max_rad.x;
  EXPECT_NEAR(maximum(1), whole, 1e-12);
  EXPECT_NEAR(maximum(5), 2.0 * whole, 1e-12);
  EXPECT_NEAR(maximum(15), 2.0 * whole, 1e-12);
}

TEST(MakeCharacter, MirrorsItsLimits) {
  const BoneLimit left = *joint_range(B::kLeftUpperArm);
  const BoneLimit right = *joint_range(B::kRightUpperArm);
  EXPECT_EQ(left.min_rad.x, right.min_rad.x);
  EXPECT_EQ(left.min_rad.y, -right.max_rad.y);
  EXPECT_EQ(left.max_rad.z, -right.min_rad.z);
}

TEST(MakeCharacter, TakesLimitsThatAreItsOwn) {
  CharacterTraits traits;
  traits.limits.push_back({B::kLeftLowerLeg, glm::dvec3(-0.1), glm::dvec3(0.2)});
  const Skeleton body = testing::giant();
  const auto knee = *body.find(B::kLeftLowerLeg);
  const auto knee_of = [&](const Character& character) {
    return std::find_if(character.limits.begin(),
                        character.limits.end(),
                        [&](const JointLimit& limit) { return limit.joint == knee; });
  };
  const Character with = made(body, traits);
  ASSERT_NE(knee_of(with), with.limits.end());
  EXPECT_EQ(knee_of(with)->max_rad.x, 0.2);
  EXPECT_GT(with.limits.size(), 1U);
  traits.has_limits = false;
  EXPECT_EQ(made(body, traits).limits.size(), 1U);
  traits.limits.clear();
  EXPECT_TRUE(made(body, traits).limits.empty());
}

TEST(MakeCharacter, PlacesALoadFromTheTPose) {
  Dice dice(54);
  CharacterTraits traits;
  traits.loads.push_back({"bag", {"leftHand", {0.1, -0.2, 0.05}}, 5.0});
  const Skeleton body = testing::with_random_axes(testing::giant(), dice);
  const Character character = made(body, traits);
  ASSERT_EQ(character.loads.size(), 1U);
  const PointMass& mass = character.loads[0].mass;
  const RigidTransform hand = world_from_joints(body, rest_pose(body))[index(mass.joint)];
  EXPECT_LT(glm::distance(hand * mass.p_in_joint - hand.translation,
                          glm::dvec3(0.1, -0.2, 0.05)),
            1e-9);
}

TEST(MakeCharacter, RefusesALoadOnNoSegment) {
  CharacterTraits traits;
  traits.loads.push_back({"bag", {"leftHant", {}}, 5.0});
  const Skeleton body = testing::giant();
  const auto character = make_character("test", body, mapped(body), traits);
  ASSERT_FALSE(character);
  EXPECT_EQ(character.error().message(),
            "load \"bag\": the skeleton has no segment \"leftHant\". Next: perhaps you "
            "mean \"leftHand\".");
}

}  // namespace
}  // namespace marey::retarget
