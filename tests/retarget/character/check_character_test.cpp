// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/character/check_character.h"

#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "retarget/character/make_character.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/quadruped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Character human() {
  const Skeleton body = testing::giant();
  Result<Character> character = make_character("Ann", body, mapped(body));
  EXPECT_TRUE(character);
  return *std::move(character);
}

// Returns the error for a changed human.
std::string refusal(const std::function<void(Character&)>& change) {
  Character character = human();
  change(character);
  const Status checked = check_character(character);
  return checked ? "" : checked.error().message();
}

BodyGroup& group(Character& character, const std::string& name) {
  for (BodyGroup& group : character.groups) {
    if (group.name == name) return group;
  }
  ADD_FAILURE() << name;
  return character.groups.front();
}

BodyPart& limb(Character& character, const std::string& name) {
  for (BodyPart& part : group(character, name).parts) {
    if (part.kind == PartKind::kLimb) return part;
  }
  ADD_FAILURE() << name;
  return character.groups.front().parts.front();
}

Joint& joint(Character& character, B bone) {
  return character.skeleton.joints[index(*character.skeleton.find(bone))];
}

TEST(CheckCharacter, TakesAHuman) {
  EXPECT_TRUE(check_character(human()));
  EXPECT_TRUE(check_supports(human()));
}

// Nothing here is specific to humans.
TEST(CheckCharacter, TakesAQuadruped) {
  const Character dog = testing::make_quadruped();
  const Status checked = check_character(dog);
  EXPECT_TRUE(checked) << (checked ? "" : checked.error().message());
  EXPECT_TRUE(check_supports(dog));
}

TEST(CheckCharacter, RejectsNonFiniteNumbers) {
  EXPECT_EQ(
      refusal([](Character& c) {
        joint(c, B::kLeftHand).parent_from_joint.translation.y = kNan;
      }),
      "character \"Ann\": joint \"leftHand\": its rest pose is not a place and a unit "
      "quaternion. Next: correct its numbers.");
  EXPECT_NE(refusal([](Character& c) {
              joint(c, B::kHead).parent_from_joint.rotation = {kNan, 0, 0, 0};
            }).find("joint \"head\""),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) { c.t_pose_from_joint[3].x = kNan; }).find("T-pose"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              limb(c, "left arm").hinge_in_upper.x = kNan;
            }).find("group \"left arm\": its hinge"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              c.limits[0].min_rad.y = kNan;
            }).find("about Y they are not within half a turn"),
            std::string::npos);
  EXPECT_NE(
      refusal([](Character& c) { c.masses[2].mass_kg = kNan; }).find("mass of joint"),
      std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              c.masses[2].p_in_joint.z = kNan;
            }).find("its place is not finite"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              c.flexibility.min_trunk_thigh_angle_rad = kNan;
            }).find("flexibility"),
            std::string::npos);
}

TEST(CheckCharacter, RefusesASkeletonThatIsNoTree) {
  EXPECT_NE(refusal([](Character& c) { c.skeleton.joints.clear(); }).find("no joints"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              c.skeleton.joints[4].parent.reset();
            }).find("second root"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              c.skeleton.joints[4].parent = JointIndex{9};
            }).find("its parent does not come before it"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              c.t_pose_from_joint.pop_back();
            }).find("21 rotations for 22 joints"),
            std::string::npos);
}

TEST(CheckCharacter, RefusesALimbWithoutLength) {
  EXPECT_EQ(
      refusal([](Character& c) {
        joint(c, B::kLeftFoot).parent_from_joint.translation = {0, 0, 0};
      }),
      "character \"Ann\": group \"left leg\": its bone from joint \"leftLowerLeg\" to "
      "joint \"leftFoot\" has no length. Next: choose joints at different positions.");
}

// Avatars differ in these bones; adapter_coincident_test.cpp checks that they have no
// effect.
TEST(CheckCharacter, TakesAllOtherBonesWithoutLength) {
  for (const B bone : {B::kLeftShoulder,
                       B::kLeftUpperArm,
                       B::kLeftUpperLeg,
                       B::kNeck,
                       B::kHead,
                       B::kLeftToes}) {
    EXPECT_EQ(refusal([&](Character& c) {
                joint(c, bone).parent_from_joint.translation = {0, 0, 0};
              }),
              "")
        << name(bone);
  }
}

