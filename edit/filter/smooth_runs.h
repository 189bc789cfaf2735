// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/frame_range.h"

namespace marey::edit {

/// A vector in each frame of a run of frames.
struct VectorRun {
  FrameRange frames;
  std::vector<glm::dvec3> values;
};

/// Smooths runs, each apart, by cubic splines with one penalty, which generalised
/// cross-validation chooses for all runs of at least 8 frames together (half power at 1
/// Hz or above). Runs are left as they are if they have fewer than 5 frames, or less
/// noise than `min_noise`: the noise per axis is estimated by the median of the second
/// differences' lengths, so some frames of a planted foot that rolls do not count. All
/// are left if fewer than 20 frames remain for the choice. Linear in frames. The axes of
/// the values influence the choice. Precondition: hz > 0.
void smooth_runs(std::span<VectorRun> runs, double min_noise, double hz);

/// Returns the places of a foot over a run, along the foot's axes at its first frame.
[[nodiscard]] VectorRun places_in_run(std::span<const glm::dvec3> places,
                                      const glm::dquat& first_rotation,
                                      const FrameRange& frames);

}  // namespace marey::edit
