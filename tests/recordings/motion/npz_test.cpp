// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/npz.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/zip_archive.h"
#include "tests/recordings/wild_motion.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::run_program;
using testing::ScratchFolder;

// Debian's Python, whose numpy ./run installs.
constexpr const char* kPython = "/usr/bin/python3";

/// Three joints, two frames at 29.97 Hz from frame 5; the second is rotated by half a
/// turn.
Motion short_motion() {
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

TEST(Npz, IsReadBackAsItWasWritten) {
  const Motion motion = short_motion();
  const std::vector<std::vector<JointUncertainty>> uncertainty{
      {{0.001, Source::kMeasured}, {0.002, Source::kRepaired}, {0.5, Source::kInferred}},
      {{0.0, Source::kInferred}, {0.25, Source::kMeasured}, {0.5, Source::kRepaired}}};
  const NpzContacts contacts{{"leftFoot", "rightFoot"}, {1, 0, 0, 1}};
  const auto bytes = npz_bytes(motion, {uncertainty, contacts, 12.5});
  ASSERT_TRUE(bytes);
  const auto read = parse_npz(*bytes, "a.npz");
  ASSERT_TRUE(read) << read.error().message();
  const auto& joints = read->motion.skeleton.joints;
  ASSERT_EQ(joints.size(), 3U);
  EXPECT_EQ(joints[0].bone, HumanBone::kHips);
  EXPECT_EQ(joints[1].name, motion.skeleton.joints[1].name);
  EXPECT_EQ(joints[2].parent, JointIndex{1});
  EXPECT_EQ(joints[1].parent_from_joint.translation, glm::dvec3(0.0, 0.25, 0.0));
  EXPECT_EQ(read->motion.rate.hz, 29.97);
  EXPECT_EQ(read->motion.first_frame, 5);
  EXPECT_EQ(read->start_s, 12.5);
  ASSERT_EQ(read->motion.poses.size(), 2U);
  EXPECT_EQ(read->motion.poses[1].root_in_world, glm::dvec3(1.0, 2.0, 4.0));
  const glm::dquat turned = read->motion.poses[1].parent_from_joint[0];
  EXPECT_NEAR(std::abs(glm::dot(turned, glm::dquat(-0.6, 0.8, 0.0, 0.0))), 1.0, 1e-12);
  ASSERT_EQ(read->uncertainty.size(), 2U);
  EXPECT_EQ(read->uncertainty[1][1].sigma_m, 0.25);
  EXPECT_EQ(read->uncertainty[0][1].source, Source::kRepaired);
  EXPECT_EQ(read->contacts.names, contacts.names);
  EXPECT_EQ(read->contacts.bears, contacts.bears);
}

TEST(Npz, DamagedAnywhereIsDeclinedOrRead) {
  const auto bytes = npz_bytes(short_motion());
  ASSERT_TRUE(bytes);
  for (std::size_t at = 0; at < bytes->size(); at += 7) {
    std::string damaged = *bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    const auto read = parse_npz(damaged, "a.npz");
    if (!read) {
      EXPECT_EQ(read.error().code, Errc::kBadInput);
    }
    const auto cut = parse_npz(std::string_view(*bytes).substr(0, at), "a.npz");
    EXPECT_FALSE(cut) << at;
  }
}

TEST(Npz, ReadsFilesOfNumpyUnlessTheyAreCompressed) {
  const ScratchFolder folder;
  const auto again = [&](const std::string& how) {
    EXPECT_TRUE(write_npz(folder / "a.npz", short_motion()));
    const std::string script =
        "import sys\nimport numpy as np\na = np.load(sys.argv[1])\n"
        "np." +
        how + "(sys.argv[2], **{k: a[k] for k in a.files})\n";
    const auto run = run_program(
        kPython,
        {"-c", script, (folder / "a.npz").string(), (folder / "b.npz").string()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return read_npz(folder / "b.npz");
  };
  if (run_program(kPython, {"-c", "import numpy"}).exit_code != 0) {
    GTEST_SKIP() << "numpy is missing; apt-get install python3-numpy";
  }
  const auto read = again("savez");
  EXPECT_TRUE(read) << read.error().message();
  const auto compressed = again("savez_compressed");
  ASSERT_FALSE(compressed);
  EXPECT_EQ(compressed.error().cause, "its arrays are compressed");
  EXPECT_NE(compressed.error().next.find("numpy.savez"), std::string::npos);
}

TEST(Npz, IsReadByNumpy) {
  const ScratchFolder folder;
  const std::vector<std::vector<JointUncertainty>> uncertainty{
      {{0.001, Source::kMeasured}, {0.002, Source::kRepaired}, {0.5, Source::kInferred}},
      {{0.001, Source::kMeasured}, {0.002, Source::kMeasured}, {0.5, Source::kMeasured}}};
  const NpzExtras extras{uncertainty, {{"leftFoot", "rightFoot"}, {1, 0, 1, 1}}, 0.25};
  ASSERT_TRUE(write_npz(folder / "a.npz", short_motion(), extras));
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

TEST(Npz, OmitsArraysOfUnknownData) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_npz(folder / "a.npz", short_motion()));
  expect_in_numpy(folder / "a.npz", R"(
assert np.abs(a['time_s'] - np.array([5, 6]) / 29.97).max() < 1e-15
for key in 'sigma_m source source_names valid contacts contact_names'.split():
    assert key not in a.files, key
)");
}

TEST(Npz, HasNoFramesWhereAMotionHasNone) {
  const ScratchFolder folder;
  Motion motion = short_motion();
  motion.poses.clear();
  ASSERT_TRUE(write_npz(folder / "a.npz", motion));
  expect_in_numpy(folder / "a.npz", "assert a['positions'].shape == (0, 3, 3)\n");
}

// numpy's forward kinematics of the archive's own skeleton gives its positions.
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
  EXPECT_EQ(*npz_bytes(short_motion()), *npz_bytes(short_motion()));
}

// A date of writing would differ between runs.
TEST(Npz, HasOneDateForAllFiles) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_npz(folder / "a.npz", short_motion()));
  expect_in_numpy(folder / "a.npz", R"(
files = zipfile.ZipFile(sys.argv[1]).infolist()
assert files and all(f.date_time == (1980, 1, 1, 0, 0, 0) for f in files)
assert all(f.compress_type == zipfile.ZIP_STORED and not f.extra for f in files)
)");
}

