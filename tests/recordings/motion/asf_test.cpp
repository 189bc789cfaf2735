// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/asf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/motion/bvh.h"
#include "tests/support/files/acclaim.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

// A hip, a thigh whose axes are turned by a quarter about Z, and a shank. A unit is a
// decimetre.
const std::string kAsfSkeleton = R"(# of our own
:version 1.10
:name TINY
:units
  mass 1.0
  length 0.254
  angle deg
:documentation
   root of nothing: free words
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name hip
     direction 1 0 0
     length 2
     axis 0 0 0 XYZ
  end
  begin
     id 2
     name thigh
     direction 0 -3 0
     length 4
     axis 0 0 90 XYZ
    dof rx rz
    limits (-160.0 20.0)
           (-70.0 70.0)
  end
  begin
     id 3
     name shank
     direction 0 -1 0
     length 3
     axis 0 0 0 XYZ
    dof rx
    limits (-10.0 170.0)
  end
:hierarchy
  begin
    root hip
    hip thigh
    thigh shank
  end
)";

std::filesystem::path real_asf(const std::string& name) {
  return marey::testing::shared_data() / "mocap" / name;
}

std::string with(std::string text, const std::string& was, const std::string& is) {
  const auto at = text.find(was);
  EXPECT_NE(at, std::string::npos) << was;
  return at == std::string::npos ? text : text.replace(at, was.size(), is);
}

AsfSkeleton tiny(const std::string& text = kAsfSkeleton) {
  auto read = parse_asf(text, "tiny.asf");
  EXPECT_TRUE(read) << read.error().message();
  return read ? *std::move(read) : AsfSkeleton{};
}

Motion motion_of(const std::string& amc, const std::string& asf = kAsfSkeleton) {
  const auto read = parse_amc(amc, "tiny.amc", tiny(asf));
  EXPECT_TRUE(read) << read.error().message();
  return read ? read->motion : Motion{};
}

std::string asf_refusal(const std::string& asf) {
  const auto read = parse_asf(asf, "tiny.asf");
  return read ? "no refusal" : read.error().message();
}

std::string amc_refusal(const std::string& amc) {
  const auto read = parse_amc(amc, "tiny.amc", tiny());
  return read ? "no refusal" : read.error().message();
}

