// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/detect_tags.h"

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "capture/tags/tag_pattern.h"
#include "core/tag_family.h"
#include "tests/capture/tag_artist.h"

namespace marey::capture {
namespace {

using tests::DrawnTag;

TagDetector detector(const TagDetectorOptions& options = {}) {
  auto made = TagDetector::create(options);
  EXPECT_TRUE(made) << made.error().message();
  return std::move(*made);
}

std::vector<TagDetection> detect(const cv::Mat& image,
                                 const TagDetectorOptions& options = {}) {
  return detector(options).detect(tests::frame_of(image));
}

/// A tag seen from the side and from above, 60 px wide.
DrawnTag slanted_tag() {
  return {
      "tag36h11", 7, {{{131.3, 158.2}, {186.9, 149.4}, {181.6, 96.7}, {127.8, 101.5}}}};
}

// 0.05 px: the image has 256 greys, and the drawing 8 steps to a pixel.
TEST(DetectTags, FindsTheCornersOfASlantedTag) {
  const DrawnTag truth = slanted_tag();
  const auto found = detect(tests::draw_tags(320, 240, {truth}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(number(found[0].id), 7);
  EXPECT_LT(tests::worst_corner_px(found[0], truth), 0.05 /* px */);
}

// 0.5 px: libapriltag's own edge search, which blur biases inward.
TEST(DetectTags, FindsCornersRoughlyWithoutAligningThePattern) {
  const DrawnTag truth = slanted_tag();
  const auto found =
      detect(tests::draw_tags(320, 240, {truth}), {.align_patterns = false});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(tests::worst_corner_px(found[0], truth), 0.5 /* px */);
}

// Verifies the half pixel between libapriltag's coordinates and ours: a mean over many
// positions in the pixel, in which the edge search's own errors cancel.
TEST(DetectTags, PutsPixelCentresAtIntegers) {
  glm::dvec2 sum{0.0};
  int count = 0;
  for (int i = 0; i < 16; ++i) {
    const double shift = i / 16.0;
    const DrawnTag truth{
        "tag36h11", 3, tests::square({100.0 + shift, 90.0 + 3.0 * shift}, 48.0, 0.4 * i)};
    const auto found = detect(tests::draw_tags(200, 180, {truth}));
    ASSERT_EQ(found.size(), 1U);
    for (std::size_t c = 0; c < 4; ++c) {
      sum += found[0].corners_px[c] - truth.corners_px[c];
      ++count;
    }
  }
  EXPECT_NEAR(sum.x / count, 0.0, 0.03 /* px */);
  EXPECT_NEAR(sum.y / count, 0.0, 0.03 /* px */);
}

TEST(DetectTags, KeepsTheOrderOfCornersWhenTheTagIsTurned) {
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double turn_rad = 0.3 + quarter * std::numbers::pi / 2;
    const DrawnTag truth{"tag36h11", 12, tests::square({120.0, 110.0}, 60.0, turn_rad)};
    const auto found = detect(tests::draw_tags(240, 220, {truth}));
    ASSERT_EQ(found.size(), 1U) << "turned by " << turn_rad;
    EXPECT_LT(tests::worst_corner_px(found[0], truth), 0.3 /* px */);
  }
}

// Three times the sigma on each of two coordinates.
TEST(DetectTags, FindsCornersWithinTheirSigmasUnderBlurAndNoise) {
  const DrawnTag truth = slanted_tag();
  const cv::Mat image =
      tests::disturbed(tests::draw_tags(320, 240, {truth}), 0.6, 3.0, /*seed=*/1);
  const auto found = detect(image);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(tests::worst_corner_px(found[0], truth), 3.0 * found[0].sigma_px * 1.42);
}

TEST(DetectTags, KnowsEveryFamilyThatASessionMayName) {
  for (const KnownFamily& known : kTagFamilies) {
    const std::string family(known.name);
    const auto shape = tag_family_shape(family);
    ASSERT_TRUE(shape) << family;
    EXPECT_EQ(shape->tag_count, known.tags) << family;
    const DrawnTag truth{family, 5, tests::square({120.2, 99.7}, 60.0, 0.2)};
    const auto found =
        detect(tests::draw_tags(240, 200, {truth}), {.families = {{family, {}}}});
    ASSERT_EQ(found.size(), 1U) << family;
    EXPECT_EQ(number(found[0].id), 5) << family;
    EXPECT_LT(tests::worst_corner_px(found[0], truth), 0.3 /* px */) << family;
  }
}

TEST(DetectTags, KnowsWhichFamilysIdsAreWorn) {
  const tests::DrawnTag board{"tag36h11", 3, tests::square({70.0, 100.0}, 60.0)};
  const tests::DrawnTag body{"tag25h9", 7, tests::square({200.0, 100.0}, 60.0)};
  const tests::DrawnTag stranger{"tag25h9", 8, tests::square({330.0, 100.0}, 60.0)};
  const auto found =
      detect(tests::draw_tags(400, 200, {board, body, stranger}),
             {.families = {{"tag36h11", {TagId{3}, TagId{4}}}, {"tag25h9", {TagId{7}}}}});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_LT(tests::worst_corner_px(found[0], board), 0.1);
  EXPECT_LT(tests::worst_corner_px(found[1], body), 0.1);
}

TEST(DetectTags, RefusesAnIdThatTwoFamiliesShare) {
  const auto made = TagDetector::create(
      {.families = {{"tag36h11", {TagId{3}}}, {"tag25h9", {TagId{3}}}}});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Errc::kBadInput);
  EXPECT_FALSE(TagDetector::create({.families = {{"tag36h11", {}}, {"tag25h9", {}}}}));
}

// libapriltag 3.3 shifts corners from a decimated image by half a pixel; the alignment on
// the whole image converges from this start.
TEST(DetectTags, FindsTheSameCornersInADecimatedImage) {
  const tests::DrawnTag truth{"tag36h11", 5, tests::square({110.3, 90.7}, 72.0, 0.3)};
  const cv::Mat image =
      tests::disturbed(tests::draw_tags(240, 200, {truth}), 0.5, 2.0, 11);
  for (const double decimate : {1.5, 2.0, 3.0}) {
    const auto found = detect(image, {.quad_decimate = decimate});
    ASSERT_EQ(found.size(), 1U) << decimate;
    EXPECT_LT(tests::worst_corner_px(found[0], truth), 0.1 /* px */) << decimate;
  }
}

TEST(DetectTags, SortsTagsById) {
  const auto found =
      detect(tests::draw_tags(400,
                              140,
                              {{"tag36h11", 20, tests::square({70.0, 70.0}, 50.0)},
                               {"tag36h11", 4, tests::square({330.0, 70.0}, 50.0)},
                               {"tag36h11", 11, tests::square({200.0, 70.0}, 50.0)}}));
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(number(found[0].id), 4);
  EXPECT_EQ(number(found[1].id), 11);
  EXPECT_EQ(number(found[2].id), 20);
}

TEST(DetectTags, DropsAnIdThatIsInTheImageTwice) {
  const cv::Mat image =
      tests::draw_tags(400,
                       140,
                       {{"tag36h11", 4, tests::square({70.0, 70.0}, 50.0)},
                        {"tag36h11", 4, tests::square({330.0, 70.0}, 50.0)},
                        {"tag36h11", 11, tests::square({200.0, 70.0}, 50.0)}});
  TagDetector one = detector();
  const auto found = one.detect(tests::frame_of(image));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(number(found[0].id), 11);
  EXPECT_EQ(one.dropped().duplicated, 2);
}

TEST(DetectTags, FindsTheCornersOfLargeTagsJustAsWell) {
  for (const double side : {80.0, 120.0, 200.0}) {
    const tests::DrawnTag tag{"tag36h11", 4, tests::square({160.3, 150.6}, side, 0.2)};
    const auto found =
        detect(tests::disturbed(tests::draw_tags(320, 300, {tag}), 0.5, 2.0, 3));
    ASSERT_EQ(found.size(), 1U) << side;
    EXPECT_LT(tests::worst_corner_px(found[0], tag), 0.1 /* px */) << side;
  }
}

/// Returns the tag with one inverted cell of its code.
cv::Mat with_a_wrong_bit(cv::Mat image, const glm::dvec2& centre_px, double side_px) {
  // Cells are an eighth of the black square; the code's are the inner six by six.
  const double cell = side_px / 8.0;
  const cv::Rect at(static_cast<int>(centre_px.x - 2.0 * cell) + 1,
                    static_cast<int>(centre_px.y - 2.0 * cell) + 1,
                    static_cast<int>(cell) - 1,
                    static_cast<int>(cell) - 1);
  const bool white = cv::mean(image(at))[0] > 128;
  image(at).setTo(white ? 0 : 235);
  return image;
}

TEST(DetectTags, DoublesTheSigmaOfACorrectedCode) {
  const tests::DrawnTag tag{"tag36h11", 4, tests::square({80.0, 80.0}, 64.0)};
  const cv::Mat image = tests::draw_tags(160, 160, {tag});
  const auto whole = detect(tests::disturbed(image, 0.5, 1.0, 3));
  const auto corrected = detect(
      tests::disturbed(with_a_wrong_bit(image.clone(), {80.0, 80.0}, 64.0), 0.5, 1.0, 3));
  ASSERT_EQ(whole.size(), 1U);
  ASSERT_EQ(corrected.size(), 1U);
  EXPECT_EQ(corrected[0].hamming, 1);
  EXPECT_GT(corrected[0].sigma_px, 1.8 * whole[0].sigma_px);
}

TEST(DetectTags, KeepsOfTwoTheOneThatNeededNoCorrection) {
  const tests::DrawnTag sure{"tag36h11", 4, tests::square({80.0, 80.0}, 64.0)};
  const tests::DrawnTag corrected{"tag36h11", 4, tests::square({240.0, 80.0}, 64.0)};
  const cv::Mat image = tests::disturbed(
      with_a_wrong_bit(
          tests::draw_tags(320, 160, {sure, corrected}), {240.0, 80.0}, 64.0),
      0.5,
      1.0,
      3);
  auto detector = TagDetector::create();
  const auto found = detector->detect(tests::frame_of(image));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(tests::worst_corner_px(found[0], sure), 0.1);
  EXPECT_EQ(detector->dropped().duplicated, 1);
}

TEST(DetectTags, DropsSightingsBelowTheAskedMargin) {
  TagDetector strict = detector({.min_decision_margin = 1000.0});
  const cv::Mat image = tests::draw_tags(320, 240, {slanted_tag()});
  EXPECT_TRUE(strict.detect(tests::frame_of(image)).empty());
  EXPECT_EQ(strict.dropped().unsure, 1);
}

TEST(DetectTags, FindsNothingInAnEmptyImage) {
  EXPECT_TRUE(detect(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128))).empty());
}

