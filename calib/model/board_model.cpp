// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/board_model.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "calib/model/estimate_intrinsics.h"
#include "core/base/assert.h"

namespace marey::calib {
namespace {

constexpr std::size_t kFloor = 0;

RigModel empty_model(std::span<const Intrinsics> intrinsics, const RigGuess& guess) {
  RigModel model;
  for (std::size_t c = 0; c < intrinsics.size(); ++c) {
    RigCamera camera;
    camera.intrinsics = intrinsics[c];
    camera.world_from_camera = inverse(guess.camera_from_world[c]);
    model.cameras.push_back(camera);
  }
  RigidTarget floor;
  floor.stays = true;
  const auto found = guess.world_from_board.find(kFloorInstant);
  if (found != guess.world_from_board.end()) floor.world_from_target[0] = found->second;
  model.targets.push_back(floor);
  return model;
}

RigidTarget board_target(const CalibrationTarget& board) {
  RigidTarget target;
  const BoardExtent extent = extent_of(board);
  target.middle_in_target = 0.5 * (extent.min_in_board + extent.max_in_board);
  target.half_extent_m =
      glm::max(0.5 * (extent.max_in_board - extent.min_in_board), 1e-3);
  return target;
}

void add_view(const BoardView& view,
              std::size_t target,
              int instant,
              double time_s,
              RigModel& model) {
  const std::size_t step = view.of_tags ? 4 : 1;
  for (std::size_t first = 0; first + step <= view.corners.size(); first += step) {
    Sighting sighting;
    sighting.camera = index(view.camera);
    sighting.target = target;
    sighting.instant = instant;
    sighting.frame = view.instant;
    sighting.time_s = time_s;
    sighting.count = static_cast<int>(step);
    std::copy_n(view.corners.begin() + static_cast<std::ptrdiff_t>(first),
                step,
                sighting.corners.begin());
    model.sightings.push_back(sighting);
  }
}

}  // namespace

RigModel still_model(std::span<const BoardView> views,
                     std::span<const Intrinsics> intrinsics,
                     const RigGuess& guess,
                     const CalibrationTarget& board) {
  RigModel model = empty_model(intrinsics, guess);
  model.targets.push_back(board_target(board));
  for (const auto& [instant, pose] : guess.world_from_board) {
    if (instant != kFloorInstant) model.targets[1].world_from_target[instant] = pose;
  }
  for (const BoardView& view : views) {
    if (view.instant == kFloorInstant) {
      add_view(view, kFloor, 0, 0.0, model);
    } else {
      add_view(view, 1, view.instant, 0.0, model);
    }
  }
  return model;
}

std::vector<double> parts_of_motion(std::span<const TimedPose> poses, double spacing_s) {
  constexpr double kMaxBoardSpeed_m_s = 5.0;
  constexpr double kMaxBoardTurn_rad_s = 12.0;
  std::vector<double> starts;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i == 0) {
      starts.push_back(poses[i].time_s);
      continue;
    }
    const double apart_s = poses[i].time_s - poses[i - 1].time_s;
    // Two views at nearly the same time differ only by noise.
    const double run_s = std::max(apart_s, 0.5 * spacing_s);
    const RigidTransform& a = poses[i - 1].world_from_target;
    const RigidTransform& b = poses[i].world_from_target;
    const double turned_rad =
        glm::length(rotation_vector(glm::conjugate(a.rotation) * b.rotation));
    const bool jumps =
        glm::distance(a.translation, b.translation) > kMaxBoardSpeed_m_s * run_s ||
        turned_rad > kMaxBoardTurn_rad_s * run_s + 0.3;
    if (jumps || apart_s > 6.0 * spacing_s) starts.push_back(poses[i].time_s);
  }
  return starts;
}

std::map<int, RigidTransform> knots_through(std::span<const TimedPose> poses,
                                            double spacing_s) {
  MAREY_ASSERT(!poses.empty());
  std::map<int, RigidTransform> knots;
  const int first = static_cast<int>(std::floor(poses.front().time_s / spacing_s)) - 2;
  const int last = static_cast<int>(std::floor(poses.back().time_s / spacing_s)) + 3;
  for (int knot = first; knot <= last; ++knot) {
    const double time_s = knot * spacing_s;
    const auto after = std::lower_bound(
        poses.begin(), poses.end(), time_s, [](const TimedPose& p, double t) {
          return p.time_s < t;
        });
    if (after == poses.begin() || after == poses.end()) {
      knots[knot] =
          (after == poses.end() ? poses.back() : poses.front()).world_from_target;
      continue;
    }
    const TimedPose& a = *(after - 1);
    const TimedPose& b = *after;
    const double share = (time_s - a.time_s) / std::max(1e-9, b.time_s - a.time_s);
    knots[knot] = {
        glm::slerp(a.world_from_target.rotation, b.world_from_target.rotation, share),
        glm::mix(
            a.world_from_target.translation, b.world_from_target.translation, share)};
  }
  return knots;
}

RigModel moving_model(std::span<const BoardView> views,
                      std::span<const Intrinsics> intrinsics,
                      const RigGuess& guess,
                      const CalibrationTarget& board,
                      std::span<const CameraDetections> waved,
                      std::span<const double> offsets_s) {
  RigModel model = empty_model(intrinsics, guess);
  double spacing_s = 1.0;
  for (std::size_t c = 0; c < waved.size(); ++c) {
    spacing_s = std::min(spacing_s, 1.0 / waved[c].rate.hz);
    model.cameras[c].offset_s = offsets_s[c];
  }
  spacing_s = std::max(spacing_s, 1.0 / 60.0);
  const auto time_of = [&](const BoardView& view) {
    const std::size_t c = index(view.camera);
    return view.instant / waved[c].rate.hz;
  };
  std::vector<TimedPose> poses;
  for (const BoardView& view : views) {
    if (view.instant == kFloorInstant) {
      add_view(view, kFloor, 0, 0.0, model);
      continue;
    }
    const std::size_t c = index(view.camera);
    const auto pose = camera_from_board(intrinsics[c], view);
    if (!pose) continue;
    poses.push_back(
        {time_of(view) + offsets_s[c], inverse(guess.camera_from_world[c]) * *pose});
  }
  std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) {
    return a.time_s < b.time_s;
  });
  const std::vector<double> starts = parts_of_motion(poses, spacing_s);
  auto next = poses.begin();
  for (std::size_t part = 0; part < starts.size(); ++part) {
    auto end = poses.end();
    if (part + 1 < starts.size()) {
      end = std::find_if(
          next, end, [&](const TimedPose& p) { return p.time_s >= starts[part + 1]; });
    }
    RigidTarget target = board_target(board);
    target.knot_spacing_s = spacing_s;
    if (part > 0) target.same_board_as = 1;
    if (next != end) target.world_from_target = knots_through({next, end}, spacing_s);
    model.targets.push_back(std::move(target));
    next = end;
  }
  for (const BoardView& view : views) {
    if (view.instant == kFloorInstant) continue;
    const double time_s = time_of(view);
    const double seen_s = time_s + offsets_s[index(view.camera)];
    const auto part =
        std::upper_bound(starts.begin(), starts.end(), seen_s + 1e-9) - starts.begin();
    if (part > 0) add_view(view, static_cast<std::size_t>(part), 0, time_s, model);
  }
  return model;
}

}  // namespace marey::calib
