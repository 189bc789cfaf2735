// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/ids.h"
#include "core/time.h"

namespace marey {

/// One tag seen in one image.
///
/// Tag frame: looking at the upright printed tag, origin at its centre, x right, y down,
/// z into the tag (away from the viewer).
struct TagDetection {
  TagId id{};
  /// Corners of the black square, pixel centres at integers, in libapriltag's order:
  /// bottom left, bottom right, top right, top left of the upright tag. [px]
  std::array<glm::dvec2, 4> corners_px{};
  double sigma_px = 0.3;         ///< Standard deviation of one corner coordinate.
  double decision_margin = 0.0;  ///< libapriltag's; higher is surer.
  int hamming = 0;               ///< Bits corrected while decoding.
};

/// Corner `corner` (order of TagDetection::corners_px) in the tag frame. [m]
[[nodiscard]] inline glm::dvec3 corner_in_tag(int corner, double size_m) {
  const double h = 0.5 * size_m;
  constexpr std::array<std::array<double, 2>, 4> kSigns{
      {{-1, +1}, {+1, +1}, {+1, -1}, {-1, -1}}};
  const auto& sign = kSigns[static_cast<std::size_t>(corner)];
  return {sign[0] * h, sign[1] * h, 0.0};
}

/// All tags of one frame of one camera, in ascending id order, each id at most once.
struct FrameDetections {
  int frame = 0;
  std::vector<TagDetection> tags;
};

/// All frames of one camera in one trial; frames ascending, empty ones included, so that
/// frames[i].frame - frames[0].frame == i.
struct CameraDetections {
  std::string source;  ///< The video or folder, as messages should name it.
  CameraId camera{};
  int width_px = 0;
  int height_px = 0;
  FrameRate rate;
  Timestamp offset{0};  ///< Frame k was exposed at k / rate + offset.
  std::vector<FrameDetections> frames;
};

}  // namespace marey
