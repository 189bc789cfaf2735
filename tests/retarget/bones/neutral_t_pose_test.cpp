// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/neutral_t_pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/base/degrees.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/bones/body_frame.h"
#include "retarget/bones/identify_bones.h"
#include "retarget/bones/set_rest_pose.h"
#include "retarget/bones/up_of_motion.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/truth/segment_directions.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

const glm::dvec3 kX(1, 0, 0);
const glm::dvec3 kY(0, 1, 0);
const glm::dvec3 kZ(0, 0, 1);

/// Axes of a rig whose bones lie along their own X, as in studios' files: each joint's
/// world rotation in the T-pose.
glm::dquat along_x(B bone) {
  const auto frame = [](const glm::dvec3& x, const glm::dvec3& y) {
    return glm::normalize(glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y))));
  };
  switch (bone) {
    case B::kHips:
      return frame(kY, -kX);
    case B::kLeftShoulder:
    case B::kLeftUpperArm:
    case B::kLeftLowerArm:
    case B::kLeftHand:
      return frame(kX, kY);
    case B::kRightShoulder:
    case B::kRightUpperArm:
    case B::kRightLowerArm:
    case B::kRightHand:
      return frame(-kX, kZ);
    case B::kLeftUpperLeg:
    case B::kLeftLowerLeg:
      return frame(-kY, kX);
    case B::kRightUpperLeg:
    case B::kRightLowerLeg:
      return frame(-kY, kZ);
    case B::kLeftFoot:
    case B::kLeftToes:
    case B::kRightFoot:
    case B::kRightToes:
      return frame(kZ, kX);
    default:
      return frame(kY, kZ);
  }
}

/// A T-pose body in other axes, and the joints' frames in that T-pose.
struct Rig {
  Skeleton t_pose;  ///< Rests in the T-pose, axes along the bones.
  Skeleton heap;    ///< The same bones without rest rotations.
  FoundBones found;
};

Rig make_rig() {
  const Skeleton plain = make_humanoid(average_proportions(1.7));
  const auto world = world_from_joints(plain, rest_pose(plain));
  Rig rig{plain, plain, {}};
  std::vector<RigidTransform> own;
  for (std::size_t i = 0; i < plain.joints.size(); ++i) {
    own.push_back({along_x(*plain.joints[i].bone), world[i].translation});
    Joint& joint = rig.t_pose.joints[i];
    joint.parent_from_joint =
        joint.parent ? inverse(own[index(*joint.parent)]) * own[i] : own[i];
    if (joint.tip_in_joint) {
      joint.tip_in_joint = glm::conjugate(own[i].rotation) * *joint.tip_in_joint;
    }
    rig.heap.joints[i] = joint;
    rig.heap.joints[i].parent_from_joint.rotation = {1.0, 0.0, 0.0, 0.0};
    rig.found.bones[index(*joint.bone)] = FoundBone{JointIndex{static_cast<int>(i)}};
  }
  return rig;
}

/// A walk of some style: rotations of the T-pose, in the world's axes, relative to
/// parents.
Motion walk(const Rig& rig, double lean_rad, double bend_rad, double turn_rad) {
  Motion motion{rig.heap, FrameRate{30.0}, 0, {}};
  for (int frame = 0; frame < 40; ++frame) {
    const double swing = std::sin(0.4 * frame);
    std::vector<glm::dquat> turned(kHumanBoneCount, glm::dquat(1, 0, 0, 0));
    const auto about = [](double angle, const glm::dvec3& axis) {
      return glm::angleAxis(angle, axis);
    };
    const glm::dquat hips = about(turn_rad, kY) * about(0.3 * lean_rad, kX);
    for (const B bone : human_bones()) turned[index(bone)] = hips;
    const glm::dquat trunk =
        about(turn_rad, kY) * about(lean_rad, kX) * about(0.1 * swing, kY);
    for (const B bone : {B::kSpine,
                         B::kChest,
                         B::kUpperChest,
                         B::kNeck,
                         B::kHead,
                         B::kLeftShoulder,
                         B::kRightShoulder}) {
      turned[index(bone)] = trunk;
    }
    for (const bool left : {true, false}) {
      const auto side = [&](B bone) { return index(left ? bone : mirrored(bone)); };
      const double s = left ? 1.0 : -1.0;
      const double phase = s * swing;
      const glm::dquat arm = trunk * about(-s * 1.2, kZ) * about(0.4 * phase, kY);
      turned[side(B::kLeftUpperArm)] = arm;
      turned[side(B::kLeftLowerArm)] = turned[side(B::kLeftHand)] =
          arm * about(-s * (bend_rad + 0.1 * phase), kY);
      const glm::dquat thigh = hips * about(-0.5 * phase, kX);
      const glm::dquat shank = thigh * about(bend_rad * (1.0 + phase), kX);
      turned[side(B::kLeftUpperLeg)] = thigh;
      turned[side(B::kLeftLowerLeg)] = shank;
      turned[side(B::kLeftFoot)] = turned[side(B::kLeftToes)] =
          shank * about(-bend_rad, kX);
    }
    std::vector<glm::dquat> world;
    for (const Joint& joint : rig.heap.joints) {
      world.push_back(turned[index(*joint.bone)] * along_x(*joint.bone));
    }
    motion.poses.push_back(pose_from_world(rig.heap, {0.0, 0.9, 0.03 * frame}, world));
  }
  return motion;
}

