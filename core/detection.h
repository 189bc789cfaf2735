// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/assert.h"
#include "core/ids.h"
#include "core/result.h"
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

/// On which side of the tag's centre each corner is, along x and y of the tag frame; in
/// the order of TagDetection::corners_px.
inline constexpr std::array<std::array<int, 2>, 4> kCornerSides{
    {{-1, +1}, {+1, +1}, {+1, -1}, {-1, -1}}};

/// Corner `corner` (order of TagDetection::corners_px) in the tag frame. [m]
/// Precondition: 0 <= corner < 4.
[[nodiscard]] inline glm::dvec3 corner_in_tag(int corner, double size_m) {
  MAREY_ASSERT(corner >= 0 && corner < 4);
  const double h = 0.5 * size_m;
  const auto& sign = kCornerSides[static_cast<std::size_t>(corner)];
  return {sign[0] * h, sign[1] * h, 0.0};
}

/// How much smaller than life a camera shows black squares. Light spreads into them (lens
/// blur is linear in light, pixels are not) and the detector's edge search adds its own:
/// two opposite edges that are s [px] apart are found s - (offset_px + slope * s) apart.
/// A percent of the size is a percent of the distance when only one camera sees a tag, so
/// it is measured (calib/calibrate_cameras.h) and taken off.
struct TagShrinkage {
  double offset_px = 0.0;
  double slope = 0.0;
};

/// Moves opposite edges of a quadrilateral apart: `grow` gives the new distance between
/// two edges for the old one. Corners as in TagDetection, x and y in turn; T is double or
/// ceres::Jet. First order in perspective: the sides of a tag are taken as parallel.
/// Corners that enclose no area, such as those of a tag seen edge-on, stay as they are.
template <class T, class Grow>
void move_edges(std::array<std::array<T, 2>, 4>& corners, const Grow& grow) {
  using std::abs;
  using std::sqrt;
  std::array<T, 2> middle{};
  std::array<T, 2> u{};  // Half of a side, bottom left to bottom right.
  std::array<T, 2> v{};  // Half of a side, bottom left to top left.
  for (std::size_t i = 0; i < 2; ++i) {
    middle[i] = 0.25 * (corners[0][i] + corners[1][i] + corners[2][i] + corners[3][i]);
    u[i] = 0.25 * (corners[1][i] - corners[0][i] + corners[2][i] - corners[3][i]);
    v[i] = 0.25 * (corners[3][i] - corners[0][i] + corners[2][i] - corners[1][i]);
  }
  const T area = u[0] * v[1] - u[1] * v[0];
  const T least_px2(1e-9);  // What rounding leaves of no area, some thousand pixels out.
  if (!(abs(area) > least_px2)) return;
  const T apart_u = 2.0 * abs(area) / sqrt(v[0] * v[0] + v[1] * v[1]);
  const T apart_v = 2.0 * abs(area) / sqrt(u[0] * u[0] + u[1] * u[1]);
  const T factor_u = grow(apart_u) / apart_u;
  const T factor_v = grow(apart_v) / apart_v;
  for (auto& corner : corners) {
    const std::array<T, 2> d{corner[0] - middle[0], corner[1] - middle[1]};
    const T along_u = (d[0] * v[1] - d[1] * v[0]) / area;
    const T along_v = (u[0] * d[1] - u[1] * d[0]) / area;
    for (std::size_t i = 0; i < 2; ++i) {
      corner[i] = middle[i] + along_u * factor_u * u[i] + along_v * factor_v * v[i];
    }
  }
}

/// The corners as they would be found without shrinkage. As move_edges(), it leaves
/// corners alone that enclose no area. Precondition: slope < 1.
[[nodiscard]] inline std::array<glm::dvec2, 4> unshrunk(
    const std::array<glm::dvec2, 4>& corners_px, const TagShrinkage& shrinkage) {
  std::array<std::array<double, 2>, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = {corners_px[i].x, corners_px[i].y};
  move_edges(corners, [&](double apart_px) {
    return (apart_px + shrinkage.offset_px) / (1.0 - shrinkage.slope);
  });
  std::array<glm::dvec2, 4> out{};
  for (std::size_t i = 0; i < 4; ++i) out[i] = {corners[i][0], corners[i][1]};
  return out;
}

/// One inner corner of a board of squares, seen in one image.
struct PointDetection {
  int point = 0;             ///< Its number on the board (inner_corner_in_board()).
  glm::dvec2 pixel_px{0.0};  ///< Pixel centres at integers.
  double sigma_px = 0.3;     ///< Standard deviation of one coordinate.
};

/// Sightings that a detector dropped.
struct DroppedSightings {
  int unsure = 0;      ///< Decision margin too low.
  int duplicated = 0;  ///< The same id in two places of one image, and no telling
                       ///< which is right, or the one that is wrong.
};

/// All that was found in one frame of one camera.
struct FrameDetections {
  int frame = 0;
  std::vector<TagDetection> tags;        ///< Ascending ids, each at most once.
  std::vector<PointDetection> points{};  ///< Of the board; likewise.
};

/// All frames of one camera in one trial; frames ascending, empty ones included, so that
/// frames[i].frame - frames[0].frame == i.
struct CameraDetections {
  std::string source;  ///< The video or folder, as messages should name it.
  CameraId camera{};
  int width_px = 0;
  int height_px = 0;
  FrameRate rate;
  /// When known, frame k was exposed at k / rate + offset.
  std::optional<Timestamp> offset;
  std::vector<FrameDetections> frames;
  DroppedSightings dropped;  ///< In all of these frames together.
  /// Frames that are damaged in the recording and could not be decoded: empty here.
  int damaged_frames = 0;
  /// Why there are no more frames, when reading ended before the recording's end.
  std::optional<Error> broken_off;
  /// When frames were matched by time: which of the recording's frames each of `frames`
  /// is, nullopt where the camera took none. Empty when they have the same numbers.
  std::vector<std::optional<int>> in_recording;
};

}  // namespace marey
