// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Floats of one frame's features for motion matching.
inline constexpr int kMatchingCount = 27;

/// Computes the features of motion matching for every frame at the motion's own rate,
/// kMatchingCount floats each, in the order of Holden, Kanoun, Perepichka and Popa
/// ("Learned motion matching", 2020) and of its published code:
///
///   0 to 5    position of the left, then the right foot's ankle [m]
///   6 to 11   velocity of the left, then the right foot's ankle [m/s]
///   12 to 14  velocity of the hips [m/s]
///   15 to 20  place on the path after 0.33, 0.67 and 1 s: across, forward [m]
///   21 to 26  facing after 0.33, 0.67 and 1 s: across, forward, unit vector
///
/// All are in the frame of the character at that frame: (across, up, forward), as (X, Y,
/// Z) of a body that faces +Z. Its place is the hips' over the floor, and its facing that
/// of level_frame(), both averaged over 0.5 s around the frame (less at both ends, evenly
/// on both sides), so that the sway of a step does not turn the path. Positions are not
/// divided by the body's size. Velocities are central differences of two frames,
/// one-sided at both ends, 0 for a single frame. Instants after the last frame are the
/// last frame.
///
/// Linear in frames times (joints + frames in 0.5 s).
/// Precondition: `map` was made from the motion's skeleton; the rate is positive.
[[nodiscard]] std::vector<float> matching_features(const Motion& motion,
                                                   const retarget::BodyMap& map);

/// Offset and scale of all features of a database: feature = (value - offset) / scale.
struct MatchingScale {
  std::array<float, kMatchingCount> offset{};
  std::array<float, kMatchingCount> scale{};
};

/// Collects the scale over clips. The offset is the mean of each column. The scale is
/// that of Holden's code: the mean standard deviation of a group of columns (left foot's
/// position, right foot's position, left foot's velocity, right foot's velocity, hips'
/// velocity, path, facing) divided by its weight (0.75, 0.75, 1, 1, 1, 1, 1.5), so that
/// groups count by weight. A group that does not vary has scale 1.
class MatchingStatistics {
 public:
  /// Adds the features of a clip. Precondition: a multiple of kMatchingCount floats.
  void add(std::span<const float> features);
  /// Returns the scale of all clips added; offset 0 and scale 1 without frames.
  [[nodiscard]] MatchingScale scale() const;

 private:
  double count_ = 0.0;
  // Mean, and sum of squared deviations from it (Welford 1962).
  std::array<double, kMatchingCount> mean_{};
  std::array<double, kMatchingCount> squares_{};
};

}  // namespace marey::library
