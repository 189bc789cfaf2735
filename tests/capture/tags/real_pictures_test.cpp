// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Photographs by other projects, with their reference detections.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "capture/tags/detect_tags.h"
#include "tests/capture/tag_artist.h"
#include "tests/support/program/paths.h"

namespace marey::capture {
namespace {

namespace fs = std::filesystem;
const fs::path kCamera = marey::testing::shared_data() / "camera";

std::vector<TagDetection> all_in(const cv::Mat& image,
                                 const TagDetectorOptions& options) {
  auto detector = TagDetector::create(options);
  EXPECT_TRUE(detector);
  std::vector<TagDetection> found;
  detector->search(tests::frame_of(image), {0, 0, image.cols, image.rows}, found);
  return found;
}

struct ExpectedTag {
  int id = 0;
  std::array<glm::dvec2, 4> corners_px{};
};

std::vector<ExpectedTag> read_expected(const fs::path& path) {
  std::vector<ExpectedTag> tags;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    ExpectedTag tag;
    auto& c = tag.corners_px;
    if (std::sscanf(line.c_str(),
                    "%d, (%lf %lf), (%lf %lf), (%lf %lf), (%lf %lf)",
                    &tag.id,
                    &c[0].x,
                    &c[0].y,
                    &c[1].x,
                    &c[1].y,
                    &c[2].x,
                    &c[2].y,
                    &c[3].x,
                    &c[3].y) == 9) {
      tags.push_back(tag);
    }
  }
  return tags;
}

/// Returns the distance to the expected tag's farthest corner, corners in their order.
double farthest_px(const TagDetection& tag, const ExpectedTag& expected) {
  double worst = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    // libapriltag's own convention: pixel centres at one half.
    worst =
        std::max(worst, glm::distance(tag.corners_px[i] + 0.5, expected.corners_px[i]));
  }
  return worst;
}

// Upstream's own regression data: corners before any refinement, so refinement is
// disabled here.
TEST(RealPictures, HaveTheCornersThatUpstreamExpects) {
  const fs::path folder = kCamera / "apriltag/test/data";
  if (!fs::exists(folder)) GTEST_SKIP() << "no pictures at " << folder;
  int expected_tags = 0;
  int reproduced = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".txt") continue;
    fs::path picture = entry.path();
    picture.replace_extension(".jpg");
    const cv::Mat image = cv::imread(picture.string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(image.empty()) << picture;
    TagDetectorOptions options;
    options.max_hamming = 2;
    options.min_decision_margin = 0.0;
    options.refine_edges = false;
    options.align_patterns = false;
    const auto found = all_in(image, options);
    for (const ExpectedTag& tag : read_expected(entry.path())) {
      ++expected_tags;
      double nearest = std::numeric_limits<double>::infinity();
      for (const TagDetection& candidate : found) {
        if (number(candidate.id) != tag.id) continue;
        nearest = std::min(nearest, farthest_px(candidate, tag));
      }
      EXPECT_LT(nearest, 0.5 /* px */) << picture.filename() << " id " << tag.id;
      reproduced += nearest < 0.5;
    }
  }
  EXPECT_GT(expected_tags, 30);
  EXPECT_EQ(reproduced, expected_tags);
}

// Kalibr's boards: 6 x 6 through a drone's and a fisheye lens, two of them at once, and
// 6 x 11 on a screen.
TEST(RealPictures, ContainAllTagsOfKalibrBoards) {
  const fs::path folder = kCamera / "aprilgrid_rs";
  if (!fs::exists(folder)) GTEST_SKIP() << "no pictures at " << folder;
  struct Picture {
    const char* name;
    std::size_t tags;
  };
  for (const Picture& picture : {Picture{"EuRoC.png", 36},
                                 {"TUM_VI.png", 36},
                                 {"two_boards.png", 72},
                                 {"iphone.png", 66}}) {
    const cv::Mat image =
        cv::imread((folder / picture.name).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(image.empty()) << picture.name;
    auto detector = TagDetector::create({.families = {{"tag36h11b2", {}}},
                                         .max_hamming = 2,
                                         .min_decision_margin = 10.0});
    ASSERT_TRUE(detector);
    const auto found = detector->detect(tests::frame_of(image));
    std::string ids;
    for (const TagDetection& t : found)
      ids.append(std::to_string(number(t.id))).append(" ");
    ASSERT_EQ(found.size(), picture.tags)
        << picture.name << ":" << ids << ", doubled " << detector->dropped().duplicated
        << ", unsure " << detector->dropped().unsure;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(number(found[i].id), static_cast<int>(i)) << picture.name;
    }
  }
}

}  // namespace
}  // namespace marey::capture
