// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/rig_columns.h"

namespace marey::calib {

RigColumns::RigColumns(const RigModel& model, const RefineOptions& options, int windows)
    : windows_(windows) {
  const std::size_t cameras = model.cameras.size();
  const auto is_held = [&](std::size_t c) {
    return !options.intrinsics ||
           (c < options.held_lenses.size() && options.held_lenses[c]);
  };
  const auto is_posed = [&](std::size_t c) {
    return options.camera_poses && options.fixed_camera != c;
  };
  for (std::size_t c = 0; c < cameras; ++c) {
    const auto terms =
        4 + static_cast<int>(distortion_terms(model.cameras[c].intrinsics.lens));
    lens_terms_.push_back(terms);
    lens_.push_back(is_held(c) ? -1 : take(terms));
    pose_.push_back(is_posed(c) ? take(6) : -1);
    shrinkage_.push_back(options.shrinkage ? take(2) : -1);
    offset_.push_back(options.offsets && c > 0 ? take(1) : -1);
    drift_.push_back(options.drifts && c > 0 ? take(1) : -1);
    line_delay_.push_back(options.line_delays ? take(1) : -1);
  }
  for (std::size_t t = 0; t < model.targets.size(); ++t) {
    const RigidTarget& target = model.targets[t];
    piece_.emplace_back(target.pieces.size(), -1);
    for (std::size_t i = 0; i < target.pieces.size(); ++i) {
      if (target.same_board_as) {
        piece_[t][i] = piece_[*target.same_board_as][i];
      } else if (target.stays || i > 0) {
        piece_[t][i] = take(target.pieces[i].is_size_known ? 6 : 7);
      }
    }
  }
  base_ = all_;
  for (std::size_t c = 0; c < cameras; ++c) {
    if (offset_[c] < 0 && c > 0) offset_[c] = take(1);
    if (line_delay_[c] < 0) line_delay_[c] = take(1);
    window_.push_back(windows > 0 ? take(6 * windows) : -1);
  }
}

}  // namespace marey::calib
