// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "core/skeleton.h"
#include "live/vmc/vmc_pose.h"

namespace marey::live {

/// What a receiver in Unity makes of VMC, computed with 4x4 matrices and without a
/// quaternion of ours: the avatar's nodes in a left-handed world, local transforms set.

/// The avatar's nodes, local, as importers mirror them: S L S with S = diag(-1, 1, 1).
[[nodiscard]] std::vector<glm::dmat4> unity_nodes(const Skeleton& avatar);

/// The same of an avatar that rests in the T-pose, after its rotations were normalised
/// away: nodes that are only shifted.
[[nodiscard]] std::vector<glm::dmat4> normalised_unity_nodes(const Skeleton& avatar);

/// Every node's transform in Unity's world once `sent` was applied to those that are
/// bones; `avatar` says who is whose parent.
[[nodiscard]] std::vector<glm::dmat4> shown_in_unity(const Skeleton& avatar,
                                                     std::vector<glm::dmat4> local,
                                                     const VmcPose& sent);

}  // namespace marey::live
