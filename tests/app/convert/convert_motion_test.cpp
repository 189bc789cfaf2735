// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey convert` on motions of skeletons.
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/gltf/gltf.h"
#include "recordings/gltf/vrma.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/mot.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

ProgramRun convert(const fs::path& in,
                   const fs::path& out,
                   const std::vector<std::string>& options = {}) {
  std::vector<std::string> arguments{"convert", in.string(), out.string(), "--json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return run_program(marey::testing::program(), arguments);
}

/// An average body of which every joint turns about an axis of its own, once around.
Motion a_motion() {
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.75));
  motion.rate.hz = 60.0;
  for (int frame = 0; frame <= 60; ++frame) {
    const double part = frame / 60.0;
    Pose pose = rest_pose(motion.skeleton);
    pose.root_in_world += glm::dvec3(part, 0.1 * part, -part);
    for (std::size_t i = 0; i < pose.parent_from_joint.size(); ++i) {
      const auto k = static_cast<double>(i);
      pose.parent_from_joint[i] =
          glm::angleAxis(6.28 * part, glm::normalize(glm::dvec3(1.0, k - 5.0, 0.3 * k)));
    }
    motion.poses.push_back(std::move(pose));
  }
  return motion;
}

/// The largest distance between the places of joints of the same name. [m]
double largest_distance_m(const Motion& a, const Motion& b) {
  double largest = a.poses.size() == b.poses.size() ? 0.0 : 1e9;
  for (std::size_t frame = 0; largest < 1e9 && frame < a.poses.size(); ++frame) {
    const auto in_a = world_from_joints(a.skeleton, a.poses[frame]);
    const auto in_b = world_from_joints(b.skeleton, b.poses[frame]);
    for (std::size_t i = 0; i < in_a.size(); ++i) {
      const auto other = b.skeleton.find(a.skeleton.joints[i].name);
      if (!other) return 1e9;
      largest = std::max(
          largest, glm::distance(in_a[i].translation, in_b[index(*other)].translation));
    }
  }
  return largest;
}

Motion read_vrma(const fs::path& path) {
  const auto read = recordings::read_character(path);
  EXPECT_TRUE(read) << read.error().message();
  return read && read->motion ? *read->motion : Motion{};
}

TEST(ConvertMotion, PutsABvhIntoEveryKindOfFile) {
  const ScratchFolder folder;
  const Motion motion = a_motion();
  ASSERT_TRUE(recordings::write_bvh(folder / "a.bvh", motion));
  for (const char* out : {"b.bvh", "b.vrma", "b.npz", "b.csv", "b.mot"}) {
    const ProgramRun run = convert(folder / "a.bvh", folder / out);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json figures = Json::parse(run.out);
    EXPECT_EQ(figures.at("joints"), 22);
    EXPECT_EQ(figures.at("human_bones"), 22);
    EXPECT_EQ(figures.at("frames"), 61);
    EXPECT_EQ(figures.at("rate_hz"), 60.0);
  }
  EXPECT_LT(largest_distance_m(motion, read_vrma(folder / "b.vrma")), 1e-5);
  EXPECT_EQ(*recordings::read_file(folder / "a.bvh"),
            *recordings::read_file(folder / "b.bvh"));
  EXPECT_EQ(recordings::read_mot(folder / "b.mot")->rows(), 61U);
  EXPECT_TRUE(recordings::read_file(folder / "b.csv")
                  ->starts_with("frame,time,joint,x,y,z\n0,0.000000,hips,"));
}

