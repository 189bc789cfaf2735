// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/board_views.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

/// One corner of a tag, or one point, seen in a frame.
struct Mark {
  int id = 0;  ///< Id of the tag or point.
  glm::dvec3 p_in_board{0.0};
  glm::dvec2 pixel_px{0.0};
  double sigma_px = 0.3;
  int corner = 0;
};

bool is_of_tags(const CalibrationTarget& board) {
  return std::holds_alternative<AprilGrid>(board);
}

std::optional<glm::dvec3> point_in_board(const CalibrationTarget& board, int point) {
  if (const auto* charuco = std::get_if<CharucoBoard>(&board)) {
    return inner_corner_in_board(
        charuco->rows, charuco->columns, charuco->square_size_m, point);
  }
  if (const auto* chess = std::get_if<Chessboard>(&board)) {
    return inner_corner_in_board(
        chess->rows, chess->columns, chess->square_size_m, point);
  }
  return std::nullopt;
}

std::vector<Mark> marks_of(const FrameDetections& frame, const CalibrationTarget& board) {
  std::vector<Mark> marks;
  if (const auto* grid = std::get_if<AprilGrid>(&board)) {
    for (const TagDetection& tag : frame.tags) {
      for (int c = 0; c < 4; ++c) {
        const auto p = grid->corner_in_board(tag.id, c);
        if (!p) break;
        marks.push_back({number(tag.id),
                         *p,
                         tag.corners_px[static_cast<std::size_t>(c)],
                         tag.sigma_px,
                         c});
      }
    }
    return marks;
  }
  for (const PointDetection& point : frame.points) {
    const auto p = point_in_board(board, point.point);
    if (p) marks.push_back({point.point, *p, point.pixel_px, point.sigma_px, 0});
  }
  return marks;
}

BoardView view_of(const FrameDetections& frame,
                  CameraId camera,
                  const CalibrationTarget& board) {
  BoardView view{camera, frame.frame, {}, is_of_tags(board)};
  for (const Mark& mark : marks_of(frame, board)) {
    view.corners.push_back({mark.p_in_board, mark.pixel_px, mark.sigma_px});
  }
  return view;
}

/// Returns the corner averaged over several sightings, without outliers. Averaging
/// removes the sensor's noise but not the systematic errors of the lens and the detector,
/// which are the larger part (measured on rendered boards at rest): sigma is therefore at
/// least three quarters of a single sighting's.
BoardCorner average(const std::vector<Mark>& marks) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (const Mark& mark : marks) {
    xs.push_back(mark.pixel_px.x);
    ys.push_back(mark.pixel_px.y);
  }
  const glm::dvec2 middle(median(xs), median(ys));
  glm::dvec2 sum(0.0);
  int count = 0;
  for (const Mark& mark : marks) {
    if (glm::distance(mark.pixel_px, middle) > 3.0) continue;
    sum += mark.pixel_px;
    ++count;
  }
  const double shrink = std::max(0.75, 1.0 / std::sqrt(static_cast<double>(count)));
  return {marks.front().p_in_board,
          count > 0 ? sum / static_cast<double>(count) : middle,
          marks.front().sigma_px * shrink};
}

/// Returns one averaged view of a board at rest.
BoardView average_floor_view(const CameraDetections& floor,
                             const CalibrationTarget& board) {
  std::map<std::pair<int, int>, std::vector<Mark>> sightings;  // By id and corner.
  for (const FrameDetections& frame : floor.frames) {
    for (const Mark& mark : marks_of(frame, board)) {
      sightings[{mark.id, mark.corner}].push_back(mark);
    }
  }
  BoardView view{floor.camera, kFloorInstant, {}, is_of_tags(board)};
  for (const auto& [place, marks] : sightings) {
    // Corners that are seen in only a few of the frames are false detections.
    if (4 * marks.size() < floor.frames.size()) continue;
    view.corners.push_back(average(marks));
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
                                   const CalibrationTarget& board,
                                   int minimum_tags) {
  std::vector<BoardView> views;
  const std::size_t min_corners =
      static_cast<std::size_t>((is_of_tags(board) ? 4 : 2) * minimum_tags);
  const auto keep = [&](BoardView view) {
    if (view.corners.size() >= min_corners) views.push_back(std::move(view));
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

double thickness_m(const CalibrationTarget& board) {
  return std::visit(
      [](const auto& b) {
        if constexpr (requires { b.thickness_m; }) return b.thickness_m;
        return 0.0;
      },
      board);
}

BoardExtent extent_of(const CalibrationTarget& board) {
  if (const auto* grid = std::get_if<AprilGrid>(&board)) {
    const TagId last{grid->first_id + grid->tag_count() - 1};
    return {glm::dvec3(0.0), *grid->corner_in_board(last, 2)};
  }
  const auto of_squares = [](const auto& b) -> BoardExtent {
    return {glm::dvec3(b.square_size_m, b.square_size_m, 0.0),
            glm::dvec3(
                (b.columns - 1) * b.square_size_m, (b.rows - 1) * b.square_size_m, 0.0)};
  };
  if (const auto* charuco = std::get_if<CharucoBoard>(&board))
    return of_squares(*charuco);
  if (const auto* chess = std::get_if<Chessboard>(&board)) return of_squares(*chess);
  return {};
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