void expect_close(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(Asf, PutsAJointAtTheNearEndOfEveryBone) {
  const AsfSkeleton read = tiny();
  const auto& joints = read.skeleton.joints;
  ASSERT_EQ(joints.size(), 4U);
  EXPECT_EQ(joints[0].name, "root");
  EXPECT_EQ(joints[2].name, "thigh");
  expect_close(joints[1].parent_from_joint.translation, {0, 0, 0});
  expect_close(joints[2].parent_from_joint.translation, {0.2, 0, 0});
  expect_close(joints[3].parent_from_joint.translation, {0, -0.4, 0});
  ASSERT_TRUE(joints[3].tip_in_joint);
  expect_close(*joints[3].tip_in_joint, {0, -0.3, 0});
  EXPECT_FALSE(joints[2].tip_in_joint);
  // A root without a position is placed with its lowest tip on the floor.
  EXPECT_NEAR(joints[0].parent_from_joint.translation.y, 0.7, 1e-12);
}

// Computed by hand: the thigh's own X is the root's Y, so a thigh that points down does
// not move about it; its Z is the root's. Rotated by 90 degrees about Z it points along
// X, and the shank, bent by 90 about X there, along its parent's former -Z.
TEST(Asf, TurnsBonesAboutTheirOwnAxes) {
  const Motion motion = motion_of(
      "#!OML\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\nthigh 30 0\nshank 0\n"
      "2\nroot 0 0 0 0 0 0\nthigh 0 90\nshank 90\n");
  ASSERT_EQ(motion.poses.size(), 2U);
  expect_close(world_from_joints(motion.skeleton, motion.poses[0])[3].translation,
               {0.2, -0.4, 0.0});
  const auto joints = world_from_joints(motion.skeleton, motion.poses[1]);
  expect_close(joints[3].translation, {0.6, 0.0, 0.0});
  expect_close(joints[3] * *motion.skeleton.joints[3].tip_in_joint, {0.6, 0.0, -0.3});
}

// The root rotates about the fixed axes X, then Y, then Z: (0, 0, 1) goes to (0, -1, 0),
// stays there, and goes to (1, 0, 0). In the reverse order, it stays, goes to (1, 0, 0),
// and stays.
TEST(Asf, TurnsInTheOrderInWhichTheFreedomsAreListed) {
  const Motion xyz = motion_of("1\nroot 0 0 0 90 90 90\nthigh 0 0\nshank 0\n");
  expect_close(xyz.poses[0].parent_from_joint[0] * glm::dvec3(0, 0, 1), {1, 0, 0});
  const Motion zyx =
      motion_of("1\nroot 90 90 90 30 20 10\nthigh 0 0\nshank 0\n",
                with(kAsfSkeleton, "TX TY TZ RX RY RZ", "RZ RY RX TZ TY TX"));
  expect_close(zyx.poses[0].parent_from_joint[0] * glm::dvec3(0, 0, 1), {1, 0, 0});
  expect_close(zyx.poses[0].root_in_world, {1.0, 2.0, 3.0});
}

// Axes rotated about Z first, then X: the bone's own X is the root's Z.
TEST(Asf, KeepsTheOrderOfABonesOwnAxes) {
  const std::string asf = with(kAsfSkeleton, "axis 0 0 90 XYZ", "axis 90 90 0 ZXY");
  const Motion motion = motion_of("1\nroot 0 0 0 0 0 0\nthigh 90 0\nshank 0\n", asf);
  expect_close(motion.poses[0].parent_from_joint[2] * glm::dvec3(1, 0, 0), {0, 1, 0});
}

TEST(Asf, ReadsRadiansIfTheFileDeclaresThem) {
  const std::string asf = with(
      with(kAsfSkeleton, "angle deg", "angle rad"), "0 0 90 XYZ", "0 0 1.5707963267949 ");
  const std::string frame = "1\nroot 0 0 0 0 0 0\nthigh 0 1.5707963267949\nshank 0\n";
  EXPECT_NEAR(glm::angle(motion_of(frame, asf).poses[0].parent_from_joint[2]),
              1.5707963267949,
              1e-12);
  EXPECT_NEAR(glm::angle(motion_of(":RADIANS\n" + frame).poses[0].parent_from_joint[2]),
              1.5707963267949,
              1e-12);
}

TEST(Asf, UsesTheGivenUnit) {
  const auto read = parse_asf(kAsfSkeleton, "tiny.asf", {.unit_m = 0.01});
  ASSERT_TRUE(read);
  expect_close(read->skeleton.joints[2].parent_from_joint.translation, {0.02, 0, 0});
}

TEST(Asf, TakesTheRateFromOptionsThenFileThenDefault) {
  const std::string frame = "7\nroot 0 0 0 0 0 0\nthigh 0 0\nshank 0\n";
  const AsfSkeleton skeleton = tiny();
  const auto usual = parse_amc(frame, "a.amc", skeleton);
  ASSERT_TRUE(usual);
  EXPECT_EQ(usual->motion.rate.hz, 120.0);
  EXPECT_TRUE(usual->rate_is_guessed);
  EXPECT_EQ(usual->motion.first_frame, 6);
  const std::string says = ":SAMPLES-PER-SECOND 60\n" + frame;
  EXPECT_EQ(parse_amc(says, "a.amc", skeleton)->motion.rate.hz, 60.0);
  const auto overridden = parse_amc(says, "a.amc", skeleton, {.rate = FrameRate{30.0}});
  EXPECT_EQ(overridden->motion.rate.hz, 30.0);
  EXPECT_FALSE(overridden->rate_is_guessed);
}

TEST(Asf, MovesTheRootForABoneTranslationAndIgnoresNone) {
  const std::string asf = with(kAsfSkeleton, "dof rx\n", "dof rx ty l\n");
  const auto read =
      parse_amc("1\nroot 0 0 0 0 0 0\nthigh 0 0\nshank 0 0.5 2\n", "a.amc", tiny(asf));
  ASSERT_TRUE(read) << read.error().message();
  // The shank is the first joint that ends: its position is kept by moving the root.
  EXPECT_EQ(read->ignored_translation_m, 0.0);
  expect_close(read->motion.poses[0].root_in_world, {0, 0.05, 0});
}

// An independent reader of the same files gives the same result for every bone.
TEST(Asf, AgreesWithAnotherReaderOnRealTrials) {
  const auto asf = real_asf("cmu_asfamc/02.asf");
  if (!std::filesystem::exists(asf)) GTEST_SKIP() << asf << " is missing";
  const auto skeleton = read_asf(asf);
  ASSERT_TRUE(skeleton) << skeleton.error().message();
  const auto other = testing::parse_asf(*read_file(asf), "02.asf");
  ASSERT_TRUE(other) << other.error().message();
  ASSERT_EQ(skeleton->skeleton.joints.size(), other->bones.size());
  for (const char* trial : {"02_01", "02_03", "02_04", "02_05", "02_06", "02_09"}) {
    const auto amc = real_asf(std::string("cmu_asfamc/") + trial + ".amc");
    EXPECT_EQ(find_skeleton_file(amc), asf);
    const auto read = read_amc(amc, *skeleton);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->ignored_translation_m, 0.0);
    const auto frames = testing::parse_amc(*other, *read_file(amc), trial);
    ASSERT_TRUE(frames) << frames.error().message();
    ASSERT_EQ(read->motion.poses.size(), frames->size());
    double largest_m = 0.0;
    for (std::size_t i = 0; i < frames->size(); ++i) {
      const auto joints = world_from_joints(read->motion.skeleton, read->motion.poses[i]);
      const auto bones = testing::file_from_bones(*other, (*frames)[i]);
      for (std::size_t k = 0; k < bones.size(); ++k) {
        const auto joint = read->motion.skeleton.find(other->bones[k].name);
        ASSERT_TRUE(joint) << other->bones[k].name;
        largest_m = std::max(
            largest_m,
            glm::distance(joints[index(*joint)].translation, bones[k].translation));
      }
    }
    EXPECT_LT(largest_m, 1e-12 * 1e3) << trial;
  }
}

