// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/assess_moved_camera.h"

#include <map>
#include <utility>

#include "calib/quality/calibration_limits.h"
#include "calib/rig/find_moved_camera.h"
#include "core/base/degrees.h"
#include "core/base/format_text.h"

namespace marey::app {
namespace {

// Errors of calibrations and lenses are some tenths of a pixel at the body. A move of 1
// px doubles the error of joints (docs/accuracy/camera_faults.md).
constexpr double kFairPx = 0.5;
constexpr double kPoorPx = 0.8;
// Unit: squared sigmas. Views of one tag share their errors: chance alone reaches 100,
// and moves too small to matter reach 300.
constexpr double kSureGain = 400.0;

}  // namespace

std::optional<Finding> assess_moved_camera(const std::string& trial,
                                           std::span<const Camera> cameras,
                                           std::span<const CameraDetections> detections,
                                           std::span<const TagOnSegment> tags) {
  std::map<TagId, double> sizes_m;
  for (const TagOnSegment& tag : tags) sizes_m[tag.id] = tag.size_m;
  const auto move = calib::find_moved_camera(cameras, detections, sizes_m);
  if (!move) return std::nullopt;
  const Camera& camera = cameras[index(move->camera)];
  const double scale = calib::pixel_scale(camera);
  if (move->gain < kSureGain || move->moved_px < kFairPx * scale) return std::nullopt;
  std::string names = "camera " + camera.name;
  for (const CameraId other : move->alternatives)
    names += " or " + cameras[index(other)].name;
  std::string cause =
      format_text(
          "its tags fit a camera that was moved by %.1f px (%.2f degrees, %.0f mm) ",
          move->moved_px,
          move->turn_rad * kDegreesPerRadian,
          1e3 * move->shift_m) +
      (move->from_frame ? format_text("from frame %d on", *move->from_frame)
                        : std::string("after the calibration"));
  return Finding{
      move->moved_px > kPoorPx * scale ? Severity::kPoor : Severity::kFair,
      "moved",
      "trial " + trial + ", " + names,
      std::move(cause),
      "the joints of this trial have errors of about this size; calibrate again with the "
      "cameras where they are now and record the trial again, or leave the video of this "
      "camera out of the trial"};
}

}  // namespace marey::app
