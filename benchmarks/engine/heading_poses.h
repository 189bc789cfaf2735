// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "benchmarks/engine/transition_clips.h"
#include "core/pose.h"

namespace marey {

/// Place of the hips on the floor. The heading is the yaw of the hips from the T-pose: 0
/// faces +Z, positive turns towards +X.
struct FloorPlace {
  glm::dvec2 xz_m{0.0};
  double heading_rad = 0.0;
};

/// Movement of the hips on the floor in one step, in the heading frame of its start.
struct FloorStep {
  glm::dvec2 move_m{0.0};
  double turn_rad = 0.0;
};

/// Returns a vector of the floor (x, z) turned by a heading.
[[nodiscard]] glm::dvec2 turned(const glm::dvec2& xz, double heading_rad);

/// Returns the place after a step.
[[nodiscard]] FloorPlace after_step(const FloorPlace& place, const FloorStep& step);

/// A clip as engines play it: postures in the heading frame with the hips above its
/// origin, and steps of the root.
struct HeadingClip {
  std::vector<Pose> postures;
  std::vector<FloorStep> steps;  ///< From each frame to the next one; one less.
};

/// Splits a clip. Linear in frames.
[[nodiscard]] HeadingClip make_heading_clip(const TransitionClip& clip);

/// Returns a posture of the heading frame at a place in the world.
[[nodiscard]] Pose placed(const Pose& posture, const FloorPlace& place);

/// Returns the foot points relative to the hips' place on the floor, in the heading frame
/// [m]; the origin for missing toes.
[[nodiscard]] std::array<glm::dvec3, kFootPoints> foot_points(const TransitionClip& clip,
                                                              const Pose& posture);

}  // namespace marey
