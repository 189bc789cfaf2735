// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Features of one instant.
inline constexpr int kFeatureCount = 57;
/// Floats from one instant's features to the next one's, in memory and in files: the last
/// 7 are 0, so that rows fill whole vectors of the processor.
inline constexpr int kFeatureStride = 64;
/// Instants per second.
inline constexpr double kFeatureRate_hz = 10.0;

/// Features of a motion, one row per instant of 0.1 s.
///
/// Columns, with lengths in leg lengths L and components (across, up, forward) in the
/// body's level frame (library/features/level_frame.h):
///   0 to 38   position of 13 points, in the order of BodyPoint
///   39 to 53  0.2 s times the time derivative of the positions of head, left and right
///             hand, left and right ankle
///   54, 55    0.5 s times the velocity of the hips: across, forward
///   56        0.8 s times the turn rate, positive to the left [rad]. This weight finds
///   the
///             content of a motion best (docs/accuracy/library.md)
struct BodyFeatures {
  /// Time of the first row since the motion's first frame: 0 to 0.1. [s]
  double start_s = 0.0;
  std::vector<float> rows;  ///< kFeatureStride per instant.

  [[nodiscard]] int count() const {
    return static_cast<int>(rows.size() / static_cast<std::size_t>(kFeatureStride));
  }
};

/// Computes the features of a motion at the instants k / 10 s that lie within its frames
/// (core/resample.h), counted like its frames, so that a part of a motion has the rows of
/// the whole. A motion without such an instant has one row, of its first pose; one
/// without poses has none. Derivatives are central differences over 0.2 s, one-sided over
/// 0.1 s in the first and last row, 0 in a single row.
///
/// The features do not change if the motion is moved on the floor or turned about the
/// vertical, or if the body and its paths are scaled. All values are finite.
/// Linear in rows times joints; allocates the resampled poses and the result.
/// Precondition: `map` was made from the motion's skeleton; the rate is positive; poses
/// are finite.
[[nodiscard]] BodyFeatures body_features(const Motion& motion,
                                         const retarget::BodyMap& map);

/// Returns the features of the mirrored motion, exactly: points exchange their sides, and
/// components across and turns change their sign. Its own inverse.
/// Precondition: the size is a multiple of kFeatureStride.
[[nodiscard]] std::vector<float> mirrored_features(std::span<const float> rows);

}  // namespace marey::library
