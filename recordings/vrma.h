// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <glm/gtc/quaternion.hpp>

#include "core/motion.h"
#include "core/result.h"

namespace marey::recordings {

struct VrmaOptions {
  /// World rotation of each joint's frame in the T-pose facing +Z, as
  /// Character::t_pose_from_joint; empty when the rest pose is one. Borrowed.
  std::span<const glm::dquat> t_pose_from_joint;
  std::string clip = "motion";  ///< The animation's name.
};

/// The bytes of a VRM animation (.vrma: a GLB with VRMC_vrm_animation 1.0) of the joints
/// that are human bones.
///
/// Its rest is their T-pose on the floor of the rest pose, axes parallel to the world's,
/// so that a bone's rotation is how far its parent and it turned away from the T-pose.
/// The hips alone are moved; nothing is scaled. Linear keys at the motion's rate, the
/// first at time 0; neighbouring quaternions on the same side. Joints that are no human
/// bones are not kept: what they turn, the bones below them have; the bone above them is
/// turned so that what they move is in its direction, and its distance is lost.
/// glTF's own validator finds neither errors nor warnings. Same input, same bytes.
///
/// Errors (kBadInput): one of the 15 bones that VRM requires is not there, or does not
/// lie below those that VRM has above it.
/// Precondition: one root, which is the first joint; t_pose_from_joint and every pose
/// have one rotation per joint.
/// Cost: linear in frames times joints.
[[nodiscard]] Result<std::string> vrma_bytes(const Motion& motion,
                                             const VrmaOptions& options = {});

/// Writes vrma_bytes() to `path`, at once or not at all. Errors also as write_file()'s.
[[nodiscard]] Status write_vrma(const std::filesystem::path& path,
                                const Motion& motion,
                                const VrmaOptions& options = {});

}  // namespace marey::recordings