TEST(RestAsTPose, FindsTheTPoseOfBonesThatLieAlongTheirOwnAxes) {
  const Rig rig = make_rig();
  for (const double lean : {0.0, 0.35, -0.2}) {
    for (const double turn : {0.0, 1.5, 3.0}) {
      Motion motion = walk(rig, lean, 0.5, turn);
      ASSERT_FALSE(stands_at_rest(motion.skeleton, rig.found));
      set_rest_t_pose(motion, rig.found, up_of_motion(motion, rig.found).axis);
      const auto now = world_from_joints(motion.skeleton, rest_pose(motion.skeleton));
      for (const B bone : human_bones()) {
        const glm::dquat off = glm::conjugate(along_x(bone)) * now[index(bone)].rotation;
        const bool is_foot = bone == B::kLeftFoot || bone == B::kRightFoot;
        // The slope of a foot's bone is an average one's, which this body has.
        EXPECT_LT(glm::length(rotation_vector(off)),
                  (is_foot ? 1.0 : 1e-4) * kRadiansPerDegree)
            << name(bone) << " lean " << lean << " turn " << turn;
      }
    }
  }
}

// The rest depends on the skeleton alone: motions of it get the same, to the bit.
TEST(RestAsTPose, IsTheSameForAllMotionsOfASkeleton) {
  const Rig rig = make_rig();
  Motion upright = walk(rig, 0.0, 0.4, 0.0);
  Motion old_man = walk(rig, 0.35, 0.8, 0.5);
  Motion both = upright;
  for (int i = 0; i < 6; ++i) {
    both.poses.insert(both.poses.end(), old_man.poses.begin(), old_man.poses.end());
  }
  set_rest_t_pose(upright, rig.found, up_of_motion(upright, rig.found).axis);
  for (Motion* motion : {&old_man, &both}) {
    set_rest_t_pose(*motion, rig.found, up_of_motion(*motion, rig.found).axis);
    for (std::size_t i = 0; i < rig.heap.joints.size(); ++i) {
      EXPECT_EQ(motion->skeleton.joints[i].parent_from_joint.rotation,
                upright.skeleton.joints[i].parent_from_joint.rotation);
      EXPECT_EQ(motion->skeleton.joints[i].parent_from_joint.translation,
                upright.skeleton.joints[i].parent_from_joint.translation);
    }
  }
}

/// The walk, in which the first `lying` frames lie on their backs on the floor.
Motion walk_after_sleep(const Rig& rig, std::size_t lying) {
  Motion motion = walk(rig, 0.0, 0.4, 0.0);
  const glm::dquat down = glm::angleAxis(-90.0 * kRadiansPerDegree, glm::dvec3(1, 0, 0));
  for (std::size_t f = 0; f < std::min(lying, motion.poses.size()); ++f) {
    Pose& pose = motion.poses[f];
    pose.parent_from_joint[0] = down * pose.parent_from_joint[0];
    pose.root_in_world.y = 0.1;
  }
  return motion;
}

// A body that lies for most of a clip must not change the up axis.
TEST(UpOfMotion, IsTheUsualOneWhereABodyLiesMostOfTheTime) {
  const Rig rig = make_rig();
  const std::size_t count = walk(rig, 0.0, 0.4, 0.0).poses.size();
  Motion upright = walk(rig, 0.0, 0.4, 0.0);
  set_rest_t_pose(upright, rig.found, up_of_motion(upright, rig.found).axis);
  for (const std::size_t percent : {0U, 30U, 50U, 60U, 85U}) {
    Motion motion = walk_after_sleep(rig, percent * count / 100);
    const MotionUp up = up_of_motion(motion, rig.found);
    EXPECT_EQ(up.axis, glm::dvec3(0, 1, 0)) << percent;
    EXPECT_NEAR(up.share, 1.0 - 0.01 * static_cast<double>(percent), 0.03) << percent;
    set_rest_t_pose(motion, rig.found, up.axis);
    EXPECT_EQ(motion.skeleton.joints[0].parent_from_joint.rotation,
              upright.skeleton.joints[0].parent_from_joint.rotation)
        << percent;
  }
  EXPECT_NE(up_of_motion(walk_after_sleep(rig, count), rig.found).axis,
            glm::dvec3(0, 1, 0))
      << "it cannot be distinguished from a file with Z up; a remark states the choice";
}

