// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/progress.h"
#include "core/camera.h"

namespace marey::calib {

/// Options of calibrate_wand().
struct WandOptions {
  LensModel lens = LensModel::kBrownConrady;
  /// Replaces `lens` by the model with the lowest error on odd frames after a fit to the
  /// even frames.
  bool choose_lens = false;
  /// Per camera: its lens if it is already known; it is held fixed. Empty: none is known.
  std::vector<std::optional<Intrinsics>> lenses{};
  /// Also use static tags of the scene (not the wand's, at rest in every image), although
  /// their sizes are unknown.
  bool use_scenery = true;
  /// Upper limit of the number of evenly selected instants in the refinement; twice as
  /// many if clocks are solved for.
  int max_instants = 300;
  // As in CalibrateOptions:
  bool solve_offsets = false;
  bool solve_drifts = false;
  bool solve_line_delays = false;
  bool choose_clocks = false;
  double max_offset_s = 5.0;
  bool cross_validate = false;
  Progress progress{};
};

}  // namespace marey::calib
