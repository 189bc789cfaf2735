// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/rendered_truth.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "capture/search/detect_videos.h"
#include "core/base/frame_range.h"
#include "tests/support/program/paths.h"

namespace marey::capture {
namespace {

namespace fs = std::filesystem;
using tests::CornerResidual;

const fs::path kRendered = marey::testing::shared_data() / "blender/dev";

/// Returns the residuals of the first frames of all cameras of a session.
std::vector<CornerResidual> residuals_of(const std::string& session, int frames) {
  const auto truth = tests::load_rendered_truth(kRendered / session);
  std::vector<CameraInput> inputs;
  for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
    CameraInput input;
    input.path = truth.video(i);
    input.camera = CameraId{static_cast<int>(i)};
    input.range = FrameRange{0, frames - 1};
    inputs.push_back(input);
  }
  const auto found = detect_tags_in_videos(inputs);
  EXPECT_TRUE(found) << found.error().message();
  std::vector<CornerResidual> all;
  for (std::size_t i = 0; found && i < found->size(); ++i) {
    const auto some = tests::residuals(truth, i, (*found)[i]);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

/// Returns the root mean square of a coordinate of the residuals. [px]
double rms_px(const std::vector<CornerResidual>& residuals) {
  double sum = 0.0;
  for (const auto& r : residuals) sum += dot(r.error_px, r.error_px);
  return std::sqrt(sum / (2.0 * static_cast<double>(residuals.size())));
}

class RenderedBody : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kRendered)) {
      GTEST_SKIP() << "no rendered recordings at " << kRendered;
    }
  }
};

// Measured: 0.09 px on the body, 0.07 px on the board. libapriltag alone: 0.18 and 0.22.
TEST_F(RenderedBody, HasItsCornersWhereTheDetectorFindsThem) {
  const auto all = residuals_of("rom", 12);
  ASSERT_GT(all.size(), 800U);
  EXPECT_LT(rms_px(all), 0.12 /* px */);
}

TEST_F(RenderedBody, HasItsBoardWhereTheDetectorFindsIt) {
  const auto all = residuals_of("calib", 12);
  ASSERT_GT(all.size(), 800U);
  EXPECT_LT(rms_px(all), 0.12 /* px */);
}

// A fit of the whole pattern has no inward bias: 0.05 px a corner is 0.3 % of a tag's
// size.
TEST_F(RenderedBody, IsNotShrunkByTheDetector) {
  const auto all = residuals_of("rom", 12);
  double outward_px = 0.0;
  for (const auto& r : all) {
    outward_px += dot(r.error_px, r.outward_px) / static_cast<double>(all.size());
  }
  EXPECT_NEAR(outward_px, 0.0, 0.05 /* px */);
}

// A common bias of all tags would shift the whole reconstruction. 1280 px / 0.03 px is
// 0.1 mm at 3 m.
TEST_F(RenderedBody, IsNotShiftedByTheDetector) {
  const auto all = residuals_of("rom", 12);
  glm::dvec2 mean{0.0};
  for (const auto& r : all) mean += r.error_px / static_cast<double>(all.size());
  EXPECT_NEAR(mean.x, 0.0, 0.03 /* px */);
  EXPECT_NEAR(mean.y, 0.0, 0.03 /* px */);
}

}  // namespace
}  // namespace marey::capture
