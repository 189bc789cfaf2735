// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/page_frame.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/count_allocations.h"

namespace marey::live {
namespace {

std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int v : values) out.push_back(static_cast<char>(v));
  return out;
}

/// 1 is 0x3f800000, as IEEE 754 has it; the least byte comes first.
const std::string kOne = bytes({0, 0, 0x80, 0x3f});
const std::string kZero = bytes({0, 0, 0, 0});
const std::string kHalf = bytes({0, 0, 0, 0x3f});
const std::string kTwo = bytes({0, 0, 0, 0x40});

TEST(PageFrame, HasTheBytesOfTheProtocol) {
  const Pose pose{{1.0, 2.0, 0.5}, {{1.0, 0.0, 0.0, 0.0}}};
  const std::array<JointUncertainty, 1> uncertainty{{{0.5, Source::kRepaired}}};
  const std::array<glm::dvec2, 1> support{{{2.0, 1.0}}};
  const std::array<PageFigure, 2> figures{{
      {.joints = 1,
       .pose = &pose,
       .uncertainty = uncertainty,
       .balance = PageBalance{{0.5, 1.0, 2.0}, support},
       .tracking = PageTracking{0.5, {true, false, false, true}}},
      {.joints = 25},
  }};
  std::string out = "kept ";
  append_frame({.frame = 0x01020304, .time_s = 1.0, .sent_s = 2.0, .figures = figures},
               out);
  EXPECT_EQ(out,
            "kept " + bytes({1, 1, 2, 0, 4, 3, 2, 1}) +       //
                bytes({0, 0, 0, 0, 0, 0, 0xf0, 0x3f}) +       // 1 as a double
                bytes({0, 0, 0, 0, 0, 0, 0, 0x40}) +          // 2
                bytes({15, 0, 1, 0}) + kOne + kTwo + kHalf +  // root
                kZero + kZero + kZero + kOne +                // x y z w
                kHalf + bytes({1, 0, 0, 0}) +                 // uncertainty, padded
                kHalf + kOne + kTwo + bytes({1, 0, 0, 0}) + kTwo + kOne +  // balance
                kHalf + bytes({9, 0, 0, 0}) +                              // tracking
                bytes({0, 0, 25, 0}));
}

TEST(PageFrame, HasTheZeroMomentPointAfterThePolygonWhereItIsDefined) {
  const std::array<glm::dvec2, 1> support{{{2.0, 1.0}}};
  std::array<PageFigure, 1> figures{
      {{.balance = PageBalance{{0.5, 1.0, 2.0}, support, glm::dvec2(0.5, 2.0)},
        .tracking = PageTracking{}}}};
  std::string out;
  append_frame({.figures = figures}, out);
  EXPECT_EQ(out.substr(24, 36),
            bytes({4 + 8 + 16, 0, 0, 0}) + kHalf + kOne + kTwo + bytes({1, 0, 0, 0}) +
                kTwo + kOne + kHalf + kTwo);
  figures[0].balance->zmp_xz_m.reset();
  std::string without;
  append_frame({.figures = figures}, without);
  EXPECT_EQ(without.size() + 8, out.size());
  EXPECT_EQ(without[24], 4 + 8);
}

TEST(PageFrame, IsLaidOutForTypedArrays) {
  for (std::size_t joints = 1; joints <= 9; ++joints) {
    const std::vector<JointUncertainty> uncertainty(joints);
    const std::array<PageFigure, 1> figures{
        {{.joints = joints, .uncertainty = uncertainty}}};
    std::string out;
    append_frame({.figures = figures}, out);
    EXPECT_EQ(out.size() % 4, 0U) << joints;
    EXPECT_EQ(out.size(), 24 + 4 + 4 * joints + 4 * ((joints + 3) / 4)) << joints;
  }
}

TEST(PageFrame, HoldsWhatNoFloatDoes) {
  const Pose pose{{1e300, -1e300, 0.0}, {}};
  const std::array<PageFigure, 1> figures{{{.pose = &pose}}};
  std::string out;
  append_frame({.figures = figures}, out);
  const float maximum = std::numeric_limits<float>::max();
  std::array<float, 2> got{};
  std::memcpy(got.data(), out.data() + 28, sizeof got);
  EXPECT_EQ(got[0], maximum);
  EXPECT_EQ(got[1], -maximum);
}

TEST(PageFrame, AllocatesNothingInABufferThatHasGrown) {
  Pose pose;
  pose.parent_from_joint.resize(25);
  const std::array<PageFigure, 1> figures{{{.joints = 25, .pose = &pose}}};
  std::string out;
  append_frame({.figures = figures}, out);
  const long before = testing::allocations();
  for (int i = 0; i < 10; ++i) {
    out.clear();
    append_frame({.figures = figures}, out);
  }
  EXPECT_EQ(testing::allocations(), before);
}

TEST(PageFrame, EncodesBlockHeadsByTheProtocol) {
  std::string out;
  append_motion_block_head(258, 3, out);
  EXPECT_EQ(out, "MRMB" + bytes({1, 0, 0, 0, 2, 1, 0, 0, 3, 0, 0, 0}));
}

TEST(PageFrame, PointsThatWereNotSeenAreNoNumbers) {
  MarkerTracks tracks;
  tracks.labels = {"a", "b"};
  tracks.samples = {
      MarkerSample{.p_in_world = {1.0, 2.0, 0.5}, .source = Source::kRepaired},
      std::nullopt};
  std::string out;
  append_point_block(tracks, out);
  EXPECT_EQ(out.substr(0, 16), "MRPB" + bytes({1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0}));
  EXPECT_EQ(out.substr(16, 16), kOne + kTwo + kHalf + bytes({1, 0, 0, 0}));
  ASSERT_EQ(out.size(), 48U);
  std::array<float, 3> nowhere{};
  std::memcpy(nowhere.data(), out.data() + 32, sizeof nowhere);
  for (const float x : nowhere) EXPECT_TRUE(std::isnan(x));
}

TEST(PageFrame, ThumbnailsCarryTheirTags) {
  TagDetection tag;
  tag.id = TagId{258};
  tag.corners_px = {{{1.0, 2.0}, {0.5, 0.0}, {1.0, 1.0}, {2.0, 2.0}}};
  const std::array<TagDetection, 1> tags{tag};
  std::string out;
  append_thumbnail(
      {.camera = 3, .width_px = 1280, .height_px = 720, .tags = tags, .jpeg = "jpeg"},
      out);
  EXPECT_EQ(out,
            bytes({2, 3, 0, 5, 0xd0, 2, 1, 0, 2, 1, 0, 0}) + kOne + kTwo + kHalf + kZero +
                kOne + kOne + kTwo + kTwo + "jpeg");
}

}  // namespace
}  // namespace marey::live