// An old man's walk leans forward, on another body too.
TEST(RestAsTPose, KeepsTheLeanOfAWalk) {
  const Rig rig = make_rig();
  Motion motion = walk(rig, 20.0 * kRadiansPerDegree, 0.5, 0.0);
  set_rest_t_pose(motion, rig.found, up_of_motion(motion, rig.found).axis);
  mark(rig.found, motion.skeleton);
  for (const Skeleton& avatar : {testing::child(), testing::giant()}) {
    RetargetOptions options;
    const auto made = retarget_motion(motion, avatar, options);
    ASSERT_TRUE(made) << made.error().message();
    const auto errors =
        testing::compare_directions(motion,
                                    testing::marked_joints(motion.skeleton),
                                    made->motion,
                                    testing::marked_joints(avatar));
    const auto [worst, segment] = errors.worst_mean();
    EXPECT_LT(worst, 8.0 * kRadiansPerDegree) << testing::name(segment);
    EXPECT_LT(*errors.mean_rad[0], 3.0 * kRadiansPerDegree);
  }
}

TEST(RestAsTPose, KnowsSkeletonsByTheirJoints) {
  Skeleton skeleton;
  for (const char* joint :
       {"joint_Root", "UpperArm_L", "LowerArm_L", "UpperLeg_L", "LowerLeg_L", "Toes_L"}) {
    EXPECT_EQ(named_neutral(skeleton), nullptr);
    skeleton.joints.emplace_back();
    skeleton.joints.back().name = joint;
  }
  ASSERT_NE(named_neutral(skeleton), nullptr);
  EXPECT_EQ(named_neutral(skeleton)->name, "bandai");
  EXPECT_EQ(named_neutral("bandai"), named_neutral(skeleton));
  EXPECT_EQ(named_neutral("nobody"), nullptr);
}

TEST(SetRestPose, TakesAFrameAndFacesAlongAnAxis) {
  const Rig rig = make_rig();
  Motion motion = walk(rig, 0.0, 0.5, 1.1);
  const Pose pose = motion.poses[7];
  set_rest_pose(motion, rig.found, {0, 1, 0}, pose);
  ASSERT_TRUE(stands_at_rest(motion.skeleton, rig.found));
  const auto joints = testing::marked_joints(rig.t_pose);
  const glm::dvec3 front =
      testing::facing_of(motion.skeleton, joints, rest_pose(motion.skeleton));
  EXPECT_GT(front.z, 1.0 - 1e-9);
  const auto now =
      testing::directions_of(motion.skeleton, joints, rest_pose(motion.skeleton));
  const auto then = testing::directions_of(motion.skeleton, joints, pose);
  for (std::size_t i = 0; i < testing::kSegmentCount; ++i) {
    if (!then[i]) continue;  // A steep foot.
    ASSERT_TRUE(now[i]);
    EXPECT_NEAR(now[i]->y, then[i]->y, 1e-9);
  }
}

TEST(CopyRestPose, DeclinesAnotherSkeletonNamingTheJoint) {
  const Rig rig = make_rig();
  Motion motion = walk(rig, 0.0, 0.5, 0.0);
  Skeleton other = rig.t_pose;
  EXPECT_TRUE(copy_rest_pose(other, rig.found, {0, 1, 0}, motion));
  EXPECT_TRUE(stands_at_rest(motion.skeleton, rig.found));
  other.joints[index(B::kLeftLowerLeg)].name = "knee";
  const Status no = copy_rest_pose(other, rig.found, {0, 1, 0}, motion);
  ASSERT_FALSE(no);
  EXPECT_EQ(no.error().cause,
            "it has no joint 'leftLowerLeg', which is the motion's leftLowerLeg");
  const Skeleton turned = make_humanoid(average_proportions(1.7));
  const Status also = copy_rest_pose(turned, rig.found, {0, 1, 0}, motion);
  ASSERT_FALSE(also);
  EXPECT_NE(also.error().cause.find("has another direction in its joint's axes"),
            std::string::npos);
}

}  // namespace
}  // namespace marey::retarget
