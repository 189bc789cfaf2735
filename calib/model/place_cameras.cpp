// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/place_cameras.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <numbers>

#include <glm/geometric.hpp>

#include "calib/model/consensus.h"
#include "calib/model/estimate_intrinsics.h"

namespace marey::calib {
namespace {

/// camera_from_board of every view with a solution, by camera and instant.
using Sightings = std::vector<std::map<int, RigidTransform>>;

Sightings locate_boards(std::span<const BoardView> views,
                        std::span<const Intrinsics> intrinsics) {
  Sightings sightings(intrinsics.size());
  for (const BoardView& view : views) {
    const std::size_t c = index(view.camera);
    if (const auto pose = camera_from_board(intrinsics[c], view)) {
      sightings[c][view.instant] = *pose;
    }
  }
  return sightings;
}

/// Returns the consensus of the relative poses at the instants that both cameras see.
std::optional<Link> connect(const Sightings& sightings, std::size_t a, std::size_t b) {
  std::vector<RigidTransform> candidates;
  for (const auto& [instant, a_from_board] : sightings[a]) {
    const auto other = sightings[b].find(instant);
    if (other == sightings[b].end()) continue;
    candidates.push_back(a_from_board * inverse(other->second));
  }
  if (candidates.empty()) return std::nullopt;
  return medoid_transform(a, b, candidates);
}

/// Returns the sum over the views of one instant of the median corner error. [px]
double misfit_px(std::span<const BoardView* const> views,
                 std::span<const Intrinsics> intrinsics,
                 const RigGuess& guess,
                 const RigidTransform& world_from_board) {
  double sum = 0.0;
  for (const BoardView* view : views) {
    const std::size_t c = index(view->camera);
    const Camera camera{{}, intrinsics[c], guess.camera_from_world[c], {}};
    sum += median_error_px(*view, camera, world_from_board);
  }
  return sum;
}

/// Returns, per instant, the pose with the lowest total error among those estimated from
/// single views: a single view of a plane is ambiguous, several views together are not.
std::map<int, RigidTransform> place_boards(std::span<const BoardView> views,
                                           std::span<const Intrinsics> intrinsics,
                                           const Sightings& sightings,
                                           const RigGuess& guess) {
  std::map<int, std::vector<const BoardView*>> by_instant;
  for (const BoardView& view : views) by_instant[view.instant].push_back(&view);
  std::map<int, RigidTransform> world_from_board;
  for (const auto& [instant, instant_views] : by_instant) {
    double best = std::numeric_limits<double>::infinity();
    for (const BoardView* view : instant_views) {
      const std::size_t c = index(view->camera);
      const auto seen = sightings[c].find(instant);
      if (seen == sightings[c].end()) continue;
      const RigidTransform candidate = inverse(guess.camera_from_world[c]) * seen->second;
      const double misfit = misfit_px(instant_views, intrinsics, guess, candidate);
      if (misfit < best) {
        best = misfit;
        world_from_board[instant] = candidate;
      }
    }
  }
  return world_from_board;
}

std::string list(std::span<const std::string> names, std::span<const bool> chosen) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (chosen[i]) text += (text.empty() ? "" : ", ") + names[i];
  }
  return text;
}

Error not_connected(std::span<const std::string> names,
                    const std::vector<std::optional<RigidTransform>>& placed) {
  const auto reached = std::make_unique<bool[]>(names.size());
  const auto missed = std::make_unique<bool[]>(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    reached[i] = placed[i].has_value();
    missed[i] = !reached[i];
  }
  return bad_input(
      "",
      "no camera of {" + list(names, {reached.get(), names.size()}) +
          "} sees the board at the same "
          "time as a camera of {" +
          list(names, {missed.get(), names.size()}) + "}",
      "record the calibration again and hold the board where both groups see it");
}

}  // namespace

RigidTransform world_from_floor_board(const CalibrationTarget& board) {
  // Rotates by -90 degrees about X: board y goes to -Z, board z (out of the face) to +Y.
  return {rotation_from_vector({-glm::radians(90.0), 0.0, 0.0}),
          {0.0, thickness_m(board), 0.0}};
}

RigidTransform world_from_upright_camera() {
  return {rotation_from_vector({std::numbers::pi, 0.0, 0.0}), glm::dvec3(0.0)};
}

Result<RigGuess> place_cameras(std::span<const BoardView> views,
                               std::span<const Intrinsics> intrinsics,
                               std::span<const std::string> names,
                               const CalibrationTarget& board,
                               bool needs_floor) {
  const Sightings sightings = locate_boards(views, intrinsics);
  std::vector<Link> edges;
  for (std::size_t a = 0; a < sightings.size(); ++a) {
    for (std::size_t b = a + 1; b < sightings.size(); ++b) {
      if (const auto edge = connect(sightings, a, b)) edges.push_back(*edge);
    }
  }
  const auto camera_from_first = propagate_poses(0, edges, sightings.size());
  for (const auto& placed : camera_from_first) {
    if (!placed) return not_connected(names, camera_from_first);
  }

  // The floor board's pose is from the camera with the most corners on it.
  const BoardView* floor = nullptr;
  for (const BoardView& view : views) {
    const bool larger = !floor || view.corners.size() > floor->corners.size();
    if (view.instant == kFloorInstant && larger &&
        sightings[index(view.camera)].contains(kFloorInstant)) {
      floor = &view;
    }
  }
  if (!floor && needs_floor) {
    return bad_input("",
                     "no camera sees the board lying on the floor",
                     "record a floor trial in which at least three tags of the board are "
                     "in view");
  }
  RigidTransform first_from_world = inverse(world_from_upright_camera());
  if (floor) {
    const std::size_t f = index(floor->camera);
    first_from_world = inverse(*camera_from_first[f]) * sightings[f].at(kFloorInstant) *
                       inverse(world_from_floor_board(board));
  }
  RigGuess guess;
  for (const auto& placed : camera_from_first) {
    guess.camera_from_world.push_back(*placed * first_from_world);
  }
  guess.world_from_board = place_boards(views, intrinsics, sightings, guess);
  if (floor) guess.world_from_board[kFloorInstant] = world_from_floor_board(board);
  return guess;
}

}  // namespace marey::calib
