// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/calibrate_cameras.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calib/model/board_views.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::BoardRecording;
using marey::testing::Disturbance;
using marey::testing::names_of;
using marey::testing::ring_of_cameras;
using marey::testing::wave_board;

const AprilGrid kBoard{6, 6, 0.1, 0.03, 0, 0.005};
constexpr int kFrames = 60;

Result<CalibratedRig> calibrate_from_board(const std::vector<Camera>& cameras,
                                           const Disturbance& disturbance) {
  const BoardRecording recording = wave_board(cameras, kBoard, kFrames, disturbance);
  return calibrate_cameras(names_of(cameras), recording.waved, recording.floor, kBoard);
}

struct Worst {
  double centre_m = 0.0;
  double turn_rad = 0.0;
  double focal = 0.0;  ///< Relative.
};

Worst compare(const CalibratedRig& rig, const std::vector<Camera>& truth) {
  Worst worst;
  for (std::size_t c = 0; c < truth.size(); ++c) {
    const Camera& found = rig.cameras[c];
    worst.centre_m = std::max(
        worst.centre_m, glm::distance(centre_in_world(found), centre_in_world(truth[c])));
    worst.turn_rad = std::max(
        worst.turn_rad,
        glm::length(rotation_vector(glm::conjugate(found.camera_from_world.rotation) *
                                    truth[c].camera_from_world.rotation)));
    for (int i = 0; i < 2; ++i) {
      const double ratio = found.intrinsics.focal_px[i] / truth[c].intrinsics.focal_px[i];
      worst.focal = std::max(worst.focal, std::abs(ratio - 1.0));
    }
  }
  return worst;
}

// The priors (a principal point near the middle, mild distortion) bias even exact
// corners: by a hundredth of a pixel, which is 1e-5 rad and, at the distance of the
// board, 1e-5 m.
constexpr double kExact_m = 1e-5;
constexpr double kExact_rad = 3e-5;
constexpr double kExactFocal = 1e-5;
// A fifth of a pixel over sixty frames determines the focal length to a thousandth, and a
// thousandth of the 3.4 m to the middle is 3.4 mm.
constexpr double kNoisy_m = 4e-3;

TEST(CalibrateCameras, RecoversTheRigFromExactCorners) {
  const auto cameras = ring_of_cameras();
  const auto rig = calibrate_from_board(cameras, {});
  ASSERT_TRUE(rig) << rig.error().message();
  const Worst worst = compare(*rig, cameras);
  EXPECT_LT(worst.centre_m, kExact_m);
  EXPECT_LT(worst.turn_rad, kExact_rad);
  EXPECT_LT(worst.focal, kExactFocal);
  EXPECT_LT(rig->rms_px, 1e-3 /* px; the same pull, spread over the corners */);
}

TEST(CalibrateCameras, StaysNearTheRigUnderNoise) {
  const auto cameras = ring_of_cameras();
  const auto rig = calibrate_from_board(cameras, {0.2, {}, 0.0});
  ASSERT_TRUE(rig) << rig.error().message();
  const Worst worst = compare(*rig, cameras);
  EXPECT_LT(worst.centre_m, kNoisy_m);
  EXPECT_LT(worst.focal, 1e-3);
  // Two coordinates of 0.2 px each, minus a small part that the fit absorbs.
  EXPECT_NEAR(rig->rms_px, 0.28, 0.01);
}

TEST(CalibrateCameras, ReturnsSigmasThatMatchItsErrors) {
  const auto cameras = ring_of_cameras();
  const auto rig = calibrate_from_board(cameras, {0.2, {}, 0.0});
  ASSERT_TRUE(rig) << rig.error().message();
  double sum = 0.0;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const double off_m =
        glm::distance(centre_in_world(rig->cameras[c]), centre_in_world(cameras[c]));
    const double in_sigmas = off_m / (std::sqrt(3.0) * rig->quality[c].centre_sigma_m);
    sum += in_sigmas * in_sigmas;
    const double focal_off_px =
        rig->cameras[c].intrinsics.focal_px.x - cameras[c].intrinsics.focal_px.x;
    EXPECT_LT(std::abs(focal_off_px), 3.0 * rig->quality[c].focal_sigma_px);
  }
  // A value of one is correct for noise of the assumed 0.3 px. This noise is two thirds
  // of that, without a part common to all corners as in real lenses and prints, and four
  // cameras with correlated errors give a rough mean.
  const double rms_in_sigmas = std::sqrt(sum / 4.0);
  EXPECT_GT(rms_in_sigmas, 0.1);
  EXPECT_LT(rms_in_sigmas, 1.5);
}

TEST(CalibrateCameras, MeasuresHowMuchTagsShrink) {
  const auto cameras = ring_of_cameras();
  const auto rig = calibrate_from_board(cameras, {0.0, {0.6, 0.01}, 0.0});
  ASSERT_TRUE(rig) << rig.error().message();
  for (const Camera& camera : rig->cameras) {
    // The prior (zero with a sigma of half a pixel) has a small effect.
    EXPECT_NEAR(camera.tag_shrinkage.offset_px, 0.6, 3e-3);
    EXPECT_NEAR(camera.tag_shrinkage.slope, 0.01, 1e-4);
  }
}

