// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tests whether the sigmas of a tag's corners match their errors, in drawn images.
#include "capture/tags/corner_sigma.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "capture/tags/align_pattern.h"
#include "capture/tags/detect_tags.h"
#include "tests/capture/tag_artist.h"

namespace marey::capture {
namespace {

using tests::DrawnTag;
using tests::Exposure;

const char* const kFamilies[] = {"tag36h11", "tagStandard41h12", "tagCircle21h7"};

struct Look {
  double side_px = 24.0;
  /// Along the pixels' rows; otherwise rotated and slanted at random.
  bool upright = true;
  double blur_px = 0.45;
  Exposure exposure;
};

/// Root mean squares over the corners' coordinates of several images.
struct CornerErrors {
  int corners = 0;
  double error_px = 0.0;
  double error_by_sigma = 0.0;
};

/// Returns the errors in images of one tag each; the place, rotation and noise of an
/// image depend on its number.
CornerErrors corner_errors(const std::string& family, const Look& look) {
  constexpr int kPictures = 4;
  auto detector = TagDetector::create({.families = {{family, {}}}});
  CornerErrors errors;
  for (int i = 0; i < kPictures; ++i) {
    cv::RNG random(static_cast<std::uint64_t>(100 + i));
    const int size_px = static_cast<int>(1.9 * look.side_px) + 30;
    const glm::dvec2 centre_px{0.5 * size_px + random.uniform(-0.5, 0.5),
                               0.5 * size_px + random.uniform(-0.5, 0.5)};
    const double turn_rad = random.uniform(0.2, 1.3);
    DrawnTag tag{family,
                 random.uniform(0, 30),
                 tests::square(centre_px, look.side_px, look.upright ? 0.0 : turn_rad)};
    for (auto& corner : tag.corners_px) {
      const glm::dvec2 slant{random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06)};
      if (!look.upright) corner += look.side_px * slant;
    }
    const cv::Mat image = tests::disturbed(tests::draw_tags(size_px, size_px, {tag}),
                                           look.blur_px,
                                           /*noise_sigma=*/2.0,
                                           static_cast<unsigned>(i + 1),
                                           look.exposure);
    for (const TagDetection& found : detector->detect(tests::frame_of(image))) {
      for (std::size_t c = 0; c < 4; ++c) {
        const glm::dvec2 error_px = found.corners_px[c] - tag.corners_px[c];
        const double square = 0.5 * glm::dot(error_px, error_px);
        ++errors.corners;
        errors.error_px += square;
        errors.error_by_sigma += square / (found.sigma_px * found.sigma_px);
      }
    }
  }
  errors.error_px = std::sqrt(errors.error_px / std::max(1, errors.corners));
  errors.error_by_sigma = std::sqrt(errors.error_by_sigma / std::max(1, errors.corners));
  return errors;
}

/// Expects that most tags are found, with corner errors of at most this value, and of at
/// most 1.5 times their sigma.
void expect_matching_sigma(const Look& look, double max_px) {
  for (const char* family : kFamilies) {
    const CornerErrors errors = corner_errors(family, look);
    const std::string what = std::string(family) + ", " + std::to_string(look.side_px) +
                             (look.upright ? " px, upright" : " px, turned");
    EXPECT_GE(errors.corners, 4) << what;
    EXPECT_LT(errors.error_px, max_px) << what;
    EXPECT_LT(errors.error_by_sigma, 1.5) << what;
  }
}

// Paper is twice as bright as the camera's maximum: if this is not modelled, white cells
// are too large by 0.2 to 0.8 px, and so is the tag.
TEST(CornerSigma, MatchesTheErrorsOfOverexposedTags) {
  for (const double side_px : {24.0, 60.0, 110.0}) {
    for (const bool upright : {false, true}) {
      expect_matching_sigma({side_px, upright, 0.45, {.gain = 2.0}}, 0.1 /* px */);
      expect_matching_sigma({side_px, upright, 0.8, {.gain = 2.0}}, 0.1 /* px */);
    }
  }
}

TEST(CornerSigma, MatchesTheErrorsOfOtherToneCurves) {
  for (const double side_px : {24.0, 60.0, 110.0}) {
    for (const double tone : {0.6, 1.5}) {
      expect_matching_sigma({side_px, false, 0.45, {.tone = tone}}, 0.05 /* px */);
      expect_matching_sigma({side_px, true, 0.45, {.tone = tone}}, 0.05 /* px */);
    }
  }
}

// As in a printer's preview: no lens blur, so that an edge is within one pixel.
TEST(CornerSigma, MatchesTheErrorsOfLargeSharpTags) {
  for (const double side_px : {80.0, 189.0}) {
    expect_matching_sigma({side_px, false, 0.0, {}}, 0.05 /* px */);
    expect_matching_sigma({side_px, true, 0.0, {}}, 0.1 /* px */);
  }
}

TEST(CornerSigma, FallsAsTagsGrow) {
  EXPECT_GT(edge_corner_sigma_px(14.0), edge_corner_sigma_px(58.0));
}

TEST(CornerSigma, GrowsWithNoiseBlurAndClipping) {
  const double usual = aligned_corner_sigma_px(0.03, 0.05, 0.5, 0.8);
  EXPECT_GT(aligned_corner_sigma_px(0.05, 0.08, 0.5, 0.8), 1.5 * usual);
  EXPECT_GT(aligned_corner_sigma_px(0.03, 0.05, 2.0, 0.8), 1.5 * usual);
  EXPECT_GT(aligned_corner_sigma_px(0.03, 0.05, 0.5, 1.5), 1.5 * usual);
}

}  // namespace
}  // namespace marey::capture
