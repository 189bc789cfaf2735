// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the columns of a rig's normal equations.

#include <cstddef>
#include <vector>

#include "calib/refine_rig.h"
#include "calib/rig_model.h"

namespace marey::calib {

/// Where the numbers of a model stand in its normal equations once the poses of moving
/// targets are eliminated. -1 for what is held. First the base, which is what the
/// refinement moves; then hypotheses: numbers that it held, each zero in the model.
class RigColumns {
 public:
  /// `windows`: stretches of the recording in each of which a camera may stand elsewhere.
  RigColumns(const RigModel& model, const RefineOptions& options, int windows);

  [[nodiscard]] int lens_terms(std::size_t c) const { return lens_terms_[c]; }
  [[nodiscard]] int lens(std::size_t c) const { return lens_[c]; }
  [[nodiscard]] int pose(std::size_t c) const { return pose_[c]; }
  [[nodiscard]] int shrinkage(std::size_t c) const { return shrinkage_[c]; }
  /// The clock's offset [s], in the base or a hypothesis; none of the first camera.
  [[nodiscard]] int offset(std::size_t c) const { return offset_[c]; }
  [[nodiscard]] int drift(std::size_t c) const { return drift_[c]; }
  /// From one row to the next [s].
  [[nodiscard]] int line_delay(std::size_t c) const { return line_delay_[c]; }
  /// Of a target's piece: a pose, and the logarithm of its size where that is unknown.
  [[nodiscard]] int piece(std::size_t target, std::size_t i) const {
    return piece_[target][i];
  }
  /// A pose that the camera has in this window beside its own; -1 where its own is held.
  [[nodiscard]] int window(std::size_t c, int w) const {
    return window_[c] < 0 ? -1 : window_[c] + 6 * w;
  }
  [[nodiscard]] int windows() const { return windows_; }
  [[nodiscard]] int base() const { return base_; }
  [[nodiscard]] int all() const { return all_; }

 private:
  int take(int count) {
    all_ += count;
    return all_ - count;
  }

  std::vector<int> lens_terms_;
  std::vector<int> lens_;
  std::vector<int> pose_;
  std::vector<int> shrinkage_;
  std::vector<int> offset_;
  std::vector<int> drift_;
  std::vector<int> line_delay_;
  std::vector<int> window_;
  std::vector<std::vector<int>> piece_;  ///< Per target and piece.
  int windows_ = 0;
  int base_ = 0;
  int all_ = 0;
};

}  // namespace marey::calib
