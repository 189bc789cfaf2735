// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/check_rig.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "calib/model/estimate_intrinsics.h"
#include "calib/rig/check_floor.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

// The median tolerates a few misread tags.
constexpr double kMaxMedianPx = 2.5;
// Lenses and light reduce a tag by about one percent. A larger value indicates another
// print: a wrong gap has the same effect as smaller tags.
constexpr double kMaxShrinkage = 0.03;

std::string text(const char* format, double value) {
  std::array<char, 200> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

/// Checks the ratio of gaps and black squares, which are measured independently, against
/// the declared ratio.
Status check_print(const CalibratedRig& rig) {
  std::vector<double> slopes;
  for (const Camera& camera : rig.cameras) slopes.push_back(camera.tag_shrinkage.slope);
  const double slope = median(std::move(slopes));
  if (std::abs(slope) < kMaxShrinkage) return Done{};
  return bad_input("",
                   text("the board's black squares measure %.2f times the size that the "
                        "gaps between them require",
                        1.0 - slope),
                   "measure the print (edge of a black square, gap between two, in "
                   "metres) and correct tag_size_m or gap_m of [board] in session.toml");
}

/// Returns an error for the camera that agrees least with the others on the moving
/// board's poses, if most of its sightings disagree: its floor view is then meaningless.
Status check_steps(const CalibratedRig& rig, std::span<const CameraDetections> waved) {
  constexpr double kDisagreesPx = 5.0;
  double worst_px = 0.0;
  std::size_t worst = 0;
  for (std::size_t c = 0; c < waved.size(); ++c) {
    std::vector<double> errors_px;
    for (const TargetView& view : rig.views) {
      if (view.stays || index(view.camera) != c) continue;
      for (const SeenCorner& corner : view.corners) {
        errors_px.push_back(double{glm::length(corner.error_px)});
      }
    }
    if (errors_px.empty()) continue;
    const double px = median(std::move(errors_px));
    if (px <= worst_px) continue;
    worst_px = px;
    worst = c;
  }
  if (worst_px < kDisagreesPx) return Done{};
  return bad_input(
      waved[worst].source,
      text("most of its pictures of the moving board do not fit those of the other "
           "cameras (%.0f px off): it is not in step with them",
           worst_px),
      "check whether it skips frames or its stated rate is wrong (record at a rate that "
      "the camera keeps, with a fixed exposure), that it is of the same trial, and that "
      "the camera was not moved");
}

}  // namespace

Status check_mirrored(std::span<const BoardView> views,
                      std::span<const Intrinsics> intrinsics) {
  int before = 0;
  int behind = 0;
  for (const BoardView& view : views) {
    const auto pose = camera_from_board(intrinsics[index(view.camera)], view);
    if (!pose) continue;
    (inverse(*pose).translation.z > 0.0 ? before : behind) += 1;
  }
  if (behind <= before) return Done{};
  return bad_input("",
                   "the cameras see the board from behind: its corners are mirrored",
                   "check that no video is mirrored (a webcam's \"selfie\" view), and "
                   "that rows and columns of [board] in session.toml are not exchanged");
}

bool is_unusable(const CalibratedRig& rig) {
  return rig.median_px > kMaxMedianPx;
}

Status check_rig(const CalibratedRig& rig,
                 std::span<const BoardView> views,
                 std::span<const CameraDetections> waved,
                 std::span<const CameraDetections> floor,
                 const CalibrationTarget& board) {
  if (is_unusable(rig)) {
    return bad_input(
        "",
        text("the error of the calibration is %.1f px (good: under 0.5)", rig.median_px),
        "check [board] in session.toml (rows, columns, sizes, first_id) "
        "against the print, and that all calibration videos start together");
  }
  if (std::holds_alternative<AprilGrid>(board)) {
    if (Status ok = check_print(rig); !ok) return ok;
  }
  if (floor.empty()) return Done{};
  std::vector<const BoardView*> floor_views;
  for (const BoardView& view : views) {
    if (view.instant == kFloorInstant) floor_views.push_back(&view);
  }
  if (Status ok = check_floor(rig.cameras, floor_views, floor); !ok) {
    const Status steps = check_steps(rig, waved);
    return steps ? ok : steps;
  }
  for (const BoardView* view : floor_views) {
    const std::size_t c = index(view->camera);
    if (centre_in_world(rig.cameras[c]).y > 0.0) continue;
    return bad_input(floor[c].source,
                     "the camera is below the floor of the board: the board lies face "
                     "down or its ids are in reverse order",
                     "lay the board on the floor with its printed face up");
  }
  return Done{};
}

}  // namespace marey::calib
