// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/board.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::testing {

/// Fault of a simulated calibration.
enum class RigFault {
  kNone,
  kNudged,          ///< One camera is moved while the board is waved.
  kNudgedAfter,     ///< One camera is moved after the calibration, before the motions.
  kRollingShutter,  ///< Every camera reads its rows one after the other.
  kLate,            ///< Cameras start up to two seconds apart.
  kWrongRate,       ///< One video states 5/6 of its rate.
  kWrongSize,       ///< Tags measured 3 % too large, gaps as they are.
  kMirrored,        ///< One video is a mirror image.
  kSwappedFloor,    ///< Two cameras' floor videos are exchanged.
  kWrongIds,        ///< The board starts with another id than declared.
  kStrayTags,       ///< One camera sees a twelfth of the tags 5 to 30 px off.
  kFlipped,         ///< One camera's pictures are turned by 180 degrees, all of them.
  kFocalDrift,      ///< One camera's focal length drifts while the board is waved.
  kRefocused,       ///< One camera's focal length jumps: two halves that disagree.
  kRarelySeen,      ///< One camera sees the board in a few frames only.
  kSwappedTrial,    ///< Two cameras' videos of the motions are exchanged.
};

[[nodiscard]] const char* name_of(RigFault fault);

/// A tag that is worn on a body.
struct WornTag {
  TagId id{};
  double size_m = 0.0;
};

/// A calibration computed at the level of corners, with its truth.
struct SimulatedCalibration {
  std::vector<Camera> truth;
  AprilGrid board;           ///< As it is declared.
  std::optional<Wand> wand;  ///< Instead of the board.
  double rate_hz = 0.0;
  std::vector<CameraDetections> waved;
  std::vector<CameraDetections> floor;  ///< Empty: there is no floor trial.
  /// Trials after the calibration: a body stands still, then walks about.
  std::vector<CameraDetections> standing;
  std::vector<CameraDetections> walk;
  std::vector<WornTag> worn;
  std::optional<Camera> moved;  ///< The camera at fault, as it filmed the motions.
  RigFault fault = RigFault::kNone;
  std::optional<std::size_t> camera;  ///< The one that is at fault.
  int from_frame = 0;                 ///< kNudged, kRefocused, kRarelySeen.
  double amount_px = 0.0;      ///< kNudged, kNudgedAfter: how far its picture moves.
  double focal_share = 0.0;    ///< kFocalDrift, kRefocused: by how much it changes.
  double picture_s = 0.0;      ///< kRollingShutter: first row to last.
  std::vector<double> late_s;  ///< Per camera.
};

struct SimulationOptions {
  RigFault fault = RigFault::kNone;
  std::optional<double> amount_px;  ///< kNudged, kNudgedAfter; otherwise 1 to 10.
  std::optional<double> picture_s;  ///< kRollingShutter; otherwise 0.005 to 0.03.
  std::optional<double> seconds;    ///< Duration of the waving; otherwise 6 to 12.
  bool with_wand = false;           ///< A box of six tags is waved, no board.
};

/// Two to six cameras around a person's volume, drawn by the seed: places, lenses,
/// picture sizes, rate, board and a hand's movement. Corners err by the detector's law
/// (0.39 px over the root of a tag's side), by a smooth field of 0.02 px per lens, and in
/// one tag of 200 grossly. The same bytes for the same seed on every machine.
[[nodiscard]] SimulatedCalibration simulate_calibration(
    std::uint64_t seed, const SimulationOptions& options = {});

}  // namespace marey::testing
