// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/simulated_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/filmed_tags.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::testing {
namespace {

/// A sum of three swings of a hand.
struct Swing {
  std::array<double, 3> size{};
  std::array<double, 3> speed{};
  std::array<double, 3> phase{};

  Swing(Dice& dice, double amplitude, double fastest) {
    for (std::size_t i = 0; i < 3; ++i) {
      size[i] = amplitude * dice.between(0.2, 0.6);
      speed[i] = fastest * dice.between(0.25, 1.0);
      phase[i] = dice.between(0.0, 2.0 * std::numbers::pi);
    }
  }
  [[nodiscard]] double at(double time_s) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += size[i] * std::sin(speed[i] * time_s + phase[i]);
    }
    return sum;
  }
};

/// The motion of the waved board: its face looks from camera to camera.
struct Wave {
  Swing x, y, z, tilt, roll, yaw;
  std::vector<double> headings_rad;  ///< Towards the cameras, in turn.
  double seconds = 0.0;
  glm::dvec3 middle_in_board{0.0};

  [[nodiscard]] RigidTransform at(double time_s) const {
    const double place = std::clamp(time_s / seconds, 0.0, 1.0) *
                         static_cast<double>(headings_rad.size() - 1);
    const auto first = static_cast<std::size_t>(
        std::min(std::floor(place), static_cast<double>(headings_rad.size() - 2)));
    const double share = place - static_cast<double>(first);
    const double smooth = share * share * (3.0 - 2.0 * share);
    const double heading =
        headings_rad[first] + smooth * (headings_rad[first + 1] - headings_rad[first]);
    const glm::dquat turn = rotation_from_vector({0.0, heading + yaw.at(time_s), 0.0}) *
                            rotation_from_vector({tilt.at(time_s) - 0.15, 0.0, 0.0}) *
                            rotation_from_vector({0.0, 0.0, roll.at(time_s)});
    const glm::dvec3 place_in_world(x.at(time_s), 1.1 + y.at(time_s), z.at(time_s));
    return {turn, place_in_world - turn * middle_in_board};
  }
};

Camera draw_camera(Dice& dice, std::size_t c, double heading_rad, double width_px) {
  const double away_m = dice.between(2.2, 3.8);
  const glm::dvec3 place(away_m * std::sin(heading_rad),
                         dice.between(1.0, 2.5),
                         away_m * std::cos(heading_rad));
  const glm::dvec3 target(
      dice.between(-0.2, 0.2), dice.between(0.85, 1.15), dice.between(-0.2, 0.2));
  Camera camera = webcam_at("cam" + std::to_string(c), place, target);
  Intrinsics& k = camera.intrinsics;
  k.width_px = static_cast<int>(width_px);
  k.height_px = static_cast<int>(width_px < 700.0 ? 0.75 * width_px : 0.5625 * width_px);
  k.focal_px = glm::dvec2(dice.between(0.6, 0.95) * width_px);
  k.centre_px = {0.5 * k.width_px + dice.noise(0.008 * width_px),
                 0.5 * k.height_px + dice.noise(0.008 * width_px)};
  k.distortion = {dice.between(-0.2, 0.03),
                  dice.between(0.0, 0.04),
                  dice.noise(3e-4),
                  dice.noise(3e-4),
                  0.0};
  camera.tag_shrinkage = {dice.between(0.0, 0.25), dice.between(-0.003, 0.003)};
  return camera;
}

