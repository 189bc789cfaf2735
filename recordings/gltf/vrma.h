// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <glm/gtc/quaternion.hpp>

#include "core/base/result.h"
#include "core/motion.h"

namespace marey::recordings {

struct VrmaOptions {
  /// World rotation of each joint's frame in the T-pose facing +Z, as
  /// Character::t_pose_from_joint; empty if the rest pose is a T-pose. Borrowed.
  std::span<const glm::dquat> t_pose_from_joint;
  std::string clip = "motion";  ///< Name of the animation.
};

/// Returns the bytes of a VRM animation (.vrma: a GLB with VRMC_vrm_animation 1.0) of the
/// joints that are human bones.
///
/// Its rest pose is their T-pose on the floor of the rest pose, with axes parallel to the
/// world's. A bone's rotation is therefore relative to the T-pose. Only the hips are
/// moved; no scale. Linear keys at the motion's rate, the first at time 0; neighbouring
/// quaternions have the same sign. Joints that are no human bones are not stored: their
/// rotations are applied to the bones below them. The bone above them is rotated to keep
/// the direction of its child bone, whose distance is lost. glTF's own validator finds
/// neither errors nor warnings. Same input, same bytes.
///
/// Errors (kBadInput): one of the 15 bones that VRM requires is missing, or is not below
/// VRM's ancestors of it. Preconditions: one root, which is the first joint;
/// t_pose_from_joint and every pose have one rotation per joint. Cost: linear in frames
/// times joints.
[[nodiscard]] Result<std::string> vrma_bytes(const Motion& motion,
                                             const VrmaOptions& options = {});

/// Writes vrma_bytes() to `path`, as a whole or not at all. Errors: also those of
/// write_file().
[[nodiscard]] Status write_vrma(const std::filesystem::path& path,
                                const Motion& motion,
                                const VrmaOptions& options = {});

}  // namespace marey::recordings
