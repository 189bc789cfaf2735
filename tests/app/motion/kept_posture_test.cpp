// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies from elsewhere keep the posture of captured motions in the written files. The
// test compares places of joints that it names itself.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/live_chain/live_avatar.h"
#include "app/motion/motion_files.h"
#include "app/motion/neutral.h"
#include "app/motion/read_body.h"
#include "app/motion/retarget_files.h"
#include "core/base/degrees.h"
#include "core/pose.h"
#include "live/vmc/vmc_body.h"
#include "live/vmc/vmc_pose.h"
#include "recordings/gltf/gltf.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/npz.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/truth/segment_directions.h"

namespace marey::app {
namespace {

using B = HumanBone;
using testing::BoneJoints;
using testing::ScratchFolder;

std::filesystem::path shared(const std::string& name) {
  return marey::testing::shared_data() / name;
}

/// The names of a body's joints, as this test read them in its file.
struct Names {
  const char* hips;
  const char* neck;
  const char* head;
  const char* thigh;
  const char* shank;
  const char* foot;
  const char* toes;
  const char* arm;
  const char* forearm;
  const char* hand;
  const char* left;
  const char* right;
};

BoneJoints joints_of(const Skeleton& skeleton, const Names& n) {
  return testing::named_joints(skeleton,
                               {n.left, n.right},
                               {{B::kHips, n.hips},
                                {B::kNeck, n.neck},
                                {B::kHead, n.head},
                                {B::kLeftUpperLeg, n.thigh},
                                {B::kLeftLowerLeg, n.shank},
                                {B::kLeftFoot, n.foot},
                                {B::kLeftToes, n.toes},
                                {B::kLeftUpperArm, n.arm},
                                {B::kLeftLowerArm, n.forearm},
                                {B::kLeftHand, n.hand}});
}

constexpr Names kBandai{"Hips",
                        "Neck",
                        "Head",
                        "UpperLeg_{}",
                        "LowerLeg_{}",
                        "Foot_{}",
                        "Toes_{}",
                        "UpperArm_{}",
                        "LowerArm_{}",
                        "Hand_{}",
                        "L",
                        "R"};
constexpr Names kMixamo{"mixamorig:Hips",
                        "mixamorig:Neck",
                        "mixamorig:Head",
                        "mixamorig:{}UpLeg",
                        "mixamorig:{}Leg",
                        "mixamorig:{}Foot",
                        "mixamorig:{}ToeBase",
                        "mixamorig:{}Arm",
                        "mixamorig:{}ForeArm",
                        "mixamorig:{}Hand",
                        "Left",
                        "Right"};
constexpr Names kQuaternius{"Hips",
                            "Neck",
                            "Head",
                            "UpperLeg.{}",
                            "LowerLeg.{}",
                            "Foot.{}",
                            "Foot.{}_end",
                            "UpperArm.{}",
                            "LowerArm.{}",
                            "Palm.{}",
                            "L",
                            "R"};
constexpr Names kRigify{"DEF-spine",
                        "DEF-spine.004",
                        "DEF-spine.006",
                        "DEF-thigh.{}",
                        "DEF-shin.{}",
                        "DEF-foot.{}",
                        "DEF-toe.{}",
                        "DEF-upper_arm.{}",
                        "DEF-forearm.{}",
                        "DEF-hand.{}",
                        "L",
                        "R"};
constexpr Names kMannequiny{"pelvis",
                            "neck_01",
                            "head",
                            "thigh.{}",
                            "calf.{}",
                            "foot.{}",
                            "ball.{}",
                            "upperarm.{}",
                            "lowerarm.{}",
                            "hand.{}",
                            "l",
                            "r"};
constexpr Names kVoxels{"Hips",
                        "Neck",
                        "Head",
                        "{} leg",
                        "{} knee",
                        "{} ankle",
                        "{} toe",
                        "{} arm",
                        "{} elbow",
                        "{} wrist",
                        "Left",
                        "Right"};

struct Body {
  const char* file;
  Names names;
  /// Largest mean error of limbs: they keep feet where these stand and arms out
  /// of the body, on a body of proportions that ask for it. [degrees]
  double limbs_off = 8.0;
  /// The same of feet, whose yaw is measured to where their joint ends. [degrees]
  double feet_off = 8.0;
};

const std::array kBodies{
    Body{"avatars/makehuman/adult_male_mixamo_unity.glb", kMixamo},
    Body{"avatars/vrm/cryptovoxels.vrm", kVoxels},
    // A skirt, and shanks half as long again as the thighs. The right foot's joint does
    // not point along the shoe.
    Body{"avatars/hard/f_female_dress.glb", kQuaternius, 12.0, 11.0},
    // Legs of half a metre that begin a metre apart, below a trunk as broad.
    Body{"avatars/hard/q_humanoid.glb", kQuaternius, 45.0},
    Body{"avatars/hard/rigify_def.glb", kRigify},
    // Arms kept out of a broad trunk.
    Body{"avatars/hard/mannequiny.glb", kMannequiny, 10.0},
};

class EveryBody : public ::testing::TestWithParam<Body> {};

Names with_hands_of(const Body& body) {
  Names names = body.names;
  if (std::string(body.file).ends_with("q_humanoid.glb")) names.hand = "Fist.{}";
  return names;
}

/// The mean angles between segments, at most.
void expect_kept(const Motion& source,
                 const BoneJoints& source_joints,
                 const Motion& result,
                 const BoneJoints& result_joints,
                 const Body& body) {
  const auto errors =
      testing::compare_directions(source, source_joints, result, result_joints);
  for (std::size_t i = 0; i < testing::kSegmentCount; ++i) {
    const auto segment = static_cast<testing::Segment>(i);
    const bool is_foot = segment >= testing::Segment::kLeftFoot;
    if (is_foot && !result_joints[index(B::kLeftToes)]) continue;
    ASSERT_TRUE(errors.mean_rad[i]) << testing::name(segment);
    const double max_deg = i < 2 ? 8.0 : is_foot ? body.feet_off : body.limbs_off;
    EXPECT_LT(*errors.mean_rad[i] / kRadiansPerDegree, max_deg) << testing::name(segment);
  }
}

TEST_P(EveryBody, KeepsThePostureOfAWalkAKickAndADance) {
  const Body& body = GetParam();
  for (const char* clip : {"walk", "kick", "dance-short"}) {
    const auto source_file =
        shared("mocap/bandai/dataset-1_" + std::string(clip) + "_normal_001.bvh");
    if (!std::filesystem::exists(source_file) ||
        !std::filesystem::exists(shared(body.file))) {
      GTEST_SKIP() << "the files are missing";
    }
    SCOPED_TRACE(clip);
    const ScratchFolder folder;
    const auto source = read_motion(source_file);
    ASSERT_TRUE(source) << source.error().message();
    const auto made =
        retarget_to_files(source->motion, shared(body.file), folder / "out");
    ASSERT_TRUE(made) << made.error().message();
    EXPECT_EQ(made->files.size(), 3U);
    const Motion& result = made->retargeted.motion;
    expect_kept(source->motion,
                joints_of(source->motion.skeleton, kBandai),
                result,
                joints_of(result.skeleton, with_hands_of(body)),
                body);
    // Hips travel as far as legs are long, and hang where the legs begin.
    const auto hips = result.skeleton.find(B::kHips);
    ASSERT_TRUE(hips);
    const auto world = world_from_joints(result.skeleton, rest_pose(result.skeleton));
    const double leg =
        glm::distance(world[index(*result.skeleton.find(B::kLeftUpperLeg))].translation,
                      world[index(*result.skeleton.find(B::kLeftFoot))].translation);
    EXPECT_GT(world[index(*hips)].translation.y, 0.7 * leg);
    // Feet go with their shins.
    for (const B foot : {B::kLeftFoot, B::kRightFoot}) {
      const B shin = foot == B::kLeftFoot ? B::kLeftLowerLeg : B::kRightLowerLeg;
      auto above = result.skeleton[*result.skeleton.find(foot)].parent;
      while (above && above != result.skeleton.find(shin)) {
        above = result.skeleton[*above].parent;
      }
      EXPECT_TRUE(above) << name(foot);
    }
  }
}

/// Returns the direction that a body faces: at rest by its thighs, in a pose by the turn
/// of its hips' joint. A pose has only turns in files whose thighs are not children of
/// the hips.
glm::dvec3 facing(const Skeleton& skeleton, const BoneJoints& joints, const Pose& pose) {
  const std::size_t hips = index(*joints[index(B::kHips)]);
  const Pose rest = rest_pose(skeleton);
  const glm::dquat turned =
      world_from_joints(skeleton, pose)[hips].rotation *
      glm::conjugate(world_from_joints(skeleton, rest)[hips].rotation);
  const glm::dvec3 front = turned * testing::facing_of(skeleton, joints, rest);
  return glm::normalize(glm::dvec3(front.x, 0.0, front.z));
}

/// Returns the direction that a receiver's avatar faces, in marey's axes. Its T-pose
/// faces +Z.
glm::dvec3 vmc_facing(const live::VmcBody& body, const Pose& pose) {
  live::VmcPose sent;
  body.to_vmc(pose, sent);
  EXPECT_TRUE(sent.contains(live::UnityBone::kHips));
  const glm::dquat hips =
      sent.root.rotation * sent.local[live::index(live::UnityBone::kHips)].rotation;
  const glm::dvec3 front = live::mirrored_x(hips * glm::dvec3(0, 0, 1));
  return glm::normalize(glm::dvec3(front.x, 0.0, front.z));
}

// One clip, one heading: whatever the body's file, and in every kind of file.
TEST_P(EveryBody, FacesTheSameWayInEveryFile) {
  const Body& body = GetParam();
  const auto source_file = shared("mocap/bandai/dataset-1_walk_normal_001.bvh");
  if (!std::filesystem::exists(source_file) ||
      !std::filesystem::exists(shared(body.file))) {
    GTEST_SKIP() << "the files are missing";
  }
  const ScratchFolder folder;
  const auto source = read_motion(source_file);
  ASSERT_TRUE(source) << source.error().message();
  const auto made = retarget_to_files(source->motion, shared(body.file), folder / "out");
  ASSERT_TRUE(made) << made.error().message();
  const Motion& solved = made->retargeted.motion;
  ASSERT_TRUE(write_motion_file(folder / "out.npz", MotionFormat::kNpz, solved, {}));
  const auto npz = recordings::read_npz(folder / "out.npz");
  ASSERT_TRUE(npz) << npz.error().message();
  const auto opened = open_avatar(shared(body.file));
  ASSERT_TRUE(opened);
  const auto vmc = make_vmc_body(solved.skeleton, &*opened, live::VmcRest::kVrm0);
  ASSERT_TRUE(vmc) << vmc.error().message();
  auto glb = recordings::read_character(folder / "out.glb");
  ASSERT_TRUE(glb && glb->motion);
  // Undoes the reader's turn of a VRM 0.x: the test uses the directions in the file.
  const glm::dquat as_in_file =
      glb->faces_back ? glm::dquat(0.0, 0.0, 1.0, 0.0) : glm::dquat(1.0, 0.0, 0.0, 0.0);
  const auto bvh = recordings::read_bvh(folder / "out.bvh");
  ASSERT_TRUE(bvh);
  const auto vrma = recordings::read_character(folder / "out.vrma");
  ASSERT_TRUE(vrma && vrma->motion);
  Names names = with_hands_of(body);
  const auto source_joints = joints_of(source->motion.skeleton, kBandai);
  const auto glb_joints = joints_of(glb->skeleton, names);
  std::string thigh = names.thigh;  // A .bvh has no blanks in names.
  std::ranges::replace(thigh, ' ', '_');
  names.thigh = thigh.c_str();
  const auto bvh_joints = joints_of(bvh->motion.skeleton, names);
  const auto vrma_joints = testing::marked_joints(vrma->skeleton);
  const std::size_t last = source->motion.poses.size() - 1;
  for (const std::size_t frame : {std::size_t{0}, last / 2, last}) {
    const glm::dvec3 truth =
        facing(source->motion.skeleton, source_joints, source->motion.poses[frame]);
    const auto expect_same = [&](const glm::dvec3& front, const char* what) {
      EXPECT_GT(glm::dot(front, truth), std::cos(3.0 * kRadiansPerDegree)) << what;
    };
    expect_same(as_in_file * facing(glb->skeleton, glb_joints, glb->motion->poses[frame]),
                "glb");
    expect_same(facing(bvh->motion.skeleton, bvh_joints, bvh->motion.poses[frame]),
                "bvh");
    expect_same(facing(vrma->skeleton, vrma_joints, vrma->motion->poses[frame]), "vrma");
    expect_same(facing(npz->motion.skeleton,
                       testing::marked_joints(npz->motion.skeleton),
                       npz->motion.poses[frame]),
                "npz");
    expect_same(vmc_facing(*vmc, solved.poses[frame]), "VMC");
  }
  // At rest, too.
  for (const glm::dvec3& front :
       {as_in_file *
            testing::facing_of(glb->skeleton, glb_joints, rest_pose(glb->skeleton)),
        testing::facing_of(
            bvh->motion.skeleton, bvh_joints, rest_pose(bvh->motion.skeleton))}) {
    EXPECT_GT(front.z, 0.999);
  }
}

INSTANTIATE_TEST_SUITE_P(
    KeptPosture, EveryBody, ::testing::ValuesIn(kBodies), [](const auto& case_info) {
      std::string text = case_info.param.file;
      std::erase_if(text, [](char c) { return std::isalnum(c) == 0; });
      return text;
    });

}  // namespace
}  // namespace marey::app