TEST(DetectTags, FindsNothingInAnImageTooSmallForATag) {
  EXPECT_TRUE(detect(cv::Mat(3, 5, CV_8UC1, cv::Scalar(128))).empty());
}

TEST(DetectTags, ReadsPartOfALargerImageThroughItsStride) {
  DrawnTag truth = slanted_tag();
  const cv::Mat image = tests::draw_tags(320, 240, {truth});
  const auto found = detect(image(cv::Rect(90, 60, 130, 130)));
  ASSERT_EQ(found.size(), 1U);
  for (auto& corner : truth.corners_px) corner -= glm::dvec2(90.0, 60.0);
  EXPECT_LT(tests::worst_corner_px(found[0], truth), 0.15 /* px */);
}

TEST(DetectTags, GivesTheSameAnswerAfterBeingMoved) {
  const cv::Mat image = tests::draw_tags(320, 240, {slanted_tag()});
  TagDetector first = detector();
  const auto before = first.detect(tests::frame_of(image));
  TagDetector second = std::move(first);
  const auto after = second.detect(tests::frame_of(image));
  ASSERT_EQ(before.size(), 1U);
  ASSERT_EQ(after.size(), 1U);
  EXPECT_EQ(before[0].corners_px, after[0].corners_px);
}

TEST(DetectTags, RefusesAnUnknownFamilyAndNamesTheKnownOnes) {
  const auto made = TagDetector::create({.families = {{"tag36h12", {}}}});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Errc::kBadInput);
  EXPECT_EQ(made.error().cause, "\"tag36h12\" is not known");
  EXPECT_NE(made.error().next.find("tag36h11"), std::string::npos);
}

TEST(DetectTags, RefusesToForgiveManyBits) {
  const auto made = TagDetector::create({.max_hamming = 3});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().cause, "max_hamming must be 0, 1 or 2");
}

}  // namespace
}  // namespace marey::capture
