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
  double line_delay_s = 0.0;  ///< From one row of the image to the next.
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

/// Reads marey's calibration.toml, or Pose2Sim's, anipose's or Caliscope's (its
/// camera_array.toml too): their keys are enough, four distortion terms do, `rotation`
/// may be a matrix, and keys it does not know are passed over. The world is taken as it
/// is; theirs may have Z up. Lengths must be metres. `file` is what error messages call
/// the text.
///
/// Errors (kBadInput), with the line: not TOML; a key missing or of the wrong type; a
/// skewed camera; a pose whose forms disagree (`rotation` was edited but `rotation_wxyz`
/// or `world_from_camera` was not); another program's camera more than 100 m from the
/// origin, so not in metres; no camera.
[[nodiscard]] Result<Calibration> parse_calibration(std::string_view text,
                                                    const std::string& file);

/// parse_calibration() of the file at `path`, or, told by the content, another program's
/// YAML or XML. All have pixel centres at integers and cameras x right, y down, z
/// forward; lengths are taken for metres, which Kalibr and TagSLAM write:
/// - OpenCV's FileStorage: a lens (camera_matrix, distortion_coefficients, image_width,
///   image_height) or a pair (M1, D1, M2, D2, R, T; R and T may be in extrinsics.yml
///   beside it). Cameras are cam1 and cam2; the world is the first camera's frame.
///   ROS's camera_info files have these keys.
/// - Kalibr's camchain: cam0, cam1..., pinhole with radtan or equidistant. The world is
///   cam0's frame. Clocks (timeshift_cam_imu) are passed over.
/// - TagSLAM's cameras.yaml with camera_poses.yaml beside it. The world is the rig's.
/// A single camera without a pose stands at the origin.
///
/// Errors (kBadInput), with the line where there is one: as above; several cameras and
/// not where they stand; a lens or camera model that LensModel does not have; no size of
/// the pictures; places that cannot be metres.
[[nodiscard]] Result<Calibration> read_calibration(const std::filesystem::path& path);

/// The same, of which only the lenses are wanted: of several cameras in YAML it need not
/// say where they stand (Kalibr's and TagSLAM's cameras.yaml), nor are poses beside the
/// file read. A camera without a pose stands at the origin.
[[nodiscard]] Result<Calibration> read_lenses(const std::filesystem::path& path);

/// The file holds cameras rather than a session, by its content: YAML, XML, or TOML with
/// a lens's matrix in it. Cost: reads it.
[[nodiscard]] bool is_calibration(const std::filesystem::path& path);

}  // namespace marey::recordings
