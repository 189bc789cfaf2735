// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/body.h"
#include "core/detection.h"
#include "tests/support/simulation/simulated_exercise.h"
#include "tests/support/simulation/simulated_rig.h"
#include "tests/support/simulation/simulated_sight.h"
#include "tests/support/simulation/simulated_tags.h"

namespace marey::testing {

/// One trial: the movement and the cameras' detections of it.
struct SimulatedTrial {
  Exercise exercise;
  double hz = 30.0;
  std::vector<double> offsets_s;  ///< Per camera: frame k was exposed at k / hz + this.
  std::vector<CameraDetections> detections;  ///< One per camera, without clock offsets.
};

/// A whole session at corner level, with its truth.
struct SimulatedSession {
  std::uint64_t seed = 0;
  SimulatedBody body;
  SimulatedRig rig;
  TagStyle style;
  Diligence diligence = Diligence::kGood;
  std::vector<GluedTag> tags;  ///< Ascending ids.
  Attitude reference{};
  SimulatedTrial standing;
  SimulatedTrial moving;  ///< The range of motion.
  SimulatedTrial motion;  ///< The trial to solve, 60 to 120 frames.

  /// Returns the tags as session.toml lists them.
  [[nodiscard]] std::vector<TagOnSegment> declared_tags() const;
  /// Returns the true frames of all bones at a time of a trial's first camera.
  [[nodiscard]] BoneFrames truth(const SimulatedTrial& trial, double time_s) const;
  /// One line: cameras, tags, exercise.
  [[nodiscard]] std::string summary() const;
};

/// The session of this number: the same on every machine.
[[nodiscard]] SimulatedSession simulate_session(std::uint64_t seed);

}  // namespace marey::testing
