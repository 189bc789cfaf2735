// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey jump` on a captured jump, judged by the centre of mass of the written motion.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/app/jump/jump_scene.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"

namespace marey::testing {
namespace {

/// Heights above or below a parabola are up to this in the captured flight. [m]
constexpr double kCaptured_m = 0.006;
constexpr double kGravity = 9.81;

double highest(const std::vector<double>& heights_m) {
  return heights_m.empty() ? 0.0 : *std::max_element(heights_m.begin(), heights_m.end());
}

/// Returns the acceleration of a height around its highest frame, from the differences
/// over `reach` frames on both sides.
double acceleration_at_top(const std::vector<double>& heights_m, double hz, int reach) {
  const auto top = std::max_element(heights_m.begin(), heights_m.end());
  const auto t = top - heights_m.begin();
  if (t < reach || t + reach >= static_cast<std::ptrdiff_t>(heights_m.size())) return 0.0;
  const double step_s = reach / hz;
  return (*(top - reach) - 2.0 * *top + *(top + reach)) / (step_s * step_s);
}

TEST(JumpClip, IsRaisedByTheWishedHeight) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  const auto json = scene.figures("jump.npz", "out.npz", {"--apex-by", "10"});
  const Motion result = scene.motion("out.npz");
  const std::vector<double> before = judged_heights(scene.motion("jump.npz"));
  const std::vector<double> after = judged_heights(result);
  ASSERT_FALSE(after.empty());
  EXPECT_NEAR(highest(after) - highest(before), 0.10, kCaptured_m);
  EXPECT_NEAR(acceleration_at_top(after, result.rate.hz, 12), -kGravity, 0.05);
  EXPECT_NEAR(after.front(), before.front(), 1e-6);
  EXPECT_NEAR(after.back(), before.back(), 1e-3);
  EXPECT_EQ(json.at("frames"), result.poses.size());
  for (const char* key : {"out", "motion", "jump", "law", "result", "findings"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
}

TEST(JumpClip, ItsFiguresAgreeWithTheWrittenMotion) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  const auto json = scene.figures("jump.npz", "out.npz", {"--apex-by", "10"});
  const auto& figures = json.at("figures");
  const std::vector<double> heights_m = judged_heights(scene.motion("out.npz"));
  for (const char* name : {"start_s",
                           "lowest_s",
                           "takeoff_s",
                           "apex_s",
                           "touchdown_s",
                           "rise_m",
                           "airtime_s",
                           "takeoff_m_s",
                           "com_error_mm"}) {
    ASSERT_TRUE(figures.contains(name)) << name;
  }
  const double takeoff_s = figures.at("takeoff_s");
  const double touchdown_s = figures.at("touchdown_s");
  const double rise_m = figures.at("rise_m");
  EXPECT_NEAR(touchdown_s - takeoff_s, figures.at("airtime_s").get<double>(), 1e-6);
  const auto frame = static_cast<std::size_t>(std::lround(takeoff_s * 120.0));
  ASSERT_LT(frame, heights_m.size());
  const double speed_m_s = figures.at("takeoff_m_s");
  EXPECT_NEAR(speed_m_s * speed_m_s / (2.0 * kGravity), rise_m, 1e-3);
  // Half a frame at take-off speed.
  EXPECT_NEAR(
      highest(heights_m) - heights_m[frame], rise_m, 0.5 * speed_m_s / 120.0 + 1e-3);
  EXPECT_LT(figures.at("com_error_mm").get<double>(), 0.1);
}

TEST(JumpClip, StaysAsLongInTheAirAsWished) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  const auto json = scene.figures("jump.npz", "out.npz", {"--airtime", "0.6"});
  EXPECT_NEAR(json.at("figures").value("airtime_s", 0.0), 0.6, 1e-3);
}

TEST(JumpClip, FallsAtTheWishedGravity) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  const auto json =
      scene.figures("jump.npz", "out.npz", {"--gravity", "3.72", "--apex-by", "5"});
  const Motion result = scene.motion("out.npz");
  EXPECT_NEAR(
      acceleration_at_top(judged_heights(result), result.rate.hz, 12), -3.72, 0.05);
}

TEST(JumpClip, BecomesAParabolaWithoutAnotherWish) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  const auto json = scene.figures("jump.npz", "out.npz", {"--ballistic"});
  const Motion result = scene.motion("out.npz");
  const std::vector<double> after = judged_heights(result);
  for (const int reach : {6, 12, 20}) {
    EXPECT_NEAR(acceleration_at_top(after, result.rate.hz, reach), -kGravity, 0.1);
  }
  EXPECT_NEAR(highest(after), highest(judged_heights(scene.motion("jump.npz"))), 0.02);
}

