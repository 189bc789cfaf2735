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

#include "core/base/assert.h"
#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/base/time.h"

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
  double decision_margin = 0.0;  ///< libapriltag's; higher is more certain.
  int hamming = 0;               ///< Bits corrected while decoding.
};

/// Side of the tag's centre on which each corner is, along x and y of the tag frame; in
/// the order of TagDetection::corners_px.
inline constexpr std::array<std::array<int, 2>, 4> kCornerSides{
    {{-1, +1}, {+1, +1}, {+1, -1}, {-1, -1}}};

/// Returns corner `corner` (order of TagDetection::corners_px) in the tag frame. [m]
/// Precondition: 0 <= corner < 4.
[[nodiscard]] inline glm::dvec3 corner_in_tag(int corner, double size_m) {
  MAREY_ASSERT(corner >= 0 && corner < 4);
  const double h = 0.5 * size_m;
  const auto& sign = kCornerSides[static_cast<std::size_t>(corner)];
  return {sign[0] * h, sign[1] * h, 0.0};
}

/// Shrinkage of black squares in the images of a camera. Light spreads into them (lens
/// blur is linear in light, pixels are not) and the detector's edge search adds its own:
/// two opposite edges that are s [px] apart are found s - (offset_px + slope * s) apart.
/// A percent of the size is a percent of the distance when only one camera sees a tag, so
/// it is measured (calib/rig/calibrate_cameras.h) and removed.
struct TagShrinkage {
  double offset_px = 0.0;
  double slope = 0.0;
};

/// Moves opposite edges of a quadrilateral apart: `grow` returns the new distance between
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
  const T min_px2(1e-9);  // Rounding error of a zero area, some thousand pixels out.
  if (!(abs(area) > min_px2)) return;
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

/// Returns the corners without shrinkage. As move_edges(), it does not change corners
/// that enclose no area.
/// Precondition: slope < 1.
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
  int unsure = 0;  ///< Decision margin too low.
  /// The same id in two places of one image (it is not known which is right), or the one
  /// that is wrong.
  int duplicated = 0;
};

/// All detections in one frame of one camera.
struct FrameDetections {
  int frame = 0;
  std::vector<TagDetection> tags;  ///< Ascending ids, each at most once.
  /// Corners of the board; ascending numbers, each at most once.
  std::vector<PointDetection> points{};
};

/// All frames of one camera in one trial. Frames are ascending, empty ones included, so
/// that frames[i].frame - frames[0].frame == i.
struct CameraDetections {
  std::string source;  ///< The video or folder, as named in messages.
  CameraId camera{};
  int width_px = 0;
  int height_px = 0;
  FrameRate rate;
  /// When known, frame k was exposed at k / rate + offset.
  std::optional<Timestamp> offset;
  std::vector<FrameDetections> frames;
  DroppedSightings dropped;  ///< Sum over all of these frames.
  /// Frames that are damaged in the recording and could not be decoded: empty here.
  int damaged_frames = 0;
  /// The error that ended reading before the recording's end; nullopt if there was none.
  std::optional<Error> broken_off;
  /// If frames were matched by time: index of each of `frames` in the recording, nullopt
  /// where the camera has none. Empty if the indices are the same.
  std::vector<std::optional<int>> in_recording;
};

}  // namespace marey
