// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "edit/find/travel_path.h"

#include "core/base/frame_range.h"
#include "core/base/result.h"
#include "core/edit/edit_ops.h"
#include "core/signal/cubic_spline.h"
#include "core/transform.h"

namespace marey::edit {

/// A new path for a motion, frame by frame.
struct NewPath {
  std::vector<glm::dvec2> origin_m;
  std::vector<double> turn_rad;  ///< Heading of the new path minus that of the old one.
  double length_m = 0.0;         ///< Within the range of frames.
};

/// Computes the new path of a PathOp over the frames of a span. Frames before the span
/// keep their path; frames after it follow rigidly. Where the span starts or ends within
/// the motion, the change of direction and speed sets in over a quarter of the path.
/// Linear in frames.
/// Errors (bad input, without a place): the new length is outside the range that steps
/// allow (0.7 to 1.3 of the old length, frame by frame).
[[nodiscard]] Result<NewPath> make_new_path(const PathOp& op,
                                            const TravelPath& old,
                                            const FrameRange& span);

/// Rigid change of the floor plane from the old path to the new one at each instant:
/// the frame of the old path (origin and heading) becomes that of the new one (Gleicher
/// 2001, section 4).
class PathChange {
 public:
  /// Precondition: both have the same number of frames, at least 2.
  PathChange(const TravelPath& old, const NewPath& made);

  /// Returns the change at a frame; between frames by cubic splines.
  [[nodiscard]] RigidTransform moved_from_old(double frame) const;

 private:
  CubicSpline old_x_;
  CubicSpline old_z_;
  CubicSpline new_x_;
  CubicSpline new_z_;
  CubicSpline turn_;
};

/// Returns, for each frame, the instant whose change of the path moves a foot: the middle
/// of its stance while it stands; between stances the instant moves from one middle to
/// the next with continuous speed and acceleration; far from stances it is the frame
/// itself. The instant of a stance across an end of the span is
/// limited to that end. A foot that never stands follows the frames.
/// Linear in frames.
[[nodiscard]] std::vector<double> foot_instants(std::span<const FrameRange> stances,
                                                int frame_count,
                                                const FrameRange& span,
                                                double hz);

}  // namespace marey::edit