TEST(JumpClip, LandsOnABox) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  ASSERT_EQ(
      scene.jump("jump.npz", "out.npz", {"--box", "30", "--apex-by", "30"}).exit_code, 0);
  const std::vector<double> before = judged_heights(scene.motion("jump.npz"));
  const std::vector<double> after = judged_heights(scene.motion("out.npz"));
  ASSERT_FALSE(before.empty() || after.empty());
  // The captured feet land some millimetres above or below their take-off.
  EXPECT_NEAR(after.back() - before.back(), 0.30, 0.01);
  EXPECT_NEAR(highest(after) - highest(before), 0.30, kCaptured_m);
}

TEST(JumpClip, TheLandingIsWhereItIsWished) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  ASSERT_EQ(scene.jump("jump.npz", "a.npz", {"--land", "0,0,0.5"}).exit_code, 0);
  ASSERT_EQ(scene.jump("jump.npz", "b.npz", {"--land", "-0.2,0,0.8"}).exit_code, 0);
  const Motion a = scene.motion("a.npz");
  const Motion b = scene.motion("b.npz");
  ASSERT_FALSE(a.poses.empty() || b.poses.empty());
  const glm::dvec3 apart = b.poses.back().root_in_world - a.poses.back().root_in_world;
  EXPECT_NEAR(apart.x, -0.2, 1e-3);
  EXPECT_NEAR(apart.y, 0.0, 1e-3);
  EXPECT_NEAR(apart.z, 0.3, 1e-3);
}

TEST(JumpClip, ARecipeWithTheSameOperationGivesTheSameMotion) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  ASSERT_TRUE(recordings::write_file(
      scene / "r.edit.toml",
      "format = 1\nname = \"r\"\n[source]\npath = \"jump.npz\"\n"
      "[[op]]\ndo = \"jump@1\"\napex_by_m = 0.08\npush_s = 0.6\nlaw = \"thesis\"\n"
      "strength_g = 5\n"));
  const ProgramRun edit =
      run_program(program(),
                  {"edit", "r.edit.toml", "--out", ".", "--format", "npz"},
                  {.folder = (scene / ".").lexically_normal(), .interrupt_at = {}});
  ASSERT_EQ(edit.exit_code, 0) << edit.err;
  const ProgramRun jump = scene.jump(
      "jump.npz",
      "out.npz",
      {"--apex-by", "8", "--push-time", "0.6", "--law", "thesis", "--strength", "5"});
  ASSERT_EQ(jump.exit_code, 0) << jump.err;
  const auto a = recordings::read_file(scene / "r.npz");
  const auto b = recordings::read_file(scene / "out.npz");
  ASSERT_TRUE(a && b);
  EXPECT_TRUE(*a == *b);
}

TEST(JumpClip, TheSameInputGivesTheSameBytes) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  ASSERT_EQ(scene.jump("jump.npz", "a.npz", {"--apex-by", "5"}).exit_code, 0);
  ASSERT_EQ(scene.jump("jump.npz", "b.npz", {"--apex-by", "5"}).exit_code, 0);
  const auto a = recordings::read_file(scene / "a.npz");
  const auto b = recordings::read_file(scene / "b.npz");
  ASSERT_TRUE(a && b);
  EXPECT_TRUE(*a == *b);
}

TEST(JumpClip, IsWrittenInEachFormatAndNothingElseIs) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  std::vector<std::string> expected = scene.files();
  for (const std::string name : {"out.bvh", "out.npz", "out.csv"}) {
    const ProgramRun run = scene.jump("jump.npz", name, {"--apex-by", "5"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(run.out.empty());
    expected.push_back(name);
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(scene.files(), expected);
}

TEST(JumpClip, TheCharacterGetsTheMotionOnItsBody) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  ASSERT_TRUE(recordings::write_file(scene / "ann.toml",
                                     "format = 1\nname = \"Ann\"\nstature_m = 1.5\n"
                                     "mass_kg = 50\n"));
  const auto json = scene.figures(
      "jump.npz", "out.npz", {"--character", "ann.toml", "--apex-by", "10"});
  EXPECT_EQ(json.at("character"), "ann.toml");
  const double own_m = highest(judged_heights(scene.motion("jump.npz")));
  EXPECT_LT(highest(judged_heights(scene.motion("out.npz"))), own_m);
}

TEST(JumpClip, FewFramesASecondAreAWarning) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  scene.write_part("slow.npz", 0, 480, 3);  // 40 Hz.
  const ProgramRun run = scene.jump("slow.npz", "out.npz", {"--apex-by", "5"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("warning: slow.npz: "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("uncertain by a frame"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace marey::testing
