// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "edit/find/planar_match.h"

namespace marey::edit {

/// Compares all pairs of frames of one motion by few joints: hips, wrists and ankles
/// (without arms: the head), each with its share of the body's mass. The distance is that
/// of match_windows() for these joints. Sums run along the diagonal of frames that are
/// equally far apart, so a pair costs the same whatever its window.
class LoopCost {
 public:
  /// Takes every `stride`-th frame of the motion. Linear in frames.
  /// Precondition: `map` was made from the motion's skeleton.
  LoopCost(const Motion& motion,
           const retarget::BodyMap& map,
           const MatchOptions& options,
           int stride = 1);

  [[nodiscard]] int frame_count() const { return frames_; }

  /// Computes the squared distance of frame k from frame k + lag for every k, in taken
  /// frames. [m^2] Linear in frames.
  /// Precondition: 0 <= lag < frame_count(); `out` has frame_count() - lag entries.
  void squared_distances(int lag, std::span<double> out);

 private:
  static constexpr std::size_t kSums = 10;
  using Sums = std::array<double, kSums>;
  [[nodiscard]] Sums pair_sums(std::size_t a, std::size_t b) const;
  [[nodiscard]] double squared_distance(const Sums& sums, int width) const;

  int frames_ = 0;
  MatchOptions options_;
  std::vector<double> weights_;
  std::vector<glm::dvec3> places_;
  std::vector<glm::dvec3> velocities_;
  std::vector<Sums> running_;  ///< Sums over the pairs before an index.
};

}  // namespace marey::edit
