// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/calibrated_rig.h"
#include "core/board.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/progress.h"
#include "core/result.h"
#include "core/transform.h"

namespace marey::calib {

struct WandOptions {
  LensModel lens = LensModel::kBrownConrady;
  /// Instead of `lens`, the one that does best on odd frames after seeing the even ones.
  bool choose_lens = false;
  /// Per camera: its lens, when it is known already; it is held. Empty: none is known.
  std::vector<std::optional<Intrinsics>> lenses{};
  /// Tags of the scenery (none of the wand's, at rest in every picture) serve too, though
  /// their sizes are not known.
  bool use_scenery = true;
  /// At most so many instants, evenly chosen, are refined together; twice as many where
  /// clocks are solved for.
  int most_instants = 300;
  // As CalibrateOptions's:
  bool solve_offsets = false;
  bool solve_drifts = false;
  bool solve_line_delays = false;
  bool choose_clocks = false;
  double most_offset_s = 5.0;
  bool cross_validate = false;
  Progress progress{};
};

struct WandCalibration {
  CalibratedRig rig;
  /// Of the wand's tags that were placed, in the frame of the wand's first tag.
  std::map<TagId, RigidTransform> wand_from_tag;
  /// By frame; empty where clocks were solved for, and no frame is one instant.
  std::map<int, RigidTransform> world_from_wand;
  /// Edges of the scenery's tags as they were found [m].
  std::map<TagId, double> scenery_sizes_m;
};

/// Calibrates cameras from nothing but a moving body that carries tags of known size:
/// intrinsics, poses, and where each tag sits on the body, by one bundle adjustment.
///
/// World: right-handed, metres; the first camera's place is the origin, its right X, its
/// up Y. `names` per camera, for messages; `waved` one entry per camera in the same
/// order, frames of one index taken at the same time unless clocks are solved for (then
/// the wand moves smoothly, and offsets come from that). Cameras that see no tag of the
/// wand find their place by tags of the scenery, when other cameras see these.
///
/// Errors (kBadInput): no tag of the wand in any frame; too few tags to tell any lens;
/// cameras that no shared sighting connects, naming the groups; a bundle that does not
/// converge or ends with a median corner more than 2.5 px off (wrong sizes, tags that
/// moved on the wand, cameras that do not start together and were not told to).
/// Cost: some seconds for eight cameras and a hundred instants.
[[nodiscard]] Result<WandCalibration> calibrate_wand(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    const Wand& wand,
    const WandOptions& options = {});

}  // namespace marey::calib