TEST(Asf, ReadsAnAdultOfOrdinaryStature) {
  const auto asf = real_asf("cmu_asfamc/02.asf");
  if (!std::filesystem::exists(asf)) GTEST_SKIP() << asf << " is missing";
  const auto read = read_asf(asf);
  ASSERT_TRUE(read) << read.error().message();
  const auto joints = world_from_joints(read->skeleton, rest_pose(read->skeleton));
  const auto head = read->skeleton.find("head");
  ASSERT_TRUE(head);
  const double stature_m = (joints[index(*head)] * *read->skeleton[*head].tip_in_joint).y;
  EXPECT_GT(stature_m, 1.5);
  EXPECT_LT(stature_m, 2.0);
}

// The same trial from another source: bones of other lengths, and a unit larger by
// 1.0631. The root's path is equal. Shanks and forearms have the same directions, except
// for differences of the skeletons' joints.
TEST(Asf, AgreesWithTheBvhOfTheSameTrial) {
  const auto asf = real_asf("cmu_asfamc/02.asf");
  const auto bvh = real_asf("cmu_bvh_tmoco/02_01.bvh");
  if (!exists(asf) || !exists(bvh)) GTEST_SKIP() << "no mocap data here";
  const auto skeleton = read_asf(asf);
  ASSERT_TRUE(skeleton);
  const auto amc = read_amc(real_asf("cmu_asfamc/02_01.amc"), *skeleton);
  ASSERT_TRUE(amc);
  const auto other = read_bvh(bvh, {.unit_m = skeleton->unit_m / 1.0631});
  ASSERT_TRUE(other);
  const Motion& a = amc->motion;
  const Motion& b = other->motion;
  ASSERT_EQ(a.poses.size(), b.poses.size());
  EXPECT_EQ(a.rate.hz, b.rate.hz);
  using Bone = std::array<const char*, 4>;
  for (const auto& [near_a, far_a, near_b, far_b] :
       {Bone{"ltibia", "lfoot", "LeftLeg", "LeftFoot"},
        Bone{"rtibia", "rfoot", "RightLeg", "RightFoot"},
        Bone{"lradius", "lwrist", "LeftForeArm", "LeftHand"},
        Bone{"rradius", "rwrist", "RightForeArm", "RightHand"}}) {
    double max_rad = 0.0;
    double max_m = 0.0;
    for (std::size_t i = 0; i < a.poses.size(); ++i) {
      const auto in_a = world_from_joints(a.skeleton, a.poses[i]);
      const auto in_b = world_from_joints(b.skeleton, b.poses[i]);
      const auto along =
          [](const Skeleton& body, const auto& joints, auto from, auto to) {
            return glm::normalize(joints[index(body.find(to).value())].translation -
                                  joints[index(body.find(from).value())].translation);
          };
      const double cosine = glm::dot(along(a.skeleton, in_a, near_a, far_a),
                                     along(b.skeleton, in_b, near_b, far_b));
      max_rad = std::max(max_rad, std::acos(std::min(1.0, cosine)));
      max_m = std::max(max_m, glm::distance(in_a[0].translation, in_b[0].translation));
    }
    EXPECT_LT(max_m, 1e-3) << near_a;
    // The other body's rest pose has its legs together, so its hips are elsewhere.
    EXPECT_LT(max_rad, near_a[1] == 't' ? 0.15 : 0.025) << near_a;
  }
}

TEST(Asf, RejectsAnInvalidSkeleton) {
  EXPECT_EQ(asf_refusal("BVH"),
            "tiny.asf:1: expected a section (\":root\"): this is not a .asf file. Next: "
            "export the "
            "file again, or correct that line in a text editor.");
  EXPECT_NE(asf_refusal("").find("the file has no bones"), std::string::npos);
}

