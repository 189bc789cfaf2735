// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/board_views.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "core/assert.h"
#include "core/quantile.h"

namespace marey::calib {
namespace {

BoardView view_of(const FrameDetections& frame, CameraId camera, const AprilGrid& board) {
  BoardView view{camera, frame.frame, {}};
  for (const TagDetection& tag : frame.tags) {
    for (int c = 0; c < 4; ++c) {
      const auto p_in_board = board.corner_in_board(tag.id, c);
      if (!p_in_board) break;
      view.corners.push_back(
          {*p_in_board, tag.corners_px[static_cast<std::size_t>(c)], tag.sigma_px});
    }
  }
  return view;
}

/// One averaged view of a board at rest. Averaging takes off the sensor's noise but not
/// the lens's and the detector's systematic part, so sigma does not fall below a third.
BoardView average_floor_view(const CameraDetections& floor, const AprilGrid& board) {
  std::map<TagId, std::vector<const TagDetection*>> sightings;
  for (const FrameDetections& frame : floor.frames) {
    for (const TagDetection& tag : frame.tags) {
      if (board.contains(tag.id)) sightings[tag.id].push_back(&tag);
    }
  }
  BoardView view{floor.camera, kFloorInstant, {}};
  for (const auto& [id, tags] : sightings) {
    // A tag seen in only a few of the frames is somebody's shadow or a lucky decode.
    if (4 * tags.size() < floor.frames.size()) continue;
    for (std::size_t c = 0; c < 4; ++c) {
      std::vector<double> xs;
      std::vector<double> ys;
      for (const TagDetection* tag : tags) {
        xs.push_back(tag->corners_px[c].x);
        ys.push_back(tag->corners_px[c].y);
      }
      const glm::dvec2 middle(median(xs), median(ys));
      glm::dvec2 sum(0.0);
      int count = 0;
      for (const TagDetection* tag : tags) {
        if (glm::distance(tag->corners_px[c], middle) > 3.0) continue;
        sum += tag->corners_px[c];
        ++count;
      }
      const double shrink =
          std::max(1.0 / 3.0, 1.0 / std::sqrt(static_cast<double>(count)));
      view.corners.push_back({*board.corner_in_board(id, static_cast<int>(c)),
                              count > 0 ? sum / static_cast<double>(count) : middle,
                              tags.front()->sigma_px * shrink});
    }
  }
  return view;
}

bool is_floor_frame(std::span<const CameraDetections> floor,
                    const CameraDetections& waved,
                    int frame) {
  return std::any_of(floor.begin(), floor.end(), [&](const CameraDetections& f) {
    return f.source == waved.source && !f.frames.empty() &&
           frame >= f.frames.front().frame && frame <= f.frames.back().frame;
  });
}

}  // namespace

std::vector<BoardView> board_views(std::span<const CameraDetections> waved,
                                   std::span<const CameraDetections> floor,
                                   const AprilGrid& board,
                                   int minimum_tags) {
  std::vector<BoardView> views;
  const auto keep = [&](BoardView view) {
    if (static_cast<int>(view.corners.size()) >= 4 * minimum_tags) {
      views.push_back(std::move(view));
    }
  };
  for (const CameraDetections& camera : floor) {
    keep(average_floor_view(camera, board));
  }
  for (const CameraDetections& camera : waved) {
    for (const FrameDetections& frame : camera.frames) {
      if (is_floor_frame(floor, camera, frame.frame)) continue;
      keep(view_of(frame, camera.camera, board));
    }
  }
  std::stable_sort(
      views.begin(), views.end(), [](const BoardView& a, const BoardView& b) {
        return std::pair(a.camera, a.instant) < std::pair(b.camera, b.instant);
      });
  return views;
}

double median_error_px(const BoardView& view,
                       const Camera& camera,
                       const RigidTransform& world_from_board) {
  MAREY_ASSERT(!view.corners.empty());
  std::vector<double> errors_px;
  for (const BoardCorner& corner : view.corners) {
    const auto pixel = project(camera, world_from_board * corner.p_in_board);
    errors_px.push_back(pixel ? glm::distance(*pixel, corner.pixel_px)
                              : camera.intrinsics.width_px);
  }
  return median(std::move(errors_px));
}

}  // namespace marey::calib
