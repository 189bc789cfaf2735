// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/seen_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/quantile.h"

namespace marey::calib {
namespace {

// Minimum number of neighbours of one kind for a grid.
constexpr int kMinPairs = 6;
// The others may be tags of a body next to the board, or second neighbours.
constexpr double kMinShare = 0.7;

glm::dvec2 middle_of(const TagDetection& tag) {
  glm::dvec2 sum(0.0);
  for (const glm::dvec2& corner : tag.corners_px) sum += corner;
  return 0.25 * sum;
}

/// Returns the homography from pixels to the tag's plane: its corners are those of the
/// unit square, x to the right and y up. Returns nullopt for a tag seen edge-on.
/// (Heckbert: Fundamentals of Texture Mapping and Image Warping, 1989, 2.2.3.)
std::optional<glm::dmat3> plane_from_picture(const TagDetection& tag) {
  const auto& p = tag.corners_px;
  const glm::dvec2 sum = p[0] - p[1] + p[2] - p[3];
  const glm::dvec2 a = p[1] - p[2];
  const glm::dvec2 b = p[3] - p[2];
  const double area = a.x * b.y - b.x * a.y;
  if (std::abs(area) < 1.0) return std::nullopt;
  const double g = (sum.x * b.y - b.x * sum.y) / area;
  const double h = (a.x * sum.y - sum.x * a.y) / area;
  const glm::dmat3 picture_from_plane(glm::dvec3(p[1] - p[0] + g * p[1], g),
                                      glm::dvec3(p[3] - p[0] + h * p[3], h),
                                      glm::dvec3(p[0], 1.0));
  if (std::abs(glm::determinant(picture_from_plane)) < 1e-6) return std::nullopt;
  return glm::inverse(picture_from_plane);
}

/// A tag and its neighbour to the right or above.
using Pair = std::pair<int, int>;

/// Number of sightings of each pair, by ids.
struct Neighbours {
  std::map<Pair, int> right;
  std::map<Pair, int> above;
};

void count_neighbours(const FrameDetections& frame, Neighbours& neighbours) {
  // Distance of centres, in sides of a tag: for gaps from none to a whole side.
  constexpr double kMinSpacing = 0.9;
  constexpr double kMaxSpacing = 2.1;
  constexpr double kMaxOffset = 0.35;
  for (const TagDetection& tag : frame.tags) {
    const auto plane = plane_from_picture(tag);
    if (!plane) continue;
    for (const TagDetection& other : frame.tags) {
      if (other.id == tag.id) continue;
      const glm::dvec3 there = *plane * glm::dvec3(middle_of(other), 1.0);
      if (there.z <= 0.0) continue;
      const double along = there.x / there.z - 0.5;
      const double up = there.y / there.z - 0.5;
      const Pair pair{number(tag.id), number(other.id)};
      if (along > kMinSpacing && along < kMaxSpacing && std::abs(up) < kMaxOffset) {
        ++neighbours.right[pair];
      } else if (up > kMinSpacing && up < kMaxSpacing && std::abs(along) < kMaxOffset) {
        ++neighbours.above[pair];
      }
    }
  }
}

/// Returns the most frequent difference of neighbours' ids.
std::optional<int> typical_step(const std::map<Pair, int>& pairs) {
  std::map<int, int> steps;
  int all = 0;
  for (const auto& [pair, times] : pairs) {
    steps[pair.second - pair.first] += times;
    all += times;
  }
  for (const auto& [step, times] : steps) {
    if (times >= kMinPairs && times >= kMinShare * all) return step;
  }
  return std::nullopt;
}

/// Adds the ids of neighbours that are `step` apart.
void add_ids(const std::map<Pair, int>& pairs, int step, std::set<int>& ids) {
  for (const auto& [pair, times] : pairs) {
    if (times < 2 || pair.second - pair.first != step) continue;
    ids.insert({pair.first, pair.second});
  }
}

/// Returns the remainder, divided by `columns`, of the ids at the end of each row: the
/// only ones whose successor is never to their right.
std::optional<int> last_of_row(const std::map<Pair, int>& right, int columns) {
  std::vector<int> times_followed(static_cast<std::size_t>(columns), 0);
  int max_count = 0;
  for (const auto& [pair, times] : right) {
    if (pair.second - pair.first != 1) continue;
    int& followed = times_followed[static_cast<std::size_t>(pair.first % columns)];
    followed += times;
    max_count = std::max(max_count, followed);
  }
  std::optional<int> last;
  for (int remainder = 0; remainder < columns; ++remainder) {
    if (times_followed[static_cast<std::size_t>(remainder)] * 20 > max_count) continue;
    if (last) return std::nullopt;
    last = remainder;
  }
  return last;
}

}  // namespace

std::optional<SeenLayout> seen_layout(const CameraDetections& camera) {
  Neighbours neighbours;
  for (const FrameDetections& frame : camera.frames) count_neighbours(frame, neighbours);
  const auto along_row = typical_step(neighbours.right);
  const auto columns = typical_step(neighbours.above);
  if (along_row != 1 || !columns || *columns < 2) return std::nullopt;
  const auto last = last_of_row(neighbours.right, *columns);
  if (!last) return std::nullopt;
  std::set<int> ids;
  add_ids(neighbours.right, 1, ids);
  add_ids(neighbours.above, *columns, ids);
  if (ids.empty()) return std::nullopt;
  const int min_id = *ids.begin();
  const int into_row = ((min_id - (*last + 1)) % *columns + *columns) % *columns;
  SeenLayout layout;
  layout.columns = *columns;
  layout.first_id = min_id - into_row;
  layout.rows = (*ids.rbegin() - layout.first_id) / *columns + 1;
  if (layout.first_id < 0) return std::nullopt;
  return layout;
}

bool layout_matches(const SeenLayout& seen, const AprilGrid& board) {
  return seen.columns == board.columns &&
         (seen.first_id - board.first_id) % board.columns == 0;
}

double travel_px(const CameraDetections& camera, const CalibrationTarget& board) {
  struct Travel {
    glm::dvec2 start_px{0.0};
    double farthest_px = 0.0;
  };
  std::map<int, Travel> travels;
  const auto follow = [&](int number_of_it, const glm::dvec2& place_px) {
    Travel& travel = travels.try_emplace(number_of_it, Travel{place_px}).first->second;
    travel.farthest_px =
        std::max(travel.farthest_px, glm::distance(travel.start_px, place_px));
  };
  const auto* grid = std::get_if<AprilGrid>(&board);
  for (const FrameDetections& frame : camera.frames) {
    for (const TagDetection& tag : frame.tags) {
      if (grid && grid->contains(tag.id)) follow(number(tag.id), middle_of(tag));
    }
    if (grid) continue;
    for (const PointDetection& point : frame.points) follow(point.point, point.pixel_px);
  }
  if (travels.empty()) return 0.0;
  std::vector<double> farthest;
  for (const auto& [id, travel] : travels) farthest.push_back(travel.farthest_px);
  return median(std::move(farthest));
}

}  // namespace marey::calib
