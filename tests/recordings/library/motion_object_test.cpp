// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/motion_object.h"

#include <cmath>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "recordings/base/atomic_file.h"
#include "recordings/motion/npz.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::run_program;
using testing::ScratchFolder;

/// A person of 22 joints who moves at random, within 10 m.
LibraryMotion random_motion(int frames, bool has_uncertainty) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  LibraryMotion out;
  out.motion.skeleton = make_humanoid(average_proportions(1.75));
  out.motion.rate = FrameRate{29.97};
  out.motion.first_frame = 120;
  const std::size_t joints = out.motion.skeleton.joints.size();
  for (int f = 0; f < frames; ++f) {
    Pose pose;
    pose.root_in_world = {9.0 * part(random), 1.0, 3.0 * part(random)};
    for (std::size_t j = 0; j < joints; ++j) {
      pose.parent_from_joint.push_back(glm::normalize(
          glm::dquat(part(random) + 1.5, part(random), part(random), part(random))));
    }
    out.motion.poses.push_back(pose);
    out.contacts.push_back({1, 0, static_cast<std::uint8_t>(f % 2), 0});
    if (!has_uncertainty) continue;
    auto& frame = out.uncertainty.emplace_back(joints);
    for (std::size_t j = 0; j < joints; ++j) {
      frame[j].sigma_m = 0.25 * static_cast<double>(j % 3);
      frame[j].source = static_cast<Source>(j % 3);
    }
  }
  return out;
}

/// Largest distance of a joint between two motions of the same skeleton. [m]
double largest_distance_m(const Motion& a, const Motion& b) {
  double largest = 0.0;
  std::vector<RigidTransform> of_a(a.skeleton.joints.size());
  std::vector<RigidTransform> of_b(b.skeleton.joints.size());
  for (std::size_t f = 0; f < a.poses.size(); ++f) {
    world_from_joints(a.skeleton, a.poses[f], of_a);
    world_from_joints(b.skeleton, b.poses[f], of_b);
    for (std::size_t j = 0; j < of_a.size(); ++j) {
      largest =
          std::max(largest, glm::distance(of_a[j].translation, of_b[j].translation));
    }
  }
  return largest;
}

TEST(MotionObject, IsReadBackWithinAHundredthOfAMillimetre) {
  for (const bool has_uncertainty : {false, true}) {
    const LibraryMotion motion = random_motion(40, has_uncertainty);
    const auto bytes = motion_object_bytes(motion);
    ASSERT_TRUE(bytes) << bytes.error().message();
    const auto read = parse_motion_object(*bytes, "object.npz");
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->motion.rate.hz, 29.97);
    EXPECT_EQ(read->motion.first_frame, 120);
    EXPECT_EQ(read->contacts, motion.contacts);
    ASSERT_EQ(read->motion.poses.size(), motion.motion.poses.size());
    EXPECT_LT(largest_distance_m(motion.motion, read->motion), 1e-5);
    ASSERT_EQ(read->uncertainty.size(), motion.uncertainty.size());
    for (std::size_t f = 0; f < motion.uncertainty.size(); ++f) {
      for (std::size_t j = 0; j < motion.uncertainty[f].size(); ++j) {
        EXPECT_EQ(read->uncertainty[f][j].source, motion.uncertainty[f][j].source);
        EXPECT_EQ(read->uncertainty[f][j].sigma_m, motion.uncertainty[f][j].sigma_m);
      }
    }
    EXPECT_EQ(*motion_object_bytes(motion), *bytes) << "same input, same bytes";
    const auto again = motion_object_bytes(*read);
    ASSERT_TRUE(again);
    const auto twice = parse_motion_object(*again, "object.npz");
    ASSERT_TRUE(twice);
    EXPECT_LT(largest_distance_m(read->motion, twice->motion), 1e-6);
  }
}

TEST(MotionObject, KeepsNamesBonesAndParents) {
  const LibraryMotion motion = random_motion(1, false);
  const auto read = parse_motion_object(*motion_object_bytes(motion), "object.npz");
  ASSERT_TRUE(read) << read.error().message();
  const auto& joints = motion.motion.skeleton.joints;
  ASSERT_EQ(read->motion.skeleton.joints.size(), joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    EXPECT_EQ(read->motion.skeleton.joints[j].name, joints[j].name);
    EXPECT_EQ(read->motion.skeleton.joints[j].bone, joints[j].bone);
    EXPECT_EQ(read->motion.skeleton.joints[j].parent, joints[j].parent);
  }
}

TEST(MotionObject, TakesLessThan400BytesAFrame) {
  const std::size_t one = motion_object_bytes(random_motion(1, false))->size();
  const std::size_t many = motion_object_bytes(random_motion(1001, false))->size();
  EXPECT_LT(static_cast<double>(many - one) / 1000.0, 400.0);
}

TEST(MotionObject, IsMappedByNumpy) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a.npz", *motion_object_bytes(random_motion(3, true))));
  if (run_program("/usr/bin/python3", {"-c", "import numpy"}).exit_code != 0) {
    GTEST_SKIP() << "numpy is missing; apt-get install python3-numpy";
  }
  const std::string script =
      "import sys, numpy as np\na = np.load(sys.argv[1])\n"
      "assert a['format'] == 2 and a['root_m'].shape == (3, 3)\n"
      "assert a['rotations_wxyz'].dtype == np.float32\n"
      "assert a['contacts'].tolist()[1] == [1, 0, 1, 0]\n"
      "assert np.allclose(np.linalg.norm(a['rotations_wxyz'], axis=2), 1, atol=1e-6)\n"
      "assert a['human_bones'][0] == 'hips' and a['source'].max() == 2\n";
  const auto run =
      run_program("/usr/bin/python3", {"-c", script, (folder / "a.npz").string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(MotionObject, RefusesOtherArchivesAndDamage) {
  const LibraryMotion motion = random_motion(2, true);
  const std::string bytes = *motion_object_bytes(motion);
  const auto refusal = [](std::string_view archive) {
    const auto read = parse_motion_object(archive, "object.npz");
    return read ? std::string() : read.error().message();
  };
  EXPECT_NE(refusal(*npz_bytes(motion.motion)).find("layout 1"), std::string::npos);
  EXPECT_NE(refusal("").find("object.npz"), std::string::npos);
  EXPECT_NE(refusal(bytes.substr(0, bytes.size() / 2)).find("library build"),
            std::string::npos);
  int refused = 0;
  for (std::size_t at = 40; at < bytes.size(); at += 97) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    if (!refusal(damaged).empty()) ++refused;
  }
  EXPECT_GT(refused, 10) << "the checksums find damage";
}

TEST(MotionObject, RefusesSkeletonsBeyondTheLimits) {
  LibraryMotion deep;
  deep.motion.rate = FrameRate{30.0};
  for (int i = 0; i < 1001; ++i) {
    Joint joint;
    joint.name = "j";
    if (i > 0) joint.parent = JointIndex{i - 1};
    deep.motion.skeleton.joints.push_back(joint);
  }
  const auto nested = parse_motion_object(*motion_object_bytes(deep), "object.npz");
  ASSERT_FALSE(nested);
  EXPECT_NE(nested.error().message().find("nested"), std::string::npos);
  LibraryMotion far = random_motion(1, false);
  far.motion.skeleton.joints[3].parent_from_joint.translation.x = 2e4;
  const auto away = parse_motion_object(*motion_object_bytes(far), "object.npz");
  ASSERT_FALSE(away);
  EXPECT_NE(away.error().message().find("10 km"), std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
