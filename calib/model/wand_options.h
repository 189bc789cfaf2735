// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/model/rig_options.h"

namespace marey::calib {

/// Options of calibrate_wand().
struct WandOptions : RigOptions {
  /// Also use static tags of the scene (not the wand's, at rest in every image), although
  /// their sizes are unknown.
  bool use_scenery = true;
  /// Upper limit of the number of evenly selected instants in the refinement; twice as
  /// many if clocks are solved for.
  int max_instants = 300;
};

}  // namespace marey::calib
