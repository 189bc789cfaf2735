// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/npz.h"

#include <gtest/gtest.h>

#include "recordings/atomic_file.h"
#include "recordings/zip_store.h"
#include "tests/recordings/wild_motion.h"
#include "tests/support/run_program.h"
#include "tests/support/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::run_program;
using testing::ScratchFolder;

// Debian's, whose numpy ./run sees to.
constexpr const char* kPython = "/usr/bin/python3";

/// Three joints, two frames at 29.97 Hz from frame 5; the second is turned half round.
Motion a_motion() {
  Motion motion;
  motion.skeleton.joints.resize(3);
  motion.skeleton.joints[0].name = "hips";
  motion.skeleton.joints[0].bone = HumanBone::kHips;
  motion.skeleton.joints[1].name =
      "r\xC3\xBC"
      "cken";
  motion.skeleton.joints[1].parent = JointIndex{0};
  motion.skeleton.joints[1].parent_from_joint.translation = {0.0, 0.25, 0.0};
  motion.skeleton.joints[2].name = "\xF0\x9F\x92\x83\xFF";
  motion.skeleton.joints[2].parent = JointIndex{1};
  motion.rate = {29.97};
  motion.first_frame = 5;
  const glm::dquat one(1.0, 0.0, 0.0, 0.0);
  motion.poses.push_back({{1.0, 2.0, 3.0}, {one, one, one}});
  motion.poses.push_back({{1.0, 2.0, 4.0}, {glm::dquat(-0.6, 0.8, 0.0, 0.0), one, one}});
  return motion;
}

/// Runs Python on an archive, as `a`. Its assertions are the test's.
void expect_in_numpy(const std::filesystem::path& path, const std::string& assertions) {
  if (run_program(kPython, {"-c", "import numpy"}).exit_code != 0) {
    GTEST_SKIP() << "numpy is missing; apt-get install python3-numpy";
  }
  const std::string script =
      "import sys, zipfile\nimport numpy as np\n"
      "assert zipfile.ZipFile(sys.argv[1]).testzip() is None\n"
      "a = np.load(sys.argv[1])\n" +
      assertions;
  const auto run = run_program(kPython, {"-c", script, path.string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(Npz, IsReadByNumpy) {
  const ScratchFolder folder;
  const std::vector<std::vector<JointDoubt>> doubt{
      {{0.001, Source::kMeasured}, {0.002, Source::kRepaired}, {0.5, Source::kInferred}},
      {{0.001, Source::kMeasured}, {0.002, Source::kMeasured}, {0.5, Source::kMeasured}}};
  const NpzExtras extras{doubt, {{"leftFoot", "rightFoot"}, {1, 0, 1, 1}}, 0.25};
  ASSERT_TRUE(write_npz(folder / "a.npz", a_motion(), extras));
  expect_in_numpy(folder / "a.npz", R"(
assert a['format'] == 1 and a['rate_hz'] == 29.97 and a['first_frame'] == 5
assert a['first_frame'].dtype == np.int64
assert np.abs(a['time_s'] - [.25, .25 + 1 / 29.97]).max() < 1e-15
assert a['joint_names'].tolist() == ['hips', 'r\u00fccken', '\U0001f483\ufffd']
assert a['human_bones'].tolist() == ['hips', '', '']
assert a['parents'].tolist() == [-1, 0, 1] and a['parents'].dtype == np.int32
assert a['rest_translations'].tolist() == [[0, 0, 0], [0, 0.25, 0], [0, 0, 0]]
assert a['rest_rotations_wxyz'].tolist() == [[1, 0, 0, 0]] * 3
assert a['positions'].shape == (2, 3, 3)
assert np.abs(a['positions'][1, 1] - [1, 2 - 0.25 * 0.28, 4 - 0.25 * 0.96]).max() < 1e-15
assert np.abs(a['rotations_wxyz'][1] - [[.6, -.8, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0]]).max() < 1e-15
assert np.abs(a['world_rotations_wxyz'][1] - [[.6, -.8, 0, 0]] * 3).max() < 1e-15
assert a['sigma_m'].tolist() == [[.001, .002, .5]] * 2
assert a['source_names'][a['source'][0]].tolist() == ['measured', 'repaired', 'inferred']
assert a['valid'].tolist() == [[True, True, False], [True] * 3]
assert a['contact_names'].tolist() == ['leftFoot', 'rightFoot']
assert a['contacts'].tolist() == [[True, False], [True, True]]
)");
}

TEST(Npz, SaysNothingOfWhatIsNotKnown) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_npz(folder / "a.npz", a_motion()));
  expect_in_numpy(folder / "a.npz", R"(
assert np.abs(a['time_s'] - np.array([5, 6]) / 29.97).max() < 1e-15
for key in 'sigma_m source source_names valid contacts contact_names'.split():
    assert key not in a.files, key
)");
}

TEST(Npz, HasNoFramesWhereAMotionHasNone) {
  const ScratchFolder folder;
  Motion motion = a_motion();
  motion.poses.clear();
  ASSERT_TRUE(write_npz(folder / "a.npz", motion));
  expect_in_numpy(folder / "a.npz", "assert a['positions'].shape == (0, 3, 3)\n");
}

// numpy's forward kinematics of the archive's own skeleton gives its places.
TEST(Npz, HoldsPlacesAndRotationsThatAgree) {
  const ScratchFolder folder;
  const Motion motion =
      wild_motion(with_turned_axes(make_humanoid(average_proportions(1.7))), 50);
  ASSERT_TRUE(write_npz(folder / "a.npz", motion));
  expect_in_numpy(folder / "a.npz", R"(
def rotate(q, v):
    w, u = q[..., :1], q[..., 1:]
    return v + 2 * np.cross(u, np.cross(u, v) + w * v)
world, place = a['world_rotations_wxyz'], a['positions']
for joint, parent in enumerate(a['parents']):
    if parent < 0: continue
    there = place[:, parent] + rotate(world[:, parent], a['rest_translations'][joint])
    assert np.abs(there - place[:, joint]).max() < 1e-12
assert np.abs(np.linalg.norm(world, axis=2) - 1).max() < 1e-12
assert (np.sum(world[1:] * world[:-1], axis=2) >= 0).all()
)");
}

TEST(Npz, IsTheSameBytesAgain) {
  EXPECT_EQ(*npz_bytes(a_motion()), *npz_bytes(a_motion()));
}

// The check value of the algorithm's definition.
TEST(ZipStore, HasTheUsualCrc32) {
  EXPECT_EQ(crc32("123456789"), 0xcbf43926U);
  EXPECT_EQ(crc32(""), 0U);
}

TEST(ZipStore, RefusesMoreFilesThanItCanCount) {
  ZipStore zip;
  for (int i = 0; i < 0xffff; ++i) zip.add("a", "");
  EXPECT_EQ(std::move(zip).finish(), std::nullopt);
}

}  // namespace
}  // namespace marey::recordings