TEST(Asf, RefusesABrokenSkeletonWithItsLine) {
  const std::vector<std::array<std::string, 3>> faults{
      {"length 0.254", "length none", "tiny.asf:6: expected a number for length"},
      {"length 0.254", "length -1", "tiny.asf:6: length is not a unit"},
      {"angle deg", "angle gon", "tiny.asf:7: angles are in \"gon\""},
      {"RX RY RZ", "RX RY RQ", "tiny.asf:11: unknown degree of freedom \"rq\""},
      {"0 0 90 XYZ", "0 0 90 XYX", "tiny.asf:28: \"xyx\" is not an order of the axes"},
      {"direction 0 -3 0", "direction 0 nan 0", "tiny.asf:26: expected a number"},
      {"direction 0 -3 0", "direction 0 0 0", "tiny.asf:32: the bone \"thigh\" has no"},
      {"name thigh", "name hip", "tiny.asf:25: the bone \"hip\" is given twice"},
      {"name thigh", "nom thigh", "tiny.asf:32: a bone has no name"},
      {"  end\n  begin\n     id 2", "     id 2", "tiny.asf:23: a bone has two names"},
      {"length 4", "length 1e9", "the bone \"thigh\" is longer than 10 km"},
      {"thigh shank", "shank shank", "the bone \"shank\" is not connected to the root"},
      {"thigh shank", "thigh foot", "tiny.asf:46: no bone \"foot\" can have a parent"},
      {"thigh shank", "thigh shank\nhip shank", "the bone \"shank\" has two parents"},
      {"thigh shank", "thigh root", "no bone \"root\" can have a parent"},
      {":hierarchy", ":skin", "the file ends before its :hierarchy"}};
  for (const auto& [was, is, message] : faults) {
    const std::string said = asf_refusal(with(kAsfSkeleton, was, is));
    EXPECT_NE(said.find(message), std::string::npos) << is << ": " << said;
  }
  EXPECT_NE(asf_refusal(kAsfSkeleton.substr(0, kAsfSkeleton.find("    dof rx")))
                .find("inside a bone"),
            std::string::npos);
}

TEST(Asf, RefusesABrokenMotionWithItsLine) {
  const std::string frame = "1\nroot 0 0 0 0 0 0\nthigh 0 0\nshank 0\n";
  const std::vector<std::pair<std::string, std::string>> faults{
      {"", "the file has no frames"},
      {"HIERARCHY\n", "tiny.amc:1: expected the number of a frame, found \"HIERARCHY\""},
      {"1\nthigh 30\n", "tiny.amc:2: \"thigh\" has 2 degrees of freedom, found 1 values"},
      {"1\nthigh 1 2 3\n", "tiny.amc:2: \"thigh\" has 2 degrees of freedom, found 3"},
      {"1\nthigh 1 nan\n", "tiny.amc:2: \"nan\" is not a number"},
      {"1\nfoot 1\n", "tiny.amc:2: the skeleton has no bone \"foot\""},
      {"1\nshank 1\nshank 1\n", "tiny.amc:3: frame 1 has the bone \"shank\" twice"},
      {"1\nshank 1\nthigh 1 1\n2\n", "frame 1 ends without the bone \"root\""},
      {frame + "3\n", "tiny.amc:5: frame 3 follows frame 1"},
      {"1\nroot 1e9 0 0 0 0 0\n", "tiny.amc:2: a position of \"1e9\" goes further"},
      {"1\nroot 0 0 0 1e30 0 0\n", "tiny.amc:2: a rotation of \"1e30\" is more than"},
      {":samples-per-second 0\n", "tiny.amc:1: a rate must be 0.1 to 2000"}};
  for (const auto& [text, message] : faults) {
    const std::string said = amc_refusal(text);
    EXPECT_NE(said.find(message), std::string::npos) << text << ": " << said;
  }
}

TEST(Asf, FindsTheSkeletonThatGoesWithAMotion) {
  const ScratchFolder folder;
  for (const char* name : {"02.asf", "02_x.ASF", "3.asf"}) {
    ASSERT_TRUE(write_file(folder / name, "x"));
  }
  EXPECT_EQ(find_skeleton_file(folder / "02_01.amc"), folder / "02.asf");
  EXPECT_EQ(find_skeleton_file(folder / "02_x_1.amc"), folder / "02_x.ASF");
  EXPECT_EQ(find_skeleton_file(folder / "3.amc"), folder / "3.asf");
  EXPECT_EQ(find_skeleton_file(folder / "022_01.amc"), std::nullopt);
}

}  // namespace
}  // namespace marey::recordings
