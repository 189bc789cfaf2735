// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/calibrate_cameras.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include <glm/geometric.hpp>

#include "calib/board_views.h"
#include "calib/bundle_adjust.h"
#include "calib/check_floor.h"
#include "calib/estimate_intrinsics.h"
#include "calib/place_cameras.h"
#include "core/assert.h"
#include "core/quantile.h"

namespace marey::calib {
namespace {

// The median: a few tags read from another place do not make a calibration wrong.
constexpr double kHopelessMedianPx = 2.5;
// Lenses and detectors take one to three percent off a tag. More is another print: a
// wrong gap looks exactly like tags that are too small.
constexpr double kMostShrinkage = 0.05;

Error too_few_views(const CameraDetections& camera, const AprilGrid& board) {
  int tags_seen = 0;
  int frames_seen = 0;
  for (const FrameDetections& frame : camera.frames) {
    int here = 0;
    for (const TagDetection& tag : frame.tags) here += board.contains(tag.id);
    tags_seen += here;
    frames_seen += here >= 6;
  }
  if (tags_seen == 0) {
    return bad_input(camera.source,
                     "no tag of the calibration board (ids " +
                         std::to_string(board.first_id) + " to " +
                         std::to_string(board.first_id + board.tag_count() - 1) +
                         ") is seen in any frame",
                     "check that this is the calibration video, that [board] in "
                     "session.toml names the printed ids and [tags] the family, and that "
                     "the picture is sharp");
  }
  if (frames_seen >= 4) {
    return bad_input(camera.source,
                     "no lens makes the board look as it does in the " +
                         std::to_string(frames_seen) +
                         " frames that show six tags or more: it never tilts, or is not "
                         "as [board] says",
                     "tilt the board while it is filmed, and check [board] in "
                     "session.toml (rows, columns, sizes, first_id) against the print");
  }
  return bad_input(camera.source,
                   "the board is seen too little to calibrate this camera: " +
                       std::to_string(frames_seen) + " frames show six tags or more",
                   "record the calibration again: tilt the board, bring it close to this "
                   "camera and into the corners of its picture");
}

Result<std::vector<Intrinsics>> first_intrinsics(std::span<const CameraDetections> waved,
                                                 std::span<const BoardView> views,
                                                 const AprilGrid& board) {
  std::vector<Intrinsics> intrinsics;
  for (std::size_t c = 0; c < waved.size(); ++c) {
    std::vector<const BoardView*> of_camera;
    for (const BoardView& view : views) {
      if (index(view.camera) == c) of_camera.push_back(&view);
    }
    const auto k = estimate_intrinsics(of_camera, waved[c].width_px, waved[c].height_px);
    if (!k) return too_few_views(waved[c], board);
    intrinsics.push_back(*k);
  }
  return intrinsics;
}

/// Corner `i` of the view with its tag's shrinkage taken off.
glm::dvec2 true_pixel(const BoardView& view,
                      std::size_t i,
                      const TagShrinkage& shrinkage) {
  const std::size_t first = i - i % 4;
  std::array<glm::dvec2, 4> corners{};
  for (std::size_t c = 0; c < 4; ++c) corners[c] = view.corners[first + c].pixel_px;
  return unshrunk(corners, shrinkage)[i % 4];
}

CameraQuality judge(const Camera& camera,
                    const BundleCamera& solved,
                    std::span<const BoardView> views,
                    std::size_t camera_index,
                    const Bundle& bundle,
                    std::vector<double>& errors_px) {
  CameraQuality quality;
  std::set<int> cells;
  std::vector<double> own;
  for (const BoardView& view : views) {
    const auto board = bundle.world_from_board.find(view.instant);
    if (index(view.camera) != camera_index || board == bundle.world_from_board.end()) {
      continue;
    }
    ++quality.views;
    for (std::size_t i = 0; i < view.corners.size(); ++i) {
      const auto pixel = project(camera, board->second * view.corners[i].p_in_board);
      const glm::dvec2 seen_px = true_pixel(view, i, camera.tag_shrinkage);
      // Behind the camera: as wrong as the picture is large.
      own.push_back(pixel ? glm::distance(*pixel, seen_px) : camera.intrinsics.width_px);
      const int column = static_cast<int>(8.0 * seen_px.x / camera.intrinsics.width_px);
      const int row = static_cast<int>(6.0 * seen_px.y / camera.intrinsics.height_px);
      cells.insert(8 * std::clamp(row, 0, 5) + std::clamp(column, 0, 7));
    }
  }
  double sum = 0.0;
  for (const double e : own) sum += e * e;
  quality.corners = static_cast<int>(own.size());
  if (!own.empty()) {
    quality.rms_px = std::sqrt(sum / static_cast<double>(own.size()));
    errors_px.insert(errors_px.end(), own.begin(), own.end());
    quality.p95_px = quantile(std::move(own), 0.95);
  }
  quality.centre_sigma_m = solved.centre_sigma_m;
  quality.focal_sigma_px = solved.focal_sigma_px;
  quality.coverage = static_cast<double>(cells.size()) / 48.0;
  return quality;
}

CalibratedRig to_rig(std::span<const std::string> names,
                     std::span<const BoardView> views,
                     const Bundle& bundle) {
  CalibratedRig rig;
  std::vector<double> errors_px;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const BundleCamera& solved = bundle.cameras[c];
    rig.cameras.push_back({names[c],
                           solved.intrinsics,
                           inverse(solved.world_from_camera),
                           solved.shrinkage});
    rig.quality.push_back(judge(rig.cameras.back(), solved, views, c, bundle, errors_px));
  }
  double sum = 0.0;
  for (const double e : errors_px) sum += e * e;
  rig.rms_px = std::sqrt(sum / static_cast<double>(errors_px.size()));
  rig.median_px = median(std::move(errors_px));
  return rig;
}

std::string text(const char* format, double value) {
  std::array<char, 200> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

/// Gaps and black squares are measured apart: their ratio must be the declared one.
Status check_print(const CalibratedRig& rig) {
  std::vector<double> slopes;
  for (const Camera& camera : rig.cameras) slopes.push_back(camera.tag_shrinkage.slope);
  const double slope = median(std::move(slopes));
  if (std::abs(slope) < kMostShrinkage) return Done{};
  return bad_input("",
                   text("the board's black squares measure %.2f times what the distances "
                        "between them allow",
                        1.0 - slope),
                   "measure the print (edge of a black square, gap between two, in "
                   "metres) and correct tag_size_m or gap_m of [board] in session.toml");
}

Status check(const CalibratedRig& rig,
             std::span<const BoardView> views,
             std::span<const CameraDetections> floor) {
  if (rig.median_px > kHopelessMedianPx) {
    return bad_input(
        "",
        text("calibration ends %.1f px away from what the cameras saw (good: "
             "under 0.5)",
             rig.median_px),
        "check [board] in session.toml (rows, columns, sizes, first_id) "
        "against the print, and that all calibration videos start together");
  }
  if (Status ok = check_print(rig); !ok) return ok;
  std::vector<const BoardView*> floor_views;
  for (const BoardView& view : views) {
    if (view.instant == kFloorInstant) floor_views.push_back(&view);
  }
  if (Status ok = check_floor(rig.cameras, floor_views, floor); !ok) return ok;
  for (const BoardView* view : floor_views) {
    const std::size_t c = index(view->camera);
    if (centre_in_world(rig.cameras[c]).y > 0.0) continue;
    return bad_input(floor[c].source,
                     "the camera would stand below the floor: the board lies face down "
                     "or its ids run the other way",
                     "lay the board on the floor with its printed face up");
  }
  return Done{};
}

}  // namespace

Result<CalibratedRig> calibrate_cameras(std::span<const std::string> names,
                                        std::span<const CameraDetections> waved,
                                        std::span<const CameraDetections> floor,
                                        const AprilGrid& board) {
  MAREY_ASSERT(names.size() == waved.size());
  const std::vector<BoardView> views = board_views(waved, floor, board);
  const auto intrinsics = first_intrinsics(waved, views, board);
  if (!intrinsics) return intrinsics.error();
  const auto guess = place_cameras(views, *intrinsics, names, board);
  if (!guess) return guess.error();

  Bundle bundle;
  for (std::size_t c = 0; c < names.size(); ++c) {
    bundle.cameras.push_back(
        {(*intrinsics)[c], inverse(guess->camera_from_world[c]), {}, 0.0, 0.0});
  }
  bundle.world_from_board = guess->world_from_board;
  if (!bundle_adjust(views, bundle)) {
    return bad_input("",
                     "the bundle adjustment of the cameras does not converge",
                     "record the calibration again with the board tilted in front of "
                     "every camera");
  }
  CalibratedRig rig = to_rig(names, views, bundle);
  if (const Status ok = check(rig, views, floor); !ok) return ok.error();
  return rig;
}

}  // namespace marey::calib