void draw_rig(SimulationDraw& draw) {
  Dice& dice = draw.dice;
  const auto count = static_cast<std::size_t>(dice.between(2.0, 6.99));
  const std::array<double, 3> widths{640.0, 1280.0, 1920.0};
  const double width_px = widths[static_cast<std::size_t>(dice.between(0.0, 2.99))];
  // A ring, or an arc: two cameras are never opposite each other.
  const double arc_rad = count > 3 && dice.between(0.0, 1.0) < 0.5
                             ? 2.0 * std::numbers::pi * static_cast<double>(count - 1) /
                                   static_cast<double>(count)
                             : dice.between(0.35, 0.6) * static_cast<double>(count - 1);
  const double first_rad = dice.between(0.0, 2.0 * std::numbers::pi);
  for (std::size_t c = 0; c < count; ++c) {
    const double heading_rad =
        first_rad + arc_rad * static_cast<double>(c) / static_cast<double>(count - 1) +
        dice.between(-0.12, 0.12);
    draw.out.truth.push_back(draw_camera(dice, c, heading_rad, width_px));
  }
  AprilGrid& board = draw.out.board;
  board.rows = static_cast<int>(dice.between(4.0, 5.99));
  board.columns = static_cast<int>(dice.between(4.0, 6.99));
  board.tag_size_m = dice.between(0.095, 0.12) * (width_px < 700.0 ? 1.25 : 1.0);
  board.gap_m = 0.3 * board.tag_size_m;
  board.thickness_m = 0.005;
  draw.real_board = board;
}

Wave draw_wave(SimulationDraw& draw, double seconds) {
  Dice& dice = draw.dice;
  const double brisk = dice.between(0.7, 1.4);
  Wave wave{Swing(dice, 0.5, 1.6 * brisk),
            Swing(dice, 0.45, 1.6 * brisk),
            Swing(dice, 0.5, 1.6 * brisk),
            Swing(dice, 0.55, 2.5 * brisk),
            Swing(dice, 0.5, 2.2 * brisk),
            Swing(dice, 0.5, 2.2 * brisk),
            {},
            seconds,
            {}};
  const auto corner = [&](int id, int i) {
    return *draw.real_board.corner_in_board(TagId{id}, i);
  };
  wave.middle_in_board =
      0.5 * (corner(0, 0) + corner(draw.real_board.tag_count() - 1, 2));
  // From camera to camera and back, between each two a while where both see it.
  const auto& cameras = draw.out.truth;
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const std::size_t c = round == 0 ? i : cameras.size() - 1 - i;
      const glm::dvec3 place = centre_in_world(cameras[c]);
      double heading = std::atan2(place.x, place.z);
      if (!wave.headings_rad.empty()) {
        const double last = wave.headings_rad.back();
        heading = last + std::remainder(heading - last, 2.0 * std::numbers::pi);
      }
      wave.headings_rad.push_back(heading);
    }
  }
  return wave;
}

void draw_fault(SimulationDraw& draw, int frames) {
  Dice& dice = draw.dice;
  SimulatedCalibration& out = draw.out;
  const RigFault fault = out.fault;
  const auto any = static_cast<std::size_t>(
      dice.between(0.0, static_cast<double>(out.truth.size()) - 0.01));
  out.late_s.assign(out.truth.size(), 0.0);
  if (fault == RigFault::kNudged || fault == RigFault::kNudgedAfter) {
    out.camera = any;
    out.from_frame = static_cast<int>(dice.between(0.25, 0.75) * frames);
    out.amount_px = draw.options.amount_px.value_or(dice.between(1.0, 10.0));
    const Intrinsics& k = out.truth[any].intrinsics;
    // Turned across its view, pixels move alike; a knock also shifts it.
    const double way_rad = dice.between(0.0, 2.0 * std::numbers::pi);
    const double turn_rad = out.amount_px / k.focal_px.x;
    const glm::dvec3 axis(
        std::cos(way_rad), std::sin(way_rad), 0.5 * dice.between(-1.0, 1.0));
    const RigidTransform moved_from_camera{rotation_from_vector(turn_rad * axis),
                                           0.002 * dice.direction()};
    draw.moved = out.truth[any];
    draw.moved.camera_from_world = moved_from_camera * draw.moved.camera_from_world;
  } else if (fault == RigFault::kRollingShutter) {
    out.picture_s = draw.options.picture_s.value_or(dice.between(0.005, 0.03));
    draw.line_delay_s = out.picture_s / out.truth[0].intrinsics.height_px;
  } else if (fault == RigFault::kLate) {
    for (std::size_t c = 1; c < out.truth.size(); ++c) {
      out.late_s[c] = dice.between(-1.0, 1.0);
    }
  } else if (fault == RigFault::kWrongRate || fault == RigFault::kMirrored ||
             fault == RigFault::kStrayTags || fault == RigFault::kSwappedFloor ||
             fault == RigFault::kSwappedTrial || fault == RigFault::kFlipped ||
             fault == RigFault::kRarelySeen) {
    out.camera = any;
    out.from_frame = static_cast<int>(dice.between(0.1, 0.8) * frames);
  } else if (fault == RigFault::kFocalDrift || fault == RigFault::kRefocused) {
    out.camera = any;
    out.from_frame = static_cast<int>(dice.between(0.3, 0.7) * frames);
    out.focal_share = dice.between(0.003, 0.03) * (dice.between(0.0, 1.0) < 0.5 ? -1 : 1);
  } else if (fault == RigFault::kWrongSize) {
    out.board.tag_size_m *= 1.03;
    out.board.gap_m -= 0.03 * draw.real_board.tag_size_m;
  } else if (fault == RigFault::kWrongIds) {
    out.board.first_id = 1;
  }
}

