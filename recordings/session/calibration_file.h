// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/camera.h"
#include "core/camera_quality.h"
#include "recordings/session/calibration.h"

namespace marey::recordings {

/// Returns the text of calibration.toml: a table per camera, named after it, with the
/// keys of Pose2Sim and Caliscope (size, matrix, distortions, rotation, translation,
/// fisheye) and marey's own. docs/formats/calibration.md lists them all.
/// parse_calibration() returns the same doubles. Precondition: one quality and one clock
/// per camera; every number is finite.
[[nodiscard]] std::string calibration_text(const Calibration& calibration);

/// Writes calibration_text() to `path`. The file is replaced as a whole or not at all.
[[nodiscard]] Status write_calibration(const std::filesystem::path& path,
                                       const Calibration& calibration);

/// Reads a calibration.toml of marey, Pose2Sim, anipose or Caliscope (also its
/// camera_array.toml). The common keys are enough: four distortion terms suffice,
/// `rotation` may be a matrix, and unknown keys are ignored. The world is taken as it is;
/// other programs may use Z up. Lengths must be in metres. `file` is the name of the text
/// in error messages.
///
/// Errors (kBadInput), with the line: not TOML; a key missing or of the wrong type; a
/// skewed camera; a pose whose forms disagree (`rotation` was edited but `rotation_wxyz`
/// or `world_from_camera` was not); another program's camera more than 100 m from the
/// origin, which is therefore not in metres; no camera.
[[nodiscard]] Result<Calibration> parse_calibration(std::string_view text,
                                                    const std::string& file);

/// Applies parse_calibration() to the file at `path`, or reads another program's YAML or
/// XML, detected by its content. All have pixel centres at integers and cameras x right,
/// y down, z forward. Lengths are taken as metres, as Kalibr and TagSLAM write them:
/// - OpenCV's FileStorage: a lens (camera_matrix, distortion_coefficients, image_width,
///   image_height) or a pair (M1, D1, M2, D2, R, T; R and T may be in extrinsics.yml in
///   the same folder). Cameras are cam1 and cam2; the world is the first camera's frame.
///   ROS's camera_info files have these keys.
/// - Kalibr's camchain: cam0, cam1..., pinhole with radtan or equidistant. The world is
///   cam0's frame. Clocks (timeshift_cam_imu) are ignored.
/// - TagSLAM's cameras.yaml with camera_poses.yaml in the same folder. The world is the
///   rig's.
/// A single camera without a pose stands at the origin.
///
/// Errors (kBadInput), with the line if there is one: those of parse_calibration();
/// several cameras without poses; a lens or camera model that LensModel does not have; no
/// image size; positions that cannot be in metres.
[[nodiscard]] Result<Calibration> read_calibration(const std::filesystem::path& path);

/// Reads only the lenses of a calibration. The poses of several cameras in YAML may be
/// missing (Kalibr's and TagSLAM's cameras.yaml), and files with poses are not read. A
/// camera without a pose stands at the origin.
[[nodiscard]] Result<Calibration> read_lenses(const std::filesystem::path& path);

/// Detects by its content whether a file holds cameras rather than a session: YAML, XML,
/// or TOML with a lens matrix. Cost: reads the file.
[[nodiscard]] bool is_calibration(const std::filesystem::path& path);

}  // namespace marey::recordings
