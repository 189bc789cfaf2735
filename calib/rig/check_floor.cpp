// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/check_floor.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "calib/model/estimate_intrinsics.h"
#include "core/base/assert.h"

namespace marey::calib {
namespace {

// Corner noise and the shrinkage of tags stay below 2 px; the view of another camera is
// off by a hundred. A camera that moved by a few centimetres between the trials stays
// below this limit: bundle adjustment absorbs such a move in the poses of cameras and
// boards.
constexpr double kMaxFloorError_px = 5.0;

/// The corners of the floor in one camera's file, and the camera that is assumed to have
/// taken it.
struct Assigned {
  const Camera* camera = nullptr;
  const BoardView* view = nullptr;
};

struct Fit {
  double worst_px = std::numeric_limits<double>::infinity();
  std::size_t worst = 0;  ///< Index of the view with the largest error.
};

/// Returns the errors for the pose of the board that most views agree with, among the
/// poses estimated from single views.
Fit best_fit(std::span<const Assigned> views) {
  double min_sum_px = std::numeric_limits<double>::infinity();
  Fit best;
  for (const Assigned& proposer : views) {
    const auto camera_from_board =
        calib::camera_from_board(proposer.camera->intrinsics, *proposer.view);
    if (!camera_from_board) continue;
    const RigidTransform world_from_board =
        inverse(proposer.camera->camera_from_world) * *camera_from_board;
    Fit fit{0.0, 0};
    double sum_px = 0.0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const double error_px =
          median_error_px(*views[i].view, *views[i].camera, world_from_board);
      sum_px += error_px;
      if (error_px > fit.worst_px) fit = {error_px, i};
    }
    if (sum_px < min_sum_px) {
      min_sum_px = sum_px;
      best = fit;
    }
  }
  return best;
}

}  // namespace

Status check_floor(std::span<const Camera> cameras,
                   std::span<const BoardView* const> floor_views,
                   std::span<const CameraDetections> floor) {
  MAREY_ASSERT(cameras.size() == floor.size());
  std::vector<Assigned> views;
  for (const BoardView* view : floor_views) {
    views.push_back({&cameras[index(view->camera)], view});
  }
  if (views.size() < 2) return Done{};
  const Fit as_given = best_fit(views);
  if (as_given.worst_px < kMaxFloorError_px) return Done{};

  const auto source = [&](std::size_t i) {
    return floor[index(floor_views[i]->camera)].source;
  };
  Fit exchanged = as_given;
  std::pair<std::size_t, std::size_t> pair;
  for (std::size_t a = 0; a < views.size(); ++a) {
    for (std::size_t b = a + 1; b < views.size(); ++b) {
      std::swap(views[a].view, views[b].view);
      const Fit fit = best_fit(views);
      std::swap(views[a].view, views[b].view);
      if (fit.worst_px >= exchanged.worst_px) continue;
      exchanged = fit;
      pair = {a, b};
    }
  }
  std::array<char, 160> text{};
  if (exchanged.worst_px < kMaxFloorError_px) {
    std::snprintf(
        text.data(),
        text.size(),
        "the two cameras' files look exchanged: the board on the floor is %.0f px off as "
        "given, %.1f px the other way round",
        as_given.worst_px,
        exchanged.worst_px);
    return bad_input(source(pair.first) + " and " + source(pair.second),
                     text.data(),
                     "exchange them under the floor trial's videos in session.toml (or "
                     "under the calibration trial's, if those are the wrong ones)");
  }
  std::snprintf(text.data(),
                text.size(),
                "the board on the floor is %.0f px from where the other cameras see it",
                as_given.worst_px);
  return bad_input(
      source(as_given.worst),
      text.data(),
      "check that this file is this camera's, that the board lay still in the `frames` "
      "of "
      "the floor trial, and that no camera was moved between the calibration and it");
}

}  // namespace marey::calib