/// Films a body that stands, then walks about, with the cameras as they are by then.
void film_motions(SimulationDraw& draw) {
  constexpr double kStanding_s = 3.0;
  constexpr double kWalk_s = 5.0;
  Dice& dice = draw.dice;
  const double size = draw.out.truth[0].intrinsics.width_px < 700 ? 1.5 : 1.0;
  std::vector<FilmedTag> tags = worn_tags(dice, size);
  for (const FilmedTag& tag : tags) draw.out.worn.push_back({tag.id, tag.size_m});
  const Swing sway(dice, 0.01, 2.0);
  const double heading_rad = dice.between(0.0, 2.0 * std::numbers::pi);
  const auto frames = [&](double seconds) {
    return static_cast<int>(seconds * draw.out.rate_hz);
  };
  draw.out.standing =
      unseeing(draw.out.truth, frames(kStanding_s), draw.out.rate_hz, "static");
  film(
      draw,
      tags,
      [&](double time_s) {
        return RigidTransform{rotation_from_vector({0.0, heading_rad, 0.0}),
                              {sway.at(time_s), 0.0, 0.0}};
      },
      Reel::kMotion,
      draw.out.standing);
  const Swing x(dice, 0.6, 1.5);
  const Swing z(dice, 0.6, 1.5);
  draw.out.walk = unseeing(draw.out.truth, frames(kWalk_s), draw.out.rate_hz, "walk");
  film(
      draw,
      tags,
      [&](double time_s) {
        return RigidTransform{
            rotation_from_vector({0.0, heading_rad + 1.2 * time_s, 0.0}),
            {x.at(time_s), 0.02 * std::sin(12.0 * time_s), z.at(time_s)}};
      },
      Reel::kMotion,
      draw.out.walk);
}

/// Returns the camera whose pictures are those of `camera`, turned by 180 degrees.
Camera flipped(Camera camera) {
  const RigidTransform turn{rotation_from_vector({0.0, 0.0, std::numbers::pi}),
                            glm::dvec3(0.0)};
  camera.camera_from_world = turn * camera.camera_from_world;
  Intrinsics& k = camera.intrinsics;
  k.centre_px = {k.width_px - 1 - k.centre_px.x, k.height_px - 1 - k.centre_px.y};
  k.distortion[2] *= -1.0;
  k.distortion[3] *= -1.0;
  return camera;
}

/// Applies the faults of files, not of cameras.
void spoil_files(SimulationDraw& draw) {
  SimulatedCalibration& out = draw.out;
  if (!out.camera) return;
  const std::size_t c = *out.camera;
  const std::size_t other = (c + 1) % out.truth.size();
  if (out.fault == RigFault::kSwappedFloor) {
    std::swap(out.floor[c].frames, out.floor[other].frames);
  } else if (out.fault == RigFault::kSwappedTrial) {
    std::swap(out.walk[c].frames, out.walk[other].frames);
    std::swap(out.standing[c].frames, out.standing[other].frames);
  } else if (out.fault == RigFault::kWrongRate) {
    out.waved[c].rate.hz *= 5.0 / 6.0;
  } else if (out.fault == RigFault::kFlipped) {
    out.truth[c] = flipped(out.truth[c]);
  }
}

}  // namespace

