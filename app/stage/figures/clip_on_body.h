// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "app/engine/clip_on_body.h"
#include "app/stage/figures/sway_spectrum.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"

namespace marey::app {

/// Returns the joints whose places count for jerk: those with a human bone.
[[nodiscard]] std::vector<JointIndex> marked_joints(const Skeleton& skeleton);

/// Returns the mean jerk of the marked joints over a clip, once from start to end, in
/// steps of step_s; nullopt: the clip has fewer than four steps. [m/s^3]
[[nodiscard]] std::optional<double> clip_jerk_m_s3(ClipOnBody& clip,
                                                   const Skeleton& skeleton,
                                                   double step_s);

/// Returns the heading of a body: the yaw of its hips' rotation from the T-pose. [rad]
[[nodiscard]] double hips_heading_rad(std::span<const RigidTransform> world_from_joint,
                                      const retarget::BodyMap& map);

/// Returns the place at which the lean of a body ends: the neck, else the head, else the
/// middle of both upper arms.
[[nodiscard]] glm::dvec3 neck_in_world(std::span<const RigidTransform> world_from_joint,
                                       const retarget::BodyMap& map);

/// Computes the lateral lean of a clip in steps of step_s, from `from_s` on. [rad]
[[nodiscard]] std::vector<double> clip_lean_rad(ClipOnBody& clip,
                                                const retarget::BodyMap& map,
                                                double from_s,
                                                double step_s,
                                                std::size_t steps);

}  // namespace marey::app
