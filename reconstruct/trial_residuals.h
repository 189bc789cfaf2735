// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "reconstruct/solve_motion.h"

namespace marey::reconstruct {

/// How far a solved motion is from what was seen, at the body's distance from the camera.
struct ResidualSize {
  double rms_m = 0.0;
  double median_m = 0.0;
  int corners = 0;
};

/// Errors of one camera. Those that follow the movement of what it sees are a clock's.
struct CameraResidual {
  ResidualSize size;
  /// By how much later than the solved motion, at least: the motion takes up a part.
  double late_s = 0.0;
  /// Share of its squared errors that this delay explains. 0 to 1
  double explained = 0.0;
};

struct TagResidual {
  TagId id{};
  HumanBone segment{};
  ResidualSize size;
};

/// Frames that follow each other.
struct StretchResidual {
  int first_frame = 0;
  int last_frame = 0;
  ResidualSize size;
};

struct TrialResiduals {
  ResidualSize all;
  std::vector<CameraResidual> cameras;    ///< In the order of the cameras.
  std::vector<TagResidual> tags;          ///< In the order of the body's; all of them.
  std::vector<StretchResidual> stretches; ///< Of half a second each, in order.
};

/// Compares a solved trial with its detections, corner by corner, by cameras, tags and
/// time. `detections` as solve_motion() had them. A tag behind its camera does not count.
/// Deterministic. Cost: some microseconds per sighting.
[[nodiscard]] TrialResiduals trial_residuals(
    const Body& body,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const SolvedTrial& solved);

}  // namespace marey::reconstruct
