// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the columns of a rig's normal equations.

#include <cstddef>
#include <vector>

#include "calib/bundle/refine_options.h"
#include "calib/model/rig_model.h"

namespace marey::calib {

/// Columns of a model's parameters in its normal equations after the poses of moving
/// targets are eliminated. -1 for held parameters. First the base, which is the set of
/// parameters that the refinement moves; then hypotheses: parameters that it held, each
/// zero in the model.
class RigColumns {
 public:
  /// `windows`: sections of the recording in each of which a camera may have another
  /// pose.
  RigColumns(const RigModel& model, const RefineOptions& options, int windows);

  [[nodiscard]] int lens_terms(std::size_t c) const { return lens_terms_[c]; }
  [[nodiscard]] int lens(std::size_t c) const { return lens_[c]; }
  [[nodiscard]] int pose(std::size_t c) const { return pose_[c]; }
  [[nodiscard]] int shrinkage(std::size_t c) const { return shrinkage_[c]; }
  /// Column of the clock's offset [s], in the base or a hypothesis; none for the first
  /// camera.
  [[nodiscard]] int offset(std::size_t c) const { return offset_[c]; }
  [[nodiscard]] int drift(std::size_t c) const { return drift_[c]; }
  /// Column of the delay from one row to the next [s].
  [[nodiscard]] int line_delay(std::size_t c) const { return line_delay_[c]; }
  /// First column of a target's piece: a pose, and the logarithm of its size if unknown.
  [[nodiscard]] int piece(std::size_t target, std::size_t i) const {
    return piece_[target][i];
  }
  /// First column of the camera's additional pose in this window; -1 if the camera's pose
  /// is held.
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