TEST(CheckCharacter, AcceptsASegmentWithoutMass) {
  EXPECT_EQ(refusal([](Character& c) { c.masses.back().mass_kg = 0.0; }), "");
}

// Captured skeletons have vertebrae at the same position, and bend normally.
TEST(CheckCharacter, TakesVertebraeThatCoincide) {
  EXPECT_EQ(refusal([](Character& c) {
              joint(c, B::kUpperChest).parent_from_joint.translation = {0, 0, 0};
            }),
            "");
}

TEST(CheckCharacter, RefusesALimbThatIsNoChain) {
  EXPECT_NE(refusal([](Character& c) {
              std::swap(limb(c, "left leg").joints[0], limb(c, "left leg").joints[1]);
            }).find("is not a descendant of"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              limb(c, "left leg").joints.pop_back();
            }).find("a limb is three joints"),
            std::string::npos);
}

// Twist joints may be within a limb if they are in no group.
TEST(CheckCharacter, TakesTwistJointsWithinALimbThatAreInNoGroup) {
  const Skeleton body = testing::with_extra_joints(testing::giant());
  const auto made = make_character("Ann", body, mapped(body));
  ASSERT_TRUE(made);
  Character character = *made;
  const JointIndex twist = *body.find("twist");
  group(character, "left arm").parts.push_back({PartKind::kSegment, {twist}});
  const Status checked = check_character(character);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message().find("joint \"twist\" lies within the part"),
            std::string::npos);
}

TEST(CheckCharacter, RefusesAHingeThatIsNotAcrossItsBone) {
  EXPECT_NE(refusal([](Character& c) {
              limb(c, "right arm").hinge_in_upper *= 2.0;
            }).find("group \"right arm\": its hinge is not a unit vector"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              limb(c, "right arm").hinge_in_upper = {1, 0, 0};
            })
                .find("group \"right arm\": its hinge is not perpendicular to joint "
                      "\"rightUpperArm\""),
            std::string::npos);
}

TEST(CheckCharacter, RefusesAJointInTwoGroups) {
  EXPECT_EQ(
      refusal([](Character& c) {
        group(c, "trunk").parts.push_back(group(c, "head").parts[1]);
      }),
      "character \"Ann\": group \"trunk\": joint \"neck\" is also in group \"head\". "
      "Next: leave it in one of them.");
  EXPECT_NE(refusal([](Character& c) {
              group(c, "head").parts.push_back(group(c, "head").parts[1]);
            }).find("joint \"neck\" is in two parts"),
            std::string::npos);
  // An elbow is not the end of its limb, before or after it.
  for (const bool before : {false, true}) {
    EXPECT_NE(
        refusal([&](Character& c) {
          BodyGroup& arm = group(c, "left arm");
          const BodyPart elbow{PartKind::kSegment, {*c.skeleton.find(B::kLeftLowerArm)}};
          arm.parts.insert(before ? arm.parts.begin() : arm.parts.end(), elbow);
        }).find("joint \"leftLowerArm\" is in two parts"),
        std::string::npos);
  }
}

TEST(CheckCharacter, RejectsInconsistentGroups) {
  EXPECT_NE(refusal([](Character& c) {
              group(c, "trunk").parent = 2;  // A child of the trunk.
            }).find("form a cycle"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              group(c, "head").level = 2;
            }).find("group \"head\": its level is 2, not 3"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              group(c, "head").parent = 17;
            }).find("its parent is not a group"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) { c.groups.pop_back(); }).find("its parent is no"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) { c.groups.clear(); }).find("there are none"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              BodyGroup first;
              first.name = "first";
              first.level = 1;
              first.parts = {{PartKind::kSegment, {JointIndex{0}}}};
              c.groups.back().parent = 6;
              c.groups.insert(c.groups.begin(), first);
            }).find("group \"first\": it is the root but not the last group"),
            std::string::npos);
}

TEST(CheckCharacter, RefusesGroupsWithoutNamesOrParts) {
  EXPECT_NE(refusal([](Character& c) { c.groups[1].name.clear(); }).find("no name"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              c.groups[1].name = "head";
            }).find("group \"head\": there are two"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) { c.groups[1].parts.clear(); }).find("no parts"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              c.groups[0].parts[0].joints[0] = JointIndex{99};
            }).find("no joint 99"),
            std::string::npos);
}

