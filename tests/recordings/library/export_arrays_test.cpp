// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/export_arrays.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "core/library/joint_names.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::recordings {
namespace {

using testing::run_program;
using testing::ScratchFolder;

constexpr const char* kPython3 = "/usr/bin/python3";

bool has_numpy() {
  return run_program(kPython3, {"-c", "import numpy"}).exit_code == 0;
}

/// Runs Python with the arrays `a` of a file and the places `p` of SMPL's joints, which
/// C++ computed.
void expect_in_python(const std::string& bytes,
                      const std::string& ending,
                      const Motion& motion,
                      const std::string& script) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / ("a" + ending), bytes));
  std::string places = "p = np.array([";
  for (const Pose& pose : motion.poses) {
    const auto world = world_from_joints(motion.skeleton, pose);
    for (const NamedBone& joint : kSmplJoints) {
      const glm::dvec3& place =
          world[index(*motion.skeleton.find(joint.bone))].translation;
      for (int k = 0; k < 3; ++k) places += std::to_string(place[k]) + ",";
    }
  }
  places += "]).reshape(-1, 22, 3)\n";
  ASSERT_TRUE(write_file(
      folder / "s.py",
      "import sys, numpy as np\na = np.load(sys.argv[1])\n" + places + script));
  const auto run = run_program(
      kPython3, {(folder / "s.py").string(), (folder / ("a" + ending)).string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

// Forward kinematics in NumPy, with the rest places of the skeleton.
TEST(ExportArrays, AmassPosesGiveTheMotionsJoints) {
  if (!has_numpy()) GTEST_SKIP() << "numpy is missing; apt-get install python3-numpy";
  const Motion motion = testing::synthetic_walk(12, 29.97, 0.2, 0.1).motion;
  const auto bytes = amass_bytes(motion);
  ASSERT_TRUE(bytes);
  const auto rest = world_from_joints(motion.skeleton, rest_pose(motion.skeleton));
  std::string script = "rest = np.array([";
  for (const NamedBone& joint : kSmplJoints) {
    const glm::dvec3& place = rest[index(*motion.skeleton.find(joint.bone))].translation;
    for (int k = 0; k < 3; ++k) script += std::to_string(place[k]) + ",";
  }
  script +=
      "]).reshape(22, 3)\n"
      "parents = [-1,0,0,0,1,2,3,4,5,6,7,8,9,9,9,12,13,14,16,17,18,19]\n"
      "def matrix(v):\n"
      "  t = np.linalg.norm(v)\n"
      "  if t < 1e-12: return np.eye(3)\n"
      "  x, y, z = v / t\n"
      "  k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])\n"
      "  return np.eye(3) + np.sin(t) * k + (1 - np.cos(t)) * k @ k\n"
      "assert sorted(a.files) == ['betas', 'dmpls', 'gender', 'mocap_frame_rate',\n"
      "                           'mocap_framerate', 'poses', 'trans']\n"
      "assert a['poses'].shape == (12, 156) and a['poses'].dtype == np.float64\n"
      "assert a['trans'].shape == (12, 3) and not a['betas'].any()\n"
      "assert a['betas'].shape == (16,) and a['dmpls'].shape == (12, 8)\n"
      "assert str(a['gender']) == 'neutral'\n"
      "assert a['mocap_framerate'] == a['mocap_frame_rate'] == 29.97\n"
      "assert not a['poses'][:, 66:].any()\n"
      "for f in range(12):\n"
      "  turn, place = [], []\n"
      "  for j in range(22):\n"
      "    v = a['poses'][f, 3 * j:3 * j + 3]\n"
      "    assert np.linalg.norm(v) <= np.pi + 1e-9\n"
      "    if j == 0:\n"
      "      turn.append(matrix(v)); place.append(a['trans'][f])\n"
      "    else:\n"
      "      i = parents[j]\n"
      "      turn.append(turn[i] @ matrix(v))\n"
      "      place.append(place[i] + turn[i] @ (rest[j] - rest[i]))\n"
      "  zup = np.array(place)\n"
      "  yup = np.stack([zup[:, 0], zup[:, 2], -zup[:, 1]], 1)\n"
      "  assert np.abs(yup - p[f]).max() < 1e-5, np.abs(yup - p[f]).max()\n";
  expect_in_python(*bytes, ".npz", motion, script);
}

TEST(ExportArrays, Joints22AreSmplsPlaces) {
  if (!has_numpy()) GTEST_SKIP() << "numpy is missing; apt-get install python3-numpy";
  const Motion motion = testing::synthetic_walk(5, 20.0, 0.2, 0.1).motion;
  const auto bytes = joints22_bytes(motion);
  ASSERT_TRUE(bytes);
  expect_in_python(*bytes,
                   ".npy",
                   motion,
                   "assert a.shape == (5, 22, 3) and a.dtype == np.float32\n"
                   "assert np.abs(a - p).max() < 1e-5\n");
}

TEST(ExportArrays, RefuseABodyWithoutABone) {
  Motion motion = testing::synthetic_walk(5, 20.0).motion;
  motion.skeleton.joints[3].bone = std::nullopt;
  for (const auto& bytes : {amass_bytes(motion), joints22_bytes(motion)}) {
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().message(),
              "the body has no bone \"upperChest\", which SMPL's 22 joints need. Next: "
              "export with --skeleton smpl22.");
  }
}

TEST(ExportArrays, MatchingDatabaseIsReadByNumPy) {
  if (!has_numpy()) GTEST_SKIP() << "numpy is missing; apt-get install python3-numpy";
  const MatchingDatabase database{{1, 2, 3, 4, 5, 6},
                                  {0.5, 0.25},
                                  {2, 4},
                                  {0, 1},
                                  {1, 3},
                                  {30, 60},
                                  {"a", "bc"},
                                  {"x_m", "y_m"}};
  const auto bytes = matching_bytes(database);
  ASSERT_TRUE(bytes);
  expect_in_python(*bytes,
                   ".npz",
                   {},
                   "assert a['features'].tolist() == [[1, 2], [3, 4], [5, 6]]\n"
                   "assert a['features'].dtype == np.float32\n"
                   "assert a['features_offset'].tolist() == [0.5, 0.25]\n"
                   "assert a['features_scale'].tolist() == [2, 4]\n"
                   "assert a['range_starts'].tolist() == [0, 1]\n"
                   "assert a['range_stops'].tolist() == [1, 3]\n"
                   "assert a['rate_hz'].tolist() == [30, 60]\n"
                   "assert a['clip_ids'].tolist() == ['a', 'bc']\n"
                   "assert a['feature_names'].tolist() == ['x_m', 'y_m']\n");
}

}  // namespace
}  // namespace marey::recordings