TEST(ConvertMotion, WritesABvhInTheRequestedDialect) {
  const ScratchFolder folder;
  const Motion motion = a_motion();
  ASSERT_TRUE(recordings::write_vrma(folder / "a.vrma", motion));
  const ProgramRun run =
      convert(folder / "a.vrma", folder / "b.bvh", {"--bvh-dialect", "unity"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string text = *recordings::read_file(folder / "b.bvh");
  EXPECT_NE(text.find("JOINT LeftUpperLeg"), std::string::npos);
  EXPECT_NE(text.find("Yrotation Xrotation Zrotation"), std::string::npos);
  const auto read = recordings::read_bvh(folder / "b.bvh", {.unit_m = 1.0});
  ASSERT_TRUE(read);
  EXPECT_LT(
      glm::distance(read->motion.poses[9].root_in_world, motion.poses[9].root_in_world),
      1e-5);
  const ProgramRun in_mm = convert(
      folder / "a.vrma", folder / "c.bvh", {"--bvh-dialect", "unity", "--to-unit", "mm"});
  ASSERT_EQ(in_mm.exit_code, 0) << in_mm.err;
  const ProgramRun back =
      convert(folder / "c.bvh", folder / "d.bvh", {"--unit", "mm", "--to-unit", "m"});
  ASSERT_EQ(back.exit_code, 0) << back.err;
  const auto again = recordings::read_bvh(folder / "d.bvh", {.unit_m = 1.0});
  EXPECT_LT(
      glm::distance(again->motion.poses[9].root_in_world, motion.poses[9].root_in_world),
      1e-5);
}

TEST(ConvertMotion, ChangesTheRate) {
  const ScratchFolder folder;
  const Motion motion = a_motion();
  ASSERT_TRUE(recordings::write_bvh(folder / "a.bvh", motion));
  const ProgramRun run = convert(folder / "a.bvh", folder / "b.bvh", {"--to-rate", "20"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(Json::parse(run.out).at("frames"), 21);
  const auto read = recordings::read_bvh(folder / "b.bvh");
  ASSERT_TRUE(read);
  EXPECT_LT(
      glm::distance(read->motion.poses[20].root_in_world, motion.poses[60].root_in_world),
      1e-7);
  // Another input rate keeps the frames, and changes the duration.
  const ProgramRun resampled =
      convert(folder / "a.bvh", folder / "c.bvh", {"--rate", "30"});
  ASSERT_EQ(resampled.exit_code, 0) << resampled.err;
  EXPECT_EQ(Json::parse(resampled.out).at("frames"), 61);
  EXPECT_EQ(Json::parse(resampled.out).at("rate_hz"), 30.0);
}

TEST(ConvertMotion, FindsTheSkeletonOfAnAcclaimMotion) {
  const fs::path trial = marey::testing::shared_data() / "mocap/cmu_asfamc/02_01.amc";
  if (!fs::exists(trial)) GTEST_SKIP() << trial << " is missing";
  const ScratchFolder folder;
  const ProgramRun run = convert(trial, folder / "a.bvh");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(Json::parse(run.out).at("joints"), 31);
  EXPECT_EQ(Json::parse(run.out).at("rate_hz"), 120.0);
  EXPECT_NE(run.err.find("120 Hz is assumed"), std::string::npos) << run.err;
  fs::copy_file(trial, folder / "b.amc");
  const ProgramRun alone = convert(folder / "b.amc", folder / "b.bvh");
  EXPECT_EQ(alone.exit_code, 3);
  EXPECT_NE(alone.err.find("--skeleton FILE.asf"), std::string::npos) << alone.err;
  const ProgramRun named =
      convert(folder / "b.amc",
              folder / "b.bvh",
              {"--skeleton", (trial.parent_path() / "02.asf").string(), "--rate", "120"});
  ASSERT_EQ(named.exit_code, 0) << named.err;
  EXPECT_EQ(named.err.find("warning"), std::string::npos) << named.err;
  EXPECT_EQ(*recordings::read_file(folder / "a.bvh"),
            *recordings::read_file(folder / "b.bvh"));
}

// The names of the bones identify them. Joints that do not turn connect the legs to the
// hips, so that the legs are at the file's places.
TEST(ConvertMotion, IdentifiesTheBonesForAVrmaOrADialect) {
  const fs::path trial = marey::testing::shared_data() / "mocap/cmu_asfamc/02_01.amc";
  if (!fs::exists(trial)) GTEST_SKIP() << trial << " is missing";
  const ScratchFolder folder;
  ASSERT_EQ(convert(trial, folder / "a.bvh").exit_code, 0);
  const ProgramRun run = convert(trial, folder / "a.vrma");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto own = recordings::read_bvh(folder / "a.bvh");
  ASSERT_TRUE(own);
  const Motion& truth = own->motion;
  const Motion motion = read_vrma(folder / "a.vrma");
  ASSERT_EQ(motion.poses.size(), truth.poses.size());
  EXPECT_EQ(motion.rate.hz, 120.0);
  for (std::size_t i = 0; i < motion.poses.size(); i += 20) {
    const auto a = world_from_joints(motion.skeleton, motion.poses[i]);
    const auto b = world_from_joints(truth.skeleton, truth.poses[i]);
    for (const auto& [bone, joint] : {std::pair{HumanBone::kHips, "root"},
                                      std::pair{HumanBone::kLeftLowerLeg, "ltibia"},
                                      std::pair{HumanBone::kRightFoot, "rfoot"},
                                      std::pair{HumanBone::kRightToes, "rtoes"}}) {
      EXPECT_LT(glm::distance(a[index(motion.skeleton.find(bone).value())].translation,
                              b[index(truth.skeleton.find(joint).value())].translation),
                1e-4)
          << joint;
    }
  }
  ASSERT_EQ(convert(trial, folder / "b.bvh", {"--bvh-dialect", "mobu"}).exit_code, 0);
  const std::string text = *recordings::read_file(folder / "b.bvh");
  EXPECT_NE(text.find("JOINT LeftUpLeg\n"), std::string::npos);
  EXPECT_EQ(text.find("lfemur"), std::string::npos);
}

TEST(ConvertMotion, RejectsIncompatibleOptions) {
  const ScratchFolder folder;
  ASSERT_TRUE(recordings::write_bvh(folder / "a.bvh", a_motion()));
  ASSERT_TRUE(recordings::write_vrma(folder / "a.vrma", a_motion()));
  struct Case {
    std::string in, out;
    std::vector<std::string> options;
    std::string says;
  };
  const std::vector<Case> cases{
      {"a.bvh", "b.glb", {}, "name the result .bvh, .vrma, .npz, .csv or .mot"},
      {"a.bvh", "b.c3d", {}, "cannot write a motion as \".c3d\""},
      {"a.bvh",
       "b.npz",
       {"--bvh-dialect", "maya"},
       "only a .bvh is written in a dialect"},
      {"a.bvh", "b.bvh", {"--up", "+Z"}, "motions of skeletons are always Y up"},
      {"a.vrma", "b.bvh", {"--unit", "m"}, "glTF is always in metres"},
      {"a.c3d", "b.c3d", {"--to-rate", "30"}, "are for motions alone"},
      {"none.bvh", "b.bvh", {}, "none.bvh"}};
  for (const auto& [in, out, options, says] : cases) {
    const ProgramRun run = convert(folder / in, folder / out, options);
    EXPECT_EQ(run.exit_code, 3) << in << " " << out;
    EXPECT_NE(run.err.find(says), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder / out));
  }
  EXPECT_EQ(convert(folder / "a.bvh", folder / "b.bvh", {"--bvh-dialect", "x"}).exit_code,
            2);
}

TEST(ConvertMotion, NeverOverwritesItsInput) {
  const ScratchFolder folder;
  ASSERT_TRUE(recordings::write_bvh(folder / "a.bvh", a_motion()));
  const auto before = recordings::read_file(folder / "a.bvh");
  const ProgramRun run =
      convert(folder / "a.bvh", folder / "." / "a.bvh", {"--to-rate", "5"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("input and output are the same file"), std::string::npos)
      << run.err;
  EXPECT_EQ(*recordings::read_file(folder / "a.bvh"), *before);
}

}  // namespace
}  // namespace marey::testing