TEST(CheckCharacter, RefusesLimitsThatNoJointCanKeep) {
  EXPECT_NE(refusal([](Character& c) {
              std::swap(c.limits[0].min_rad.z, c.limits[0].max_rad.z);
            }).find("about Z the minimum is above the maximum"),
            std::string::npos);
  EXPECT_NE(
      refusal([](Character& c) { c.limits.push_back(c.limits[0]); }).find("given twice"),
      std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              c.limits[0].max_rad.x = 4.0;
            }).find("about X they are not within half a turn"),
            std::string::npos);
}

TEST(CheckCharacter, RefusesAFlexibilityThatIsNoAngle) {
  EXPECT_EQ(
      refusal([](Character& c) { c.flexibility.straight_knee_rad = -0.1; }),
      "character \"Ann\": flexibility: its angles are not between 0 and 180 degrees. "
      "Next: correct the angles.");
  EXPECT_NE(refusal([](Character& c) {
              c.flexibility.min_trunk_thigh_angle_rad = 3.2;
            }).find("flexibility"),
            std::string::npos);
}

TEST(CheckCharacter, RefusesMassesThatDoNotWeigh) {
  EXPECT_NE(refusal([](Character& c) {
              c.masses.front().mass_kg = -1.0;
            }).find("mass of joint \"hips\": its mass is negative"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) {
              for (PointMass& mass : c.masses) mass.mass_kg = 0.0;
            }).find("the total mass is 0"),
            std::string::npos);
  EXPECT_NE(refusal([](Character& c) { c.masses.clear(); }).find("total mass is 0"),
            std::string::npos);
}

// Numbers beyond single precision resulted in postures with NaN.
TEST(CheckCharacter, RefusesMassesAndLengthsThatNoBodyHas) {
  const Load bag{"bag", {JointIndex{2}, {0, 0, 0}, 1e6}};
  EXPECT_EQ(refusal([&](Character& c) { c.loads = {bag}; }), "");
  EXPECT_EQ(refusal([&](Character& c) {
              c.loads = {bag};
              c.loads[0].mass.mass_kg = 1e39;
            }),
            "character \"Ann\": load \"bag\": its mass is 1e+39 kg. Next: give it in kg; "
            "1e+06 kg is the maximum.");
  EXPECT_EQ(refusal([&](Character& c) {
              c.loads = {bag};
              c.loads[0].mass.p_in_joint.x = 1e300;
            }),
            "character \"Ann\": load \"bag\": its place is more than 10 km from its "
            "joint. Next: give its place in metres.");
  EXPECT_NE(refusal([](Character& c) {
              c.masses.front().mass_kg = 2e6;
            }).find("mass of joint \"hips\": its mass is 2e+06 kg"),
            std::string::npos);
  EXPECT_EQ(
      refusal([](Character& c) {
        for (Joint& joint : c.skeleton.joints) {
          joint.parent_from_joint.translation *= 1e300;
        }
      }),
      "character \"Ann\": joint \"hips\": it rests more than 10 km from the origin. "
      "Next: give its place in metres.");
}

TEST(CheckCharacter, RefusesLoadsWithoutAUniqueNameOrWithNegativeMass) {
  const Load bag{"bag", {JointIndex{2}, {0, 0, 0}, 5.0}};
  EXPECT_EQ(refusal([&](Character& c) { c.loads = {bag}; }), "");
  EXPECT_NE(refusal([&](Character& c) {
              c.loads = {bag, bag};
            }).find("load \"bag\": there are two of this name"),
            std::string::npos);
  EXPECT_NE(refusal([&](Character& c) {
              c.loads = {bag};
              c.loads[0].name.clear();
            }).find("no name"),
            std::string::npos);
  EXPECT_NE(refusal([&](Character& c) {
              c.loads = {bag};
              c.loads[0].mass.mass_kg = -5.0;
            }).find("load \"bag\": its mass is negative"),
            std::string::npos);
}

TEST(CheckSupports, RefusesABodyThatCannotStand) {
  Character character = human();
  for (BodyGroup& group : character.groups) group.can_support = false;
  EXPECT_TRUE(check_character(character));
  const Status checked = check_supports(character);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().message(),
            "character \"Ann\": groups: none with a limb can support. Next: let the legs "
            "support, or remove the supports.");
}

}  // namespace
}  // namespace marey::retarget
