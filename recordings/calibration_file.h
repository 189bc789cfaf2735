// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/camera_quality.h"
#include "core/result.h"

namespace marey::recordings {

/// A camera's clock against the first camera's.
struct CameraClock {
  double offset_s = 0.0;  ///< Frame k was exposed at k / rate + offset.
  double drift_ppm = 0.0;
};

/// calibration.toml.
struct Calibration {
  std::vector<Camera> cameras;
  std::vector<CameraQuality> quality;  ///< Per camera.
  std::vector<CameraClock> clocks;     ///< Per camera.
  double rms_px = 0.0;                 ///< Over all corners of all cameras.
};

/// The text of calibration.toml: a table per camera, named after it, with Pose2Sim's and
/// Caliscope's keys (size, matrix, distortions, rotation, translation, fisheye) and
/// marey's own. docs/formats.md has them all. parse_calibration() gives the same doubles.
/// Precondition: one quality and one clock per camera; every number finite.
[[nodiscard]] std::string calibration_text(const Calibration& calibration);

/// Writes calibration_text() to `path`, at once or not at all.
[[nodiscard]] Status write_calibration(const std::filesystem::path& path,
                                       const Calibration& calibration);

/// Reads marey's calibration.toml, or Pose2Sim's or Caliscope's: their keys are enough,
/// four distortion terms do, and keys it does not know are passed over. The world is
/// taken as it is; theirs may have Z up. `file` is what error messages call the text.
///
/// Errors (kBadInput), with the line: not TOML; a key missing or of the wrong type; a
/// fisheye or skewed camera; a pose whose forms disagree (`rotation` was edited but
/// `rotation_wxyz` or `world_from_camera` was not); no camera.
[[nodiscard]] Result<Calibration> parse_calibration(std::string_view text,
                                                    const std::string& file);

/// parse_calibration() of the file at `path`.
[[nodiscard]] Result<Calibration> read_calibration(const std::filesystem::path& path);

}  // namespace marey::recordings
