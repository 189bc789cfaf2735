// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace marey::library {

/// Floats that describe a motion near an anchor: 5 instants of 16.
inline constexpr int kAnchorFloats = 80;

/// Instants at which a copy of a motion is recognized, wherever it is cut, at whatever
/// rate and on whatever body.
struct MotionAnchors {
  /// Row of the features, with its fraction, ascending.
  std::vector<double> at;
  /// kAnchorFloats per anchor: a unit vector.
  std::vector<float> values;
};

/// Finds the anchors of a clip: the maxima, over 0.7 s, of the speed of head, hands and
/// ankles relative to the hips, and the middle of the clip. Times are between rows, by a
/// parabola, so that they do not depend on the instants of the rows.
///
/// The values are the positions of these five points relative to the hips at the anchor
/// and 0.25 and 0.5 s before and after it (those of the clip's end beyond it), less their
/// mean over the five instants, scaled to unit length. Constant differences between
/// bodies and the height of the floor have no influence. A part of a clip in which
/// nothing moves by more than 0.02 leg lengths has no anchor.
///
/// Linear in rows. Precondition: rows of kFeatureStride floats.
[[nodiscard]] MotionAnchors find_anchors(std::span<const float> rows);

}  // namespace marey::library
