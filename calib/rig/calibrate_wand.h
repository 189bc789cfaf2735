// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "calib/model/calibrated_rig.h"
#include "calib/model/wand_options.h"
#include "core/base/result.h"
#include "core/board.h"
#include "core/detection.h"
#include "core/transform.h"

namespace marey::calib {

struct WandCalibration {
  CalibratedRig rig;
  /// The wand's placed tags, in the frame of the wand's first tag.
  std::map<TagId, RigidTransform> wand_from_tag;
  /// By frame. Empty if clocks were solved for, as a frame then has no common instant.
  std::map<int, RigidTransform> world_from_wand;
  /// Estimated edges of the static tags of the scene [m].
  std::map<TagId, double> static_tag_sizes_m;
};

/// Calibrates cameras from a moving body that carries tags of known size. One bundle
/// adjustment computes intrinsics, camera poses, and the place of each tag on the body.
///
/// World: right-handed, metres; the origin is the first camera's centre, X its right, Y
/// its up. `names` per camera, for messages. `waved` has one entry per camera in the same
/// order; frames of one index were taken at the same time unless clocks are solved for.
/// If clocks are solved for, the wand must move smoothly, and the offsets are estimated
/// from its motion. Cameras that see no tag of the wand are placed by static tags of the
/// scene that other cameras see.
///
/// Errors (kBadInput): no tag of the wand in any frame; too few tags to estimate any
/// lens; cameras that no shared sighting connects, with the names of the groups; a bundle
/// that does not converge or ends with a median corner error above 2.5 px (wrong sizes,
/// tags that moved on the wand, cameras that do not start together while clocks are not
/// solved for).
/// Cost: some seconds for eight cameras and a hundred instants.
[[nodiscard]] Result<WandCalibration> calibrate_wand(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    const Wand& wand,
    const WandOptions& options = {});

}  // namespace marey::calib
