// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "reconstruct/tags/solve_motion.h"

namespace marey::reconstruct {

/// Distance between a solved motion and its detections, at the body's distance from the
/// camera.
struct ResidualSize {
  double rms_m = 0.0;
  double median_m = 0.0;
  int corners = 0;
};

/// Errors of one camera. Errors proportional to the speed of the seen corners are due to
/// its clock.
struct CameraResidual {
  ResidualSize size;
  /// Delay after the solved motion. A lower bound: the motion absorbs a part of it.
  double late_s = 0.0;
  /// Share of its squared errors that this delay explains. 0 to 1
  double explained = 0.0;
};

struct TagResidual {
  TagId id{};
  HumanBone segment{};
  ResidualSize size;
};

/// Consecutive frames.
struct StretchResidual {
  int first_frame = 0;
  int last_frame = 0;
  ResidualSize size;
};

struct TrialResiduals {
  ResidualSize all;
  std::vector<CameraResidual> cameras;     ///< In the order of the cameras.
  std::vector<TagResidual> tags;           ///< In the order of the body's tags; all of
                                           ///< them.
  std::vector<StretchResidual> stretches;  ///< Half a second each, in order.
};

/// Compares a solved trial with its detections, corner by corner, and groups the errors
/// by camera, tag and time. `detections` are those given to solve_motion(). A tag behind
/// its camera is not counted. Deterministic. Cost: some microseconds per sighting.
[[nodiscard]] TrialResiduals trial_residuals(const Body& body,
                                             std::span<const Camera> cameras,
                                             std::span<const CameraDetections> detections,
                                             const SolvedTrial& solved);

}  // namespace marey::reconstruct
