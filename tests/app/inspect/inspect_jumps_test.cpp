// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey inspect` lists the jumps of a motion.
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/motion/npz.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"
#include "tests/support/truth/truth_motion.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using JumpsJson = nlohmann::json;

/// Returns the jumps that are printed for a file; null: the key is missing.
JumpsJson jumps_of(const fs::path& file) {
  const ProgramRun run = run_program(program(), {"inspect", file.string(), "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const JumpsJson json = JumpsJson::parse(run.out, nullptr, false);
  EXPECT_TRUE(json.is_object());
  return json.is_object() && json.contains("jumps") ? json.at("jumps") : JumpsJson();
}

TEST(InspectJumps, AWalkHasNone) {
  const ScratchFolder folder;
  ASSERT_TRUE(recordings::write_npz(folder / "walk.npz",
                                    synthetic_walk(360, 120.0, 0.002, 0.0005).motion));
  EXPECT_EQ(jumps_of(folder / "walk.npz"), JumpsJson::array());
}

TEST(InspectJumps, ABodyWithoutLegsHasNoList) {
  const ScratchFolder folder;
  Motion motion;
  motion.rate.hz = 120.0;
  motion.skeleton.joints.resize(1);
  motion.skeleton.joints[0].name = "hips";
  motion.skeleton.joints[0].bone = HumanBone::kHips;
  Pose pose;
  pose.parent_from_joint.resize(1);
  motion.poses.assign(60, pose);
  ASSERT_TRUE(recordings::write_npz(folder / "stick.npz", motion));
  EXPECT_TRUE(jumps_of(folder / "stick.npz").is_null());
}

TEST(InspectJumps, ACapturedJumpHasItsTimesAndItsRise) {
  const fs::path source = shared_data() / "mocap/cmu_asfamc/02_04.amc";
  if (!fs::exists(source)) GTEST_SKIP() << source << " is absent";
  const JumpsJson jumps = jumps_of(source);
  ASSERT_EQ(jumps.size(), 1U);
  const JumpsJson& jump = jumps.at(0);
  EXPECT_EQ(jump.at("number"), 1);
  // The body begins to sink after 0.10 s, slowly.
  EXPECT_NEAR(jump.at("start_s").get<double>(), 0.13, 0.05);
  EXPECT_NEAR(jump.at("fall_m_s2").get<double>(), -9.87, 0.15);
  const double start_s = jump.at("start_s");
  const double lowest_s = jump.at("lowest_s");
  const double takeoff_s = jump.at("takeoff_s");
  const double apex_s = jump.at("apex_s");
  const double touchdown_s = jump.at("touchdown_s");
  EXPECT_LT(start_s, lowest_s);
  EXPECT_LT(lowest_s, takeoff_s);
  EXPECT_LT(takeoff_s, apex_s);
  EXPECT_LT(apex_s, touchdown_s);
  EXPECT_LT(touchdown_s, jump.at("rest_s").get<double>());
  EXPECT_NEAR(jump.at("airtime_s").get<double>(), touchdown_s - takeoff_s, 2e-6);
  const double speed_m_s = jump.at("takeoff_m_s");
  EXPECT_NEAR(
      jump.at("rise_m").get<double>(), speed_m_s * speed_m_s / (2.0 * 9.81), 1e-3);
}

TEST(InspectJumps, ACaptureThatFallsTooFastIsNamed) {
  const auto motion =
      truth_motion(shared_data().string() + "/blender/dev/jump/truth/segments_120hz.csv");
  if (!motion) GTEST_SKIP() << "the rendered recordings are absent";
  const ScratchFolder folder;
  ASSERT_TRUE(recordings::write_npz(folder / "jump.npz", *motion));
  const JumpsJson jumps = jumps_of(folder / "jump.npz");
  ASSERT_EQ(jumps.size(), 1U);
  // A fit of the flight of this capture gives -11.6 to -12.2, by the edges of the flight.
  EXPECT_NEAR(jumps.at(0).at("fall_m_s2").get<double>(), -11.9, 0.5);
  ASSERT_FALSE(jumps.at(0).at("findings").empty());
  const ProgramRun text =
      run_program(program(), {"inspect", (folder / "jump.npz").string()});
  EXPECT_NE(text.out.find("falls at -1"), std::string::npos) << text.out;
}

}  // namespace
}  // namespace marey::testing
