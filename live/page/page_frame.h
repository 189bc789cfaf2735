// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/detection.h"
#include "core/marker_tracks.h"
#include "core/motion.h"
#include "core/pose.h"

namespace marey::live {

/// Writers of the page's binary messages (docs/formats/page.md): little-endian, floats of
/// 32 bits, values beyond the range of a float clamped to it. Functions append to `out`;
/// nothing is allocated if `out` is reused and has grown.

struct PageBalance {
  glm::dvec3 centre_of_mass_in_world{0.0};
  std::span<const glm::dvec2> support_xz_m{};  ///< Support polygon; may be empty.
  /// Zero moment point on the floor, world X and Z; nullopt: undefined, as in flight.
  std::optional<glm::dvec2> zmp_xz_m{};
};

/// Tracking of a live body, for the timeline.
struct PageTracking {
  std::optional<double> residual_px{};  ///< nullopt: the body was not seen.
  /// Contact of the left heel, left ball, right heel and right ball with the floor.
  std::array<bool, 4> bears{};
};

/// One skeleton in one frame.
struct PageFigure {
  std::size_t joints = 0;      ///< Number of joints of the scene's skeleton.
  const Pose* pose = nullptr;  ///< nullptr: absent in this frame.
  std::span<const JointUncertainty> uncertainty{};  ///< One for each joint, or empty.
  std::optional<PageBalance> balance{};
  std::optional<PageTracking> tracking{};
};

struct PageFrame {
  std::uint32_t frame = 0;
  double time_s = 0.0;  ///< Time of the frame.
  double sent_s = 0.0;  ///< Send time on the server's clock; the page returns it.
  std::span<const PageFigure> figures{};  ///< Same number and order as in the scene.
};

/// Appends one frame. Preconditions: at most 65535 figures, joints and support points
/// each; a pose and its uncertainties have one entry per joint.
void append_frame(const PageFrame& frame, std::string& out);

/// Appends the head of a motion block; `frames` calls of append_frame() must follow.
void append_motion_block_head(std::uint32_t frames,
                              std::uint32_t skeletons,
                              std::string& out);

/// Appends a complete point block. Markers that were not seen are NaN.
void append_point_block(const MarkerTracks& tracks, std::string& out);

struct PageThumbnail {
  std::uint8_t camera = 0;
  int width_px = 0;  ///< Width of the camera's original picture.
  int height_px = 0;
  std::span<const TagDetection> tags{};  ///< Corners in the original picture.
  std::string_view jpeg{};               ///< The picture, scaled to any size.
};

/// Appends one thumbnail. Precondition: sizes and the number of tags from 0 to 65535.
void append_thumbnail(const PageThumbnail& thumbnail, std::string& out);

}  // namespace marey::live
