// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/align_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/capture/tag_artist.h"

namespace marey::capture {
namespace {

using Corners = std::array<glm::dvec2, 4>;
using tests::DrawnTag;

/// A tag of 24 px, slanted and rotated: 3 px a cell, typical of tags on a body.
DrawnTag small_tag() {
  return {"tag36h11", 17, {{{41.3, 60.2}, {65.9, 57.4}, {63.6, 35.7}, {39.8, 37.5}}}};
}

Corners displaced(Corners corners) {
  constexpr std::array<glm::dvec2, 4> kBy{
      {{0.7, -0.5}, {-0.8, 0.3}, {0.4, 0.6}, {0.2, -0.9}}};
  for (std::size_t i = 0; i < 4; ++i) corners[i] += kBy[i];
  return corners;
}

double worst_px(const Corners& a, const Corners& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, glm::distance(a[i], b[i]));
  return worst;
}

std::optional<Alignment> align(const cv::Mat& image, const DrawnTag& tag) {
  AlignScratch scratch;
  return align_pattern(tests::frame_of(image),
                       tests::pattern_of(tag),
                       displaced(tag.corners_px),
                       /*slack_px=*/1.0,
                       scratch);
}

// 0.04 px: the drawing has 8 steps to a pixel and the image 256 greys.
TEST(AlignPattern, RecoversTheCornersOfASmallTag) {
  const DrawnTag tag = small_tag();
  const auto found = align(tests::draw_tags(110, 100, {tag}), tag);
  ASSERT_TRUE(found);
  EXPECT_LT(worst_px(found->corners_px, tag.corners_px), 0.04 /* px */);
}

// 0.15 px: the effect of 3 grey levels of noise on the worst of four corners. Without the
// blur among the unknowns, or with grey values instead of light, the tag would appear
// smaller.
TEST(AlignPattern, RecoversThemUnderBlurAndNoise) {
  const DrawnTag tag = small_tag();
  for (const double blur_px : {0.4, 0.8, 1.2}) {
    const cv::Mat image =
        tests::disturbed(tests::draw_tags(110, 100, {tag}), blur_px, 3.0, /*seed=*/5);
    const auto found = align(image, tag);
    ASSERT_TRUE(found) << blur_px;
    EXPECT_LT(worst_px(found->corners_px, tag.corners_px), 0.15 /* px */) << blur_px;
  }
}

// A pixel is a box of standard deviation 1 / sqrt(12) px.
TEST(AlignPattern, MeasuresTheBlur) {
  const DrawnTag tag = small_tag();
  const cv::Mat image =
      tests::disturbed(tests::draw_tags(110, 100, {tag}), 1.0, 1.0, /*seed=*/5);
  const auto found = align(image, tag);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->blur_px, std::sqrt(1.0 + 1.0 / 12.0), 0.05 /* px */);
}

TEST(AlignPattern, IgnoresAShadowOverTheTag) {
  const DrawnTag tag = small_tag();
  cv::Mat image = tests::draw_tags(110, 100, {tag});
  for (int x = 0; x < image.cols; ++x) {
    image.col(x) *= 0.6 + 0.4 * x / image.cols;
  }
  const auto found = align(image, tag);
  ASSERT_TRUE(found);
  EXPECT_LT(worst_px(found->corners_px, tag.corners_px), 0.1 /* px */);
}

// 2.5 px off, half a cell, is found, but exceeds the possible error of a search along
// edges.
TEST(AlignPattern, DeclinesToMoveCornersFurtherThanTheyCanBeOff) {
  const DrawnTag tag{"tag36h11", 17, tests::square({60.0, 60.0}, 44.0, 0.3)};
  const cv::Mat image = tests::disturbed(tests::draw_tags(120, 120, {tag}), 0.5, 1.0, 5);
  Corners start = tag.corners_px;
  for (auto& corner : start) corner.x += 2.5;
  AlignScratch scratch;
  const TagPattern pattern = tests::pattern_of(tag);
  EXPECT_TRUE(align_pattern(tests::frame_of(image), pattern, start, 3.0, scratch));
  EXPECT_FALSE(align_pattern(tests::frame_of(image), pattern, start, 1.0, scratch));
}

TEST(AlignPattern, DeclinesAnImageWithoutTheTag) {
  const DrawnTag tag = small_tag();
  EXPECT_FALSE(align(cv::Mat(100, 110, CV_8UC1, cv::Scalar(128)), tag));
}

TEST(AlignPattern, DeclinesAnotherTagsImage) {
  const DrawnTag tag = small_tag();
  DrawnTag other = tag;
  other.id = 3;
  EXPECT_FALSE(align(tests::draw_tags(110, 100, {other}), tag));
}

TEST(AlignPattern, DeclinesATagOutsideTheImage) {
  const DrawnTag tag = small_tag();
  EXPECT_FALSE(align(cv::Mat(20, 20, CV_8UC1, cv::Scalar(128)), tag));
}

}  // namespace
}  // namespace marey::capture