TEST(CalibrateCameras, RecoversTheRigThroughTagsThatShrink) {
  const auto cameras = ring_of_cameras();
  const auto rig = calibrate_from_board(cameras, {0.0, {0.6, 0.01}, 0.0});
  ASSERT_TRUE(rig) << rig.error().message();
  const Worst worst = compare(*rig, cameras);
  EXPECT_LT(worst.centre_m, 2.0 * kExact_m);
  EXPECT_LT(worst.focal, kExactFocal);
}

TEST(CalibrateCameras, KeepsItsAccuracyWithWrongTags) {
  // One tag in twenty is 20 px off: plain least squares would have errors of centimetres.
  const auto cameras = ring_of_cameras();
  const auto rig = calibrate_from_board(cameras, {0.2, {}, 0.05});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_LT(compare(*rig, cameras).centre_m, kNoisy_m);
}

TEST(CalibrateCameras, IncludesWrongTagsInItsRms) {
  const auto cameras = ring_of_cameras();
  const auto rig = calibrate_from_board(cameras, {0.2, {}, 0.05});
  ASSERT_TRUE(rig) << rig.error().message();
  // sqrt(0.05) of 20 px; the median remains at 1.18 times 0.2 px.
  EXPECT_NEAR(rig->rms_px, 4.47, 0.6);
  EXPECT_NEAR(rig->median_px, 0.24, 0.03);
}

TEST(CalibrateCameras, GivesTheSameBytesTwice) {
  const auto cameras = ring_of_cameras();
  const auto once = calibrate_from_board(cameras, {0.2, {}, 0.0});
  const auto again = calibrate_from_board(cameras, {0.2, {}, 0.0});
  ASSERT_TRUE(once && again);
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    EXPECT_EQ(once->cameras[c].intrinsics.parameters(),
              again->cameras[c].intrinsics.parameters());
    EXPECT_EQ(once->cameras[c].camera_from_world.translation,
              again->cameras[c].camera_from_world.translation);
  }
}

TEST(CalibrateCameras, CountsTheViewsOfEachCamera) {
  const auto cameras = ring_of_cameras();
  const BoardRecording recording = wave_board(cameras, kBoard, kFrames);
  const auto rig =
      calibrate_cameras(names_of(cameras), recording.waved, recording.floor, kBoard);
  ASSERT_TRUE(rig) << rig.error().message();
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    int views = 1;  // The floor.
    int corners = 4 * static_cast<int>(recording.floor[c].frames[0].tags.size());
    for (const FrameDetections& frame : recording.waved[c].frames) {
      if (frame.tags.size() < 3) continue;
      ++views;
      corners += 4 * static_cast<int>(frame.tags.size());
    }
    EXPECT_EQ(rig->quality[c].views, views);
    EXPECT_EQ(rig->quality[c].corners, corners);
    EXPECT_GT(rig->quality[c].coverage, 0.2);
    EXPECT_LT(rig->quality[c].coverage, 1.0);
  }
}

/// Returns the number of frames in which both cameras saw three tags or more of the waved
/// board.
int seen_together(const BoardRecording& recording, std::size_t a, std::size_t b) {
  int count = 0;
  for (std::size_t f = 0; f < recording.waved[a].frames.size(); ++f) {
    if (recording.waved[a].frames[f].tags.size() >= 3 &&
        recording.waved[b].frames[f].tags.size() >= 3) {
      ++count;
    }
  }
  return count;
}

TEST(CalibrateCameras, KeepsItsViewsForReports) {
  const auto cameras = ring_of_cameras();
  Disturbance disturbance;
  disturbance.noise_px = 0.2;
  const BoardRecording recording = wave_board(cameras, kBoard, kFrames, disturbance);
  const auto rig =
      calibrate_cameras(names_of(cameras), recording.waved, recording.floor, kBoard);
  ASSERT_TRUE(rig) << rig.error().message();
  std::vector<double> squares(cameras.size());
  std::vector<int> corners(cameras.size());
  int outliers = 0;
  for (const TargetView& view : rig->views) {
    const std::size_t c = index(view.camera);
    for (const SeenCorner& corner : view.corners) {
      squares[c] += glm::dot(corner.error_px, corner.error_px);
      ++corners[c];
      outliers += corner.is_outlier ? 1 : 0;
    }
    // The floor defines the world: the board lies on it, face up.
    if (!view.stays) continue;
    EXPECT_EQ(view.frame, kFloorInstant);
    const glm::dvec3 up = view.world_from_target.rotation * glm::dvec3(0.0, 0.0, 1.0);
    EXPECT_GT(up.y, 0.9999);
  }
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    EXPECT_EQ(corners[c], rig->quality[c].corners);
    // Single precision.
    EXPECT_NEAR(std::sqrt(squares[c] / corners[c]), rig->quality[c].rms_px, 1e-4);
    for (std::size_t other = 0; other < cameras.size(); ++other) {
      EXPECT_EQ(rig->shared_views[c * cameras.size() + other],
                seen_together(recording, c, other));
    }
  }
  EXPECT_EQ(outliers, 4 * rig->outliers);
}

}  // namespace
}  // namespace marey::calib