TEST(ZipArchive, RoundTripsItsFiles) {
  ZipWriter writer;
  writer.add("a", "123456789");
  writer.add("empty.npy", "");
  const auto bytes = std::move(writer).finish();
  ASSERT_TRUE(bytes);
  auto zip = ZipReader::open(*bytes);
  ASSERT_TRUE(zip);
  EXPECT_TRUE(zip->contains("a"));
  EXPECT_FALSE(zip->contains("b"));
  EXPECT_TRUE(zip->contains_ending(".npy"));
  EXPECT_FALSE(zip->contains_ending(".npz"));
  EXPECT_EQ(std::get<std::string>(zip->read("a")), "123456789");
  EXPECT_EQ(std::get<std::string>(zip->read("empty.npy")), "");
  EXPECT_EQ(std::get<ZipProblem>(zip->read("b")), ZipProblem::kAbsent);
}

TEST(ZipArchive, ReportsAChangedByte) {
  ZipWriter writer;
  writer.add("a", "123456789");
  auto bytes = std::move(writer).finish();
  ASSERT_TRUE(bytes);
  bytes->at(bytes->find("123456789") + 4) = 'x';
  auto zip = ZipReader::open(*bytes);
  ASSERT_TRUE(zip);
  EXPECT_EQ(std::get<ZipProblem>(zip->read("a")), ZipProblem::kWrongChecksum);
}

// Entries that overlap could otherwise hold much more than the archive.
TEST(ZipArchive, ReturnsAtMostItsOwnSize) {
  ZipWriter writer;
  writer.add("a", std::string(1000, 'x'));
  const auto bytes = std::move(writer).finish();
  ASSERT_TRUE(bytes);
  auto zip = ZipReader::open(*bytes);
  ASSERT_TRUE(zip);
  EXPECT_EQ(std::get<std::string>(zip->read("a")).size(), 1000U);
  EXPECT_EQ(std::get<ZipProblem>(zip->read("a")), ZipProblem::kDamaged);
}

}  // namespace
}  // namespace marey::recordings
