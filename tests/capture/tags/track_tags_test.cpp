// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/track_tags.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "capture/video/frame_source.h"
#include "capture/video/open_frames.h"
#include "tests/capture/tag_artist.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/program/paths.h"

namespace marey::capture {
namespace {

namespace fs = std::filesystem;
using tests::DrawnTag;

constexpr int kWidth = 360;
constexpr int kHeight = 240;

constexpr int kPeriod = 24;

/// A tag of 40 px on a circle of kPeriod frames, at most 10 px a frame, rotating.
DrawnTag swinging(int id, int frame) {
  const double phase = 2.0 * std::numbers::pi * frame / kPeriod + id;
  return {"tag36h11",
          id,
          tests::square({(id == 5 ? 250.0 : 110.0) + 40.0 * std::sin(phase),
                         120.0 + 20.0 * std::cos(phase)},
                        40.0,
                        0.5 * std::sin(phase))};
}

GrayFrame numbered(const cv::Mat& image, int index) {
  GrayFrame frame = tests::frame_of(image);
  frame.index = index;
  return frame;
}

cv::Mat draw(const std::vector<DrawnTag>& tags) {
  return tests::disturbed(tests::draw_tags(kWidth, kHeight, tags), 0.5, 2.0, 5);
}

/// Tags 3 and 5 at a frame of their circle, drawn once, as drawing is slow.
const cv::Mat& round_of_two(int frame) {
  static std::map<int, cv::Mat> drawn;
  cv::Mat& image = drawn[frame % kPeriod];
  if (image.empty()) image = draw({swinging(3, frame), swinging(5, frame)});
  return image;
}

TEST(TrackTags, FindsTheTagsOfAFullSearch) {
  auto tracker = TagTracker::create();
  auto detector = TagDetector::create();
  ASSERT_TRUE(tracker && detector);
  int regions = 0;
  for (int f = 0; f < kPeriod; ++f) {
    const cv::Mat& image = round_of_two(f);
    const auto& tracked = tracker->track(numbered(image, f));
    const auto full = detector->detect(numbered(image, f));
    ASSERT_EQ(full.size(), 2U);
    ASSERT_EQ(tracked.size(), 2U) << f;
    EXPECT_LT(glm::distance(tracked[0].corners_px[0], full[0].corners_px[0]), 0.01) << f;
    EXPECT_LT(tests::worst_corner_px(tracked[0], swinging(3, f)), 0.15) << f;
    regions += tracker->last_search() == SearchKind::kRegions;
  }
  EXPECT_GE(regions, kPeriod / 3);
}

TEST(TrackTags, FindsALostTagAtItsPredictedPlace) {
  // Hidden for four frames, at 5 px a frame.
  TrackTagsOptions rarely;
  rarely.full_every_frames = 1000;
  rarely.body_every_frames = 1000;
  auto tracker = TagTracker::create(rarely);
  for (int f = 0; f < 16; ++f) {
    const bool hidden = f >= 6 && f < 10;
    const DrawnTag tag{"tag36h11", 9, tests::square({80.0 + 5.0 * f, 150.0}, 40.0)};
    const cv::Mat image = draw(hidden ? std::vector<DrawnTag>{} : std::vector{tag});
    const auto& found = tracker->track(numbered(image, f));
    EXPECT_EQ(found.size(), hidden ? 0U : 1U) << f;
  }
}

TEST(TrackTags, FindsANewTagOfTheSameBodyWithinTheBodyPeriod) {
  TrackTagsOptions options;
  options.full_every_frames = 1000;
  options.body_every_frames = 3;
  auto tracker = TagTracker::create(options);
  int first_seen = -1;
  for (int f = 0; f < 11; ++f) {
    std::vector<DrawnTag> tags{swinging(3, f),
                               {"tag36h11", 4, tests::square({290.0, 200.0}, 40.0)}};
    // Between the two, far from both.
    if (f >= 7) tags.push_back({"tag36h11", 5, tests::square({250.0, 100.0}, 30.0)});
    const cv::Mat image = draw(tags);
    const auto& found = tracker->track(numbered(image, f));
    if (found.size() == 3 && first_seen < 0) first_seen = f;
  }
  EXPECT_GE(first_seen, 7);
  EXPECT_LE(first_seen, 9);
}

TEST(TrackTags, FindsADistantTagInTheNextFullSearch) {
  TrackTagsOptions options;
  options.full_every_frames = 10;
  auto tracker = TagTracker::create(options);
  for (int f = 0; f < 14; ++f) {
    std::vector<DrawnTag> tags{{"tag36h11", 3, tests::square({60.0, 60.0}, 40.0)}};
    if (f >= 3) tags.push_back({"tag36h11", 5, tests::square({320.0, 200.0}, 40.0)});
    const cv::Mat image = draw(tags);
    const auto& found = tracker->track(numbered(image, f));
    EXPECT_EQ(found.size(), f >= 10 ? 2U : 1U) << f;
  }
}

TEST(TrackTags, LooksEverywhereOnceAllItFollowedHasLeft) {
  TrackTagsOptions options;
  options.remember_frames = 12;
  auto tracker = TagTracker::create(options);
  for (int f = 0; f < 9; ++f) {
    std::vector<DrawnTag> tags;
    if (f < 2) {
      const double x_px = kWidth - 55.0 + 24.0 * f;
      tags.push_back({"tag36h11", 3, tests::square({x_px, 60.0}, 40.0)});
    }
    // Predicted position of the first tag: 376 px and beyond.
    if (f == 8) tags.push_back({"tag36h11", 5, tests::square({60.0, 60.0}, 40.0)});
    const cv::Mat image = draw(tags);
    const auto& found = tracker->track(numbered(image, f));
    EXPECT_EQ(found.size(), tags.size()) << f;
  }
}

TEST(TrackTags, FindsADistantTagByStripsWithoutAFullSearch) {
  TrackTagsOptions options;
  options.full_every_frames = 10;
  options.strips = 5;
  auto tracker = TagTracker::create(options);
  int first_seen = -1;
  for (int f = 0; f < 15; ++f) {
    const DrawnTag here{"tag36h11", 3, tests::square({60.0, 60.0}, 30.0)};
    const DrawnTag far{"tag36h11", 5, tests::square({300.0, 190.0}, 30.0)};
    const cv::Mat image = draw(f < 3 ? std::vector{here} : std::vector{here, far});
    const auto& found = tracker->track(numbered(image, f));
    if (found.size() == 2 && first_seen < 0) first_seen = f;
    // Later the box around both is the whole image.
    if (first_seen < 0) {
      EXPECT_EQ(tracker->last_search() == SearchKind::kFull, f == 0) << f;
    }
  }
  EXPECT_GE(first_seen, 3);
  EXPECT_LE(first_seen, 13) << "its strip's turn comes once in ten frames";
}

TEST(TrackTags, SearchesByStripsWhileItHasNoTag) {
  TrackTagsOptions options;
  options.strips = 4;
  auto tracker = TagTracker::create(options);
  EXPECT_TRUE(tracker->track(numbered(draw({}), 0)).empty());
  const cv::Mat image =
      // Overlaps two strips.
      draw({{"tag36h11", 5, tests::square({180.0, 120.0}, 26.0)}});
  int first_seen = -1;
  for (int f = 1; f < 6 && first_seen < 0; ++f) {
    if (!tracker->track(numbered(image, f)).empty()) first_seen = f;
    EXPECT_NE(tracker->last_search(), SearchKind::kFull);
  }
  EXPECT_GE(first_seen, 1);
  EXPECT_LE(first_seen, 4);
}

TEST(TrackTags, FindsANewTagOfTheSameBodyByBands) {
  TrackTagsOptions options;
  options.full_every_frames = 1000;
  options.strips = 2;
  options.body_every_frames = 3;
  auto tracker = TagTracker::create(options);
  for (int f = 0; f < 11; ++f) {
    std::vector<DrawnTag> tags{{"tag36h11", 3, tests::square({90.0 + f, 50.0}, 24.0)},
                               {"tag36h11", 4, tests::square({180.0, 170.0}, 24.0)}};
    if (f >= 7) tags.push_back({"tag36h11", 5, tests::square({170.0, 60.0}, 24.0)});
    const cv::Mat image = draw(tags);
    const std::size_t found = tracker->track(numbered(image, f)).size();
    if (f < 7 || f >= 9) {
      EXPECT_EQ(found, tags.size()) << f;
    }
    EXPECT_EQ(tracker->last_search() == SearchKind::kFull, f == 0) << f;
  }
}

TEST(TrackTags, SearchesFasterAfterItLosesMostTags) {
  TrackTagsOptions options;
  options.full_every_frames = 600;
  options.strips = 12;
  auto tracker = TagTracker::create(options);
  constexpr int kJump = 4;
  for (int f = 0; f < kJump + 11; ++f) {
    const double left_px = f < kJump ? 40.0 : 250.0;
    std::vector<DrawnTag> tags;
    for (int i = 0; i < 4; ++i) {
      tags.push_back(
          {"tag36h11",
           i,
           tests::square({left_px + 55.0 * (i % 2), 60.0 + 90.0 * (i / 2)}, 24.0)});
    }
    const cv::Mat image = draw(tags);
    const std::size_t found = tracker->track(numbered(image, f)).size();
    // A regular cycle of the strips takes 600 frames.
    if (f < kJump || f == kJump + 10) {
      EXPECT_EQ(found, 4U) << f;
    }
    EXPECT_EQ(tracker->last_search() == SearchKind::kFull, f == 0) << f;
  }
}

TEST(TrackTags, SearchesAnImageFilledWithTagsAsAWhole) {
  // Nine tags all over the image: their boxes would cover all of it.
  std::vector<DrawnTag> tags;
  for (int i = 0; i < 9; ++i) {
    tags.push_back(
        {"tag36h11",
         i,
         tests::square({60.0 + 120.0 * (i % 3), 40.0 + 80.0 * (i / 3)}, 54.0)});
  }
  const cv::Mat image = draw(tags);
  auto tracker = TagTracker::create();
  for (int f = 0; f < 5; ++f) {
    EXPECT_EQ(tracker->track(numbered(image, f)).size(), 9U);
    EXPECT_EQ(tracker->last_search(), SearchKind::kFull);
  }
}

TEST(TrackTags, SearchesTheWholeImageWithoutTracks) {
  auto tracker = TagTracker::create();
  const cv::Mat empty = draw({});
  for (int f = 0; f < 3; ++f) {
    EXPECT_TRUE(tracker->track(numbered(empty, f)).empty());
    EXPECT_EQ(tracker->last_search(), SearchKind::kFull);
  }
  const cv::Mat image = draw({swinging(3, 3)});
  EXPECT_EQ(tracker->track(numbered(image, 3)).size(), 1U);
}

TEST(TrackTags, GivesTheSameTagsTwice) {
  std::vector<double> once;
  std::vector<double> again;
  for (std::vector<double>* out : {&once, &again}) {
    auto tracker = TagTracker::create();
    for (int f = 0; f < 12; ++f) {
      const cv::Mat& image = round_of_two(f);
      for (const TagDetection& tag : tracker->track(numbered(image, f))) {
        for (const auto& c : tag.corners_px) out->insert(out->end(), {c.x, c.y});
      }
    }
  }
  EXPECT_EQ(once, again);
}

TEST(TrackTags, AllocatesNothingOfItsOwnOnceWarm) {
  // libapriltag allocates with malloc; the test counts C++'s operator new.
  auto tracker = TagTracker::create();
  for (int f = 0; f < 2 * kPeriod; ++f) {
    (void)tracker->track(numbered(round_of_two(f), f));
  }
  const long before = testing::allocations();
  for (int f = 2 * kPeriod; f < 8 * kPeriod; ++f) {
    (void)tracker->track(numbered(round_of_two(f), f));
  }
  EXPECT_EQ(testing::allocations() - before, 0);
}

// Over whole trials 97 %, as measured by benchmarks/capture/measure_detection.cpp; this
// part, in which tags turn into view, has 95 %.
TEST(TrackTags, LosesLittleOfARenderedWalk) {
  const fs::path video = marey::testing::shared_data() / "blender/dev/walk/cam3.mp4";
  if (!fs::exists(video)) GTEST_SKIP() << "no rendered recordings at " << video;
  auto source = open_frames(video);
  ASSERT_TRUE(source);
  auto tracker = TagTracker::create();
  auto detector = TagDetector::create();
  int both = 0;
  int full = 0;
  for (int f = 0; f < 60; ++f) {
    auto frame = (*source)->next();
    ASSERT_TRUE(frame && *frame);
    std::map<TagId, TagDetection> by_id;
    for (const TagDetection& tag : detector->detect(**frame)) by_id[tag.id] = tag;
    full += static_cast<int>(by_id.size());
    for (const TagDetection& tag : tracker->track(**frame)) {
      const auto same = by_id.find(tag.id);
      if (same == by_id.end()) continue;
      ++both;
      EXPECT_LT(glm::distance(tag.corners_px[2], same->second.corners_px[2]), 0.1);
    }
  }
  EXPECT_GT(full, 400);
  EXPECT_GT(both, 0.93 * full);
}

}  // namespace
}  // namespace marey::capture
