// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/check_ids.h"

#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace marey::app {
namespace {

using recordings::Session;
using recordings::TrialKind;

constexpr int kIdFrames = 40;

/// A session with a board of the tags 0 to 3, and tag 41 worn on the hips.
Session session() {
  Session out;
  out.file = "session.toml";
  out.families.push_back(
      {"tag36h11", {TagId{0}, TagId{1}, TagId{2}, TagId{3}, TagId{41}}});
  out.target = AprilGrid{2, 2, 0.1, 0.03, 0, 0.0};
  out.tags.push_back({TagId{41}, HumanBone::kHips, 0.09});
  for (const TrialKind kind : {TrialKind::kCalibration, TrialKind::kRangeOfMotion}) {
    auto& trial = out.trials.emplace_back();
    trial.name = recordings::name(kind);
    trial.kind = kind;
  }
  return out;
}

/// One camera that sees these tags in every frame, of 20 px, moving by `speed_px` a
/// frame.
CameraDetections seen_at_speeds(const std::map<int, double>& speed_px) {
  CameraDetections camera;
  for (int f = 0; f < kIdFrames; ++f) {
    auto& frame = camera.frames.emplace_back();
    for (const auto& [id, speed] : speed_px) {
      const double x = 30.0 * id + speed * f;
      frame.tags.push_back(
          {TagId{id}, {{{x, 20.0}, {x + 20.0, 20.0}, {x + 20.0, 0.0}, {x, 0.0}}}});
    }
  }
  return camera;
}

std::vector<std::string> warnings(const std::map<int, double>& waved,
                                  const std::map<int, double>& worn) {
  std::vector<Finding> findings;
  const Status ok = check_ids(session(),
                              {{"calibration", {seen_at_speeds(waved)}},
                               {"range-of-motion", {seen_at_speeds(worn)}}},
                              findings);
  EXPECT_TRUE(ok) << ok.error().message();
  std::vector<std::string> lines;
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.severity, Severity::kFair);
    lines.push_back(finding.message());
  }
  return lines;
}

TEST(CheckIds, PassesTagsThatAreListed) {
  EXPECT_TRUE(warnings({{0, 2.0}, {3, 2.0}}, {{41, 2.0}}).empty());
}

TEST(CheckIds, ReportsTagsThatMoveWithTheBoard) {
  const auto found = warnings({{0, 2.0}, {4, 2.0}, {5, 2.0}}, {{41, 2.0}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].starts_with(
      "session.toml: [board]: tags 4, 5 move with the board in trial \"calibration\""))
      << found[0];
}

TEST(CheckIds, ReportsTagsThatMoveWithTheBody) {
  const auto found = warnings({{0, 2.0}}, {{41, 2.0}, {50, 2.0}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].starts_with(
      "session.toml: [[tags.tag]]: tag 50 is often seen but not listed"))
      << found[0];
}

TEST(CheckIds, IgnoresTagsOnWalls) {
  EXPECT_TRUE(warnings({{0, 2.0}, {4, 0.1}}, {{41, 2.0}, {50, 0.1}}).empty());
}

TEST(CheckIds, RefusesIdsThatLookMistyped) {
  std::vector<Finding> findings;
  const Status ok = check_ids(session(),
                              {{"calibration", {seen_at_speeds({{0, 2.0}})}},
                               {"range-of-motion", {seen_at_speeds({{14, 2.0}})}}},
                              findings);
  ASSERT_FALSE(ok);
  EXPECT_TRUE(ok.error().cause.starts_with("tag 41 is listed but never seen; tag 14"))
      << ok.error().cause;
}

}  // namespace
}  // namespace marey::app
