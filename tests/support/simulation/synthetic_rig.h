// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/board.h"
#include "core/camera.h"
#include "core/detection.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {

/// A 1280 x 720 webcam of 900 px focal length whose barrel distortion (k1 = -0.1) bends
/// the image's corners by 40 px.
[[nodiscard]] Intrinsics webcam();

/// A webcam at `place` that looks at `target`, the image's down being the world's.
/// Precondition: not one above the other.
[[nodiscard]] Camera webcam_at(std::string name,
                               const glm::dvec3& place_in_world,
                               const glm::dvec3& target_in_world);

/// Four webcams around a volume of 2 m, 3 to 3.5 m from its middle, 1.9 to 2.6 m high;
/// no two of one focal length, none square on to another.
[[nodiscard]] std::vector<Camera> ring_of_cameras();

/// "cam0", "cam1"... as the cameras are called.
[[nodiscard]] std::vector<std::string> names_of(const std::vector<Camera>& cameras);

/// Errors of a detector.
struct Disturbance {
  double noise_px = 0.0;  ///< Standard deviation of every corner coordinate.
  TagShrinkage shrinkage;
  /// Share of tags that are detected 20 px off, with the same shift of all four corners.
  double wrong_share = 0.0;
  double declared_px = 0.3;  ///< Noise that the detector reports.
};

/// Returns a camera's view of a tag; nullopt when it faces away by more than `widest_rad`
/// or a corner is outside the image.
[[nodiscard]] std::optional<TagDetection> see_tag(
    const Camera& camera,
    const RigidTransform& world_from_tag,
    TagId id,
    double size_m,
    double widest_rad = 1.134 /* 65 degrees: where libapriltag gives up */);

/// The detection as a real detector would give it.
[[nodiscard]] TagDetection disturbed(TagDetection tag,
                                     const Disturbance& disturbance,
                                     Dice& dice);

/// One empty CameraDetections per camera, its frames 0 to frames - 1 without tags.
[[nodiscard]] std::vector<CameraDetections> unseeing(const std::vector<Camera>& cameras,
                                                     int frames,
                                                     double hz,
                                                     const std::string& trial);

/// A board waved through the volume before all cameras, then lying on the floor.
struct BoardRecording {
  std::vector<CameraDetections> waved;
  std::vector<CameraDetections> floor;
};

/// The calibration of `cameras` with `board`: `frames` waved frames in which the board
/// turns its face from camera to camera, tilts and comes near, then 5 on the floor.
[[nodiscard]] BoardRecording wave_board(const std::vector<Camera>& cameras,
                                        const AprilGrid& board,
                                        int frames,
                                        const Disturbance& disturbance = {});

}  // namespace marey::testing
