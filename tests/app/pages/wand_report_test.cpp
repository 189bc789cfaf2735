// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The report of cameras that were calibrated with a wand, tags lying about.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/pages/calibration_json.h"
#include "calib/quality/calibration_report.h"
#include "calib/quality/report_calibration.h"
#include "calib/rig/calibrate_wand.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::app {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSize_m = 0.16;
const Wand kWand{
    {{TagId{0}, kSize_m}, {TagId{1}, kSize_m}, {TagId{2}, kSize_m}, {TagId{3}, kSize_m}}};
constexpr int kScenery = 9;
constexpr std::size_t kAskew = 2;  ///< The camera that sees the static tags elsewhere.

/// A tag on each side of a box, its printed face outwards.
RigidTransform wand_from_tag(int side) {
  const glm::dquat turn = rotation_from_vector({0.0, 0.5 * kPi * side, 0.0});
  return {turn, turn * glm::dvec3(0.0, 0.0, -0.1)};
}

/// About half a metre around the middle: no camera sees it in all of its picture.
RigidTransform world_from_wand(double share) {
  const double round = 2.0 * kPi * share;
  return {rotation_from_vector({0.0, 2.3 * round, 0.0}) *
              rotation_from_vector({0.6 * std::sin(5.0 * round), 0.0, 0.0}) *
              rotation_from_vector({0.0, 0.0, 0.6 * std::cos(4.0 * round)}),
          {0.5 * std::sin(3.0 * round),
           1.0 + 0.4 * std::cos(2.0 * round),
           0.5 * std::cos(round)}};
}

/// Returns forty frames of the wand, with tags that lie on the floor all the time. kAskew
/// sees the floor tags 12 px to the right of their places, as in a mirror.
std::vector<CameraDetections> wave_wand(const std::vector<Camera>& cameras) {
  constexpr int kFrames = 40;
  auto waved = marey::testing::unseeing(cameras, kFrames, 10.0, "wand");
  marey::testing::Dice dice(5);
  for (int f = 0; f < kFrames; ++f) {
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      auto& tags = waved[c].frames[static_cast<std::size_t>(f)].tags;
      const auto see = [&](const RigidTransform& world_from_tag, int id, double off_px) {
        auto tag =
            marey::testing::see_tag(cameras[c], world_from_tag, TagId{id}, kSize_m);
        if (!tag) return;
        for (glm::dvec2& corner : tag->corners_px) corner.x += off_px;
        tags.push_back(marey::testing::disturbed(*tag, {0.1, {}, 0.0}, dice));
      };
      const RigidTransform wand = world_from_wand(f / static_cast<double>(kFrames));
      for (int side = 0; side < 4; ++side) see(wand * wand_from_tag(side), side, 0.0);
      for (int i = 0; i < 4; ++i) {
        const RigidTransform lying{rotation_from_vector({0.5 * kPi, 0.0, 0.0}),
                                   {i % 2 == 0 ? -0.8 : 0.8, 0.0, i < 2 ? -0.8 : 0.8}};
        see(lying, kScenery + i, c == kAskew ? 12.0 : 0.0);
      }
    }
  }
  return waved;
}

struct Waved {
  std::vector<CameraDetections> seen;
  calib::CalibratedRig rig;
};

const Waved& waved_among_scenery() {
  static const Waved waved = [] {
    const auto cameras = marey::testing::ring_of_cameras();
    Waved out{wave_wand(cameras), {}};
    auto found =
        calib::calibrate_wand(marey::testing::names_of(cameras), out.seen, kWand);
    if (!found) throw std::runtime_error(found.error().message());
    out.rig = std::move(found->rig);
    return out;
  }();
  return waved;
}

calib::CalibrationReport wand_report(bool has_floor) {
  const CalibrationTarget target = kWand;
  return calib::report_calibration({"sample", "1.0", &target, 1.75, 10.0, has_floor},
                                   waved_among_scenery().rig);
}

TEST(WandReport, CountsStaticTagsAsNeitherWandNorFloor) {
  const calib::CalibrationReport report = wand_report(false);
  const auto& views = report.rig.views;
  ASSERT_TRUE(std::any_of(
      views.begin(), views.end(), [](const auto& view) { return view.stays; }));
  for (std::size_t c = 0; c < report.rig.cameras.size(); ++c) {
    int frames = 0;
    int corners = 0;
    for (const FrameDetections& frame : waved_among_scenery().seen[c].frames) {
      const auto tags = std::count_if(
          frame.tags.begin(), frame.tags.end(), [](const TagDetection& tag) {
            return tag.id < TagId{kScenery};
          });
      frames += tags > 0 ? 1 : 0;
      corners += 4 * static_cast<int>(tags);
    }
    std::set<int> cells;
    for (const calib::TargetView& view : views) {
      if (index(view.camera) != c || view.stays) continue;
      for (const calib::SeenCorner& corner : view.corners) {
        const auto& k = report.rig.cameras[c].intrinsics;
        cells.insert(8 * static_cast<int>(6.0 * double{corner.seen_px.y} / k.height_px) +
                     static_cast<int>(8.0 * double{corner.seen_px.x} / k.width_px));
      }
    }
    const CameraQuality& quality = report.rig.quality[c];
    EXPECT_EQ(quality.views, frames) << c;
    EXPECT_EQ(quality.corners, corners) << c;
    EXPECT_NEAR(quality.coverage, static_cast<double>(cells.size()) / 48.0, 1e-9) << c;
    const auto& counts = report.cameras[c].cells;
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), corners) << c;
    // Only kAskew has a large error of the floor tags; a finding of its own names it.
    EXPECT_EQ(report.cameras[c].floor_median_px > 6.0, c == kAskew) << c;
  }
  EXPECT_TRUE(
      std::any_of(report.findings.begin(), report.findings.end(), [](const auto& f) {
        return f.id == "scenery" && f.where == "camera cam2";
      }));
  for (const Finding& finding : report.findings) {
    EXPECT_NE(finding.id, "floor") << finding.cause;
    EXPECT_EQ((finding.where + finding.cause + finding.next).find("board"),
              std::string::npos)
        << finding.where << ": " << finding.cause << ": " << finding.next;
  }
}

TEST(WandReport, KnowsAFloorWithoutABoardOnIt) {
  const calib::CalibrationReport report = wand_report(true);
  EXPECT_TRUE(report.has_floor);
  EXPECT_FALSE(report.board_on_floor);
  const auto figures = calibration_json(report);
  EXPECT_TRUE(figures.at("has_floor").get<bool>());
  EXPECT_FALSE(figures.at("board_on_floor").get<bool>());
  EXPECT_EQ(report.map.height_names.front(), "ankle");
  EXPECT_EQ(wand_report(false).map.height_names.front(), "low");
}

}  // namespace
}  // namespace marey::app
