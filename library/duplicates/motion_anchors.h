// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace marey::library {

/// Floats that describe a motion near an anchor: 5 instants of 16.
inline constexpr int kAnchorFloats = 80;

/// Instants at which a copy of a motion is recognized, also a cut one, at another rate or
/// on another body.
struct MotionAnchors {
  /// Row of the features, with its fraction, ascending.
  std::vector<double> at;
  /// kAnchorFloats per anchor: a unit vector.
  std::vector<float> values;
};

/// Finds the anchors of a clip: the maxima and minima, over 0.7 s, of the speed of head,
/// hands and ankles relative to the hips; every 0.5 s where there are none for 1 s; and
/// the middle of the clip. Times of extrema are between rows, by a parabola, so that they
/// do not depend on the instants of the rows.
///
/// The values are the positions of these five points relative to the hips at the anchor
/// and 0.2 and 0.4 s before and after it (those of the clip's end beyond it), less their
/// mean over the five instants, scaled to unit length. Constant differences between
/// bodies and the height of the floor have no influence. A time around which nothing
/// moves by more than 0.005 leg lengths is no anchor.
///
/// Linear in rows. Precondition: rows of kFeatureStride floats.
[[nodiscard]] MotionAnchors find_anchors(std::span<const float> rows);

/// Finds the anchors by which a clip is searched among those of longer or equal clips:
/// the `max_count` extrema that are nearest to its middle, and the middle. A clip with
/// fewer than two extrema has the five middle rows, too, because one of them is within
/// 0.05 s of an anchor of a longer clip.
[[nodiscard]] MotionAnchors find_queries(std::span<const float> rows,
                                         std::size_t max_count);

}  // namespace marey::library
