// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Simulated detections of tags on moving things, by cameras that may have a fault.

#include <functional>
#include <vector>

#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/simulated_calibration.h"

namespace marey::testing {

/// A simulated calibration while it is drawn.
struct SimulationDraw {
  Dice dice;
  SimulationOptions options;
  SimulatedCalibration out;
  double line_delay_s = 0.0;  ///< Per row, of every camera.
  AprilGrid real_board;
  Camera moved;    ///< kNudged, kNudgedAfter: the camera afterwards.
  int frames = 0;  ///< Number of waved frames.
};

/// A tag on a filmed object.
struct FilmedTag {
  TagId id{};
  double size_m = 0.0;
  RigidTransform thing_from_tag;
};

/// Returns the tags of a board.
[[nodiscard]] std::vector<FilmedTag> tags_of(const AprilGrid& board);

/// Returns the tags on four sides of a box, its lid and its bottom, with ids from 0.
[[nodiscard]] std::vector<FilmedTag> wand_tags(double size_m);

/// Returns eighteen tags around a body, from shin to shoulder, with ids from 100. Their
/// sizes are 6 to 9 cm times `factor`.
[[nodiscard]] std::vector<FilmedTag> worn_tags(Dice& dice, double factor);

/// The part of a session that is filmed.
enum class Reel { kWaved, kFloor, kMotion };

/// Returns a camera, with its fault, as it is in a frame.
[[nodiscard]] Camera camera_in(const SimulationDraw& draw,
                               std::size_t c,
                               Reel reel,
                               int frame);

/// Adds to the frames of `out`, one entry per camera, the detections of `tags` on a thing
/// that is at world_from_thing = `thing_at`(time [s]).
void film(SimulationDraw& draw,
          const std::vector<FilmedTag>& tags,
          const std::function<RigidTransform(double)>& thing_at,
          Reel reel,
          std::vector<CameraDetections>& out);

}  // namespace marey::testing
