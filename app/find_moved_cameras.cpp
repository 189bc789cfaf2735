// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/find_moved_cameras.h"

#include <map>
#include <numbers>
#include <utility>

#include "app/calibration_limits.h"
#include "app/finding_list.h"
#include "calib/find_moved_camera.h"

namespace marey::app {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Calibrations and lenses err by some tenths of a pixel where the body is. A move
// of 1 px doubles the error of joints (docs/measurements.md, "Simulated camera faults").
constexpr double kFairPx = 0.5;
constexpr double kPoorPx = 0.8;
// In squared sigmas. Views of one tag share their errors: chance alone reaches 100, moves
// that are too small to matter reach 300.
constexpr double kSureGain = 400.0;

}  // namespace

std::optional<MovedFinding> find_moved_cameras(
    const std::string& trial,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    std::span<const TagOnSegment> tags) {
  std::map<TagId, double> sizes_m;
  for (const TagOnSegment& tag : tags) sizes_m[tag.id] = tag.size_m;
  const auto move = calib::find_moved_camera(cameras, detections, sizes_m);
  if (!move) return std::nullopt;
  const Camera& camera = cameras[index(move->camera)];
  const double scale = pixel_scale(camera);
  if (move->gain < kSureGain || move->moved_px < kFairPx * scale) return std::nullopt;
  std::string names = "camera " + camera.name;
  for (const CameraId other : move->instead) names += " or " + cameras[index(other)].name;
  std::string cause =
      worded("its tags fit a camera that was moved by %.1f px (%.2f degrees, %.0f mm) ",
             move->moved_px,
             move->turn_rad * kDegrees,
             1e3 * move->shift_m) +
      (move->from_frame ? worded("from frame %d on", *move->from_frame)
                        : std::string("after the calibration"));
  return MovedFinding{
      {Errc::kQuality,
       "trial " + trial + ", " + names,
       std::move(cause),
       "its joints are off by as much; calibrate again as the cameras stand now, and "
       "record the trial again, or leave that camera's video out of it"},
      move->moved_px > kPoorPx * scale};
}

}  // namespace marey::app
