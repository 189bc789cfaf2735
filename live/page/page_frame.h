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

/// The binary messages of the page (docs/formats/page.md): little-endian, floats
/// of 32 bits, what is larger than a float can be being its largest. Functions append to
/// `out`; with one that is kept and emptied, nothing is allocated once it has grown.

struct PageBalance {
  glm::dvec3 centre_of_mass_in_world{0.0};
  std::span<const glm::dvec2> support_xz_m{};  ///< Polygon on the floor; may be empty.
};

/// How a body that is followed live was found, for the timeline.
struct PageTracking {
  std::optional<double> residual_px{};  ///< Nothing was seen of it: not known.
  /// Which of the left heel, left ball, right heel and right ball bear.
  std::array<bool, 4> bears{};
};

/// One skeleton in one frame.
struct PageFigure {
  std::size_t joints = 0;               ///< Of the scene's skeleton.
  const Pose* pose = nullptr;           ///< nullptr: not there in this frame.
  std::span<const JointUncertainty> uncertainty{};  ///< One for each joint, or empty.
  std::optional<PageBalance> balance{};
  std::optional<PageTracking> tracking{};
};

struct PageFrame {
  std::uint32_t frame = 0;
  double time_s = 0.0;  ///< Of the frame.
  double sent_s = 0.0;  ///< On the server's clock; the page sends it back.
  std::span<const PageFigure> figures{};  ///< As many and in the order of the scene's.
};

/// Preconditions: at most 65535 figures, joints and support points each; a pose and
/// doubts have one entry for each joint.
void append_frame(const PageFrame& frame, std::string& out);

/// The head of a motion block: `frames` times append_frame() follow.
void append_motion_block_head(std::uint32_t frames,
                              std::uint32_t skeletons,
                              std::string& out);

/// All of a point block. Markers that were not seen are NaN.
void append_point_block(const MarkerTracks& tracks, std::string& out);

struct PageThumbnail {
  std::uint8_t camera = 0;
  int width_px = 0;  ///< Of the picture as the camera took it.
  int height_px = 0;
  std::span<const TagDetection> tags{};  ///< Corners in that picture.
  std::string_view jpeg{};               ///< Any size; the same picture.
};

/// Precondition: sizes and the number of tags from 0 to 65535.
void append_thumbnail(const PageThumbnail& thumbnail, std::string& out);

}  // namespace marey::live