const char* name_of(RigFault fault) {
  switch (fault) {
    case RigFault::kNone:
      return "none";
    case RigFault::kNudged:
      return "nudged";
    case RigFault::kRollingShutter:
      return "rolling";
    case RigFault::kLate:
      return "late";
    case RigFault::kWrongRate:
      return "wrong-rate";
    case RigFault::kWrongSize:
      return "wrong-size";
    case RigFault::kMirrored:
      return "mirrored";
    case RigFault::kSwappedFloor:
      return "swapped-floor";
    case RigFault::kWrongIds:
      return "wrong-ids";
    case RigFault::kStrayTags:
      return "stray-tags";
    case RigFault::kNudgedAfter:
      return "nudged-after";
    case RigFault::kFlipped:
      return "flipped";
    case RigFault::kFocalDrift:
      return "focal-drift";
    case RigFault::kRefocused:
      return "refocused";
    case RigFault::kRarelySeen:
      return "rarely-seen";
    case RigFault::kSwappedTrial:
      return "swapped-trial";
  }
  return "";
}

SimulatedCalibration simulate_calibration(std::uint64_t seed,
                                          const SimulationOptions& options) {
  constexpr int kFloorFrames = 8;
  SimulationDraw draw{Dice(seed * 7919 + 17), options, {}, 0.0, {}, {}, 0};
  Dice& dice = draw.dice;
  draw.out.fault = options.fault;
  draw_rig(draw);
  const std::array<double, 4> rates{7.5, 10.0, 12.0, 15.0};
  draw.out.rate_hz = rates[static_cast<std::size_t>(dice.between(0.0, 3.99))];
  // So that each camera is shown the board for some seconds.
  const double drawn_s = dice.between(6.0, 12.0);
  const double seconds = options.seconds.value_or(
      std::max(drawn_s, 2.0 * static_cast<double>(draw.out.truth.size())));
  const int frames = static_cast<int>(seconds * draw.out.rate_hz);
  const Wave wave = draw_wave(draw, seconds);
  draw.frames = frames;
  draw_fault(draw, frames);
  const bool has_floor =
      !options.with_wand &&
      (options.fault == RigFault::kSwappedFloor || dice.between(0.0, 1.0) < 0.7);
  std::vector<FilmedTag> tags = tags_of(draw.real_board);
  if (options.with_wand) {
    tags = wand_tags(draw.out.truth[0].intrinsics.width_px < 700 ? 0.22 : 0.16);
    draw.out.wand.emplace();
    for (const FilmedTag& tag : tags) draw.out.wand->tags.push_back({tag.id, tag.size_m});
  }
  draw.out.waved = unseeing(draw.out.truth, frames, draw.out.rate_hz, "calibration");
  film(
      draw,
      tags,
      [&](double time_s) {
        const RigidTransform world_from_board = wave.at(time_s);
        if (!options.with_wand) return world_from_board;
        return RigidTransform{world_from_board.rotation,
                              world_from_board * wave.middle_in_board};
      },
      Reel::kWaved,
      draw.out.waved);
  if (has_floor) {
    draw.out.floor = unseeing(draw.out.truth, kFloorFrames, draw.out.rate_hz, "floor");
    const RigidTransform on_floor{
        rotation_from_vector({-0.5 * std::numbers::pi, 0.0, 0.0}),
        {0.0, draw.real_board.thickness_m, 0.0}};
    film(
        draw, tags, [&](double) { return on_floor; }, Reel::kFloor, draw.out.floor);
  }
  film_motions(draw);
  if (draw.out.camera) {
    draw.out.moved = camera_in(draw, *draw.out.camera, Reel::kMotion, 0);
  }
  spoil_files(draw);
  if (options.fault == RigFault::kFlipped) draw.out.moved = flipped(*draw.out.moved);
  return draw.out;
}

}  // namespace marey::testing
