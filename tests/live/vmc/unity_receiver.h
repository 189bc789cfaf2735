// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "core/skeleton.h"
#include "live/vmc/vmc_pose.h"

namespace marey::live {

/// Reference for a VMC receiver in Unity, computed with 4x4 matrices and without marey's
/// quaternion code: the avatar's nodes in a left-handed world, with local transforms set.

/// The avatar's nodes, local, as importers mirror them: S L S with S = diag(-1, 1, 1).
[[nodiscard]] std::vector<glm::dmat4> unity_nodes(const Skeleton& avatar);

/// The same of an avatar that rests in the T-pose, after its rotations were normalised
/// away: nodes that are only shifted.
[[nodiscard]] std::vector<glm::dmat4> normalised_unity_nodes(const Skeleton& avatar);

/// Returns every node's transform in Unity's world after `sent` is applied to the nodes
/// that are bones. `avatar` defines the parents.
[[nodiscard]] std::vector<glm::dmat4> shown_in_unity(const Skeleton& avatar,
                                                     std::vector<glm::dmat4> local,
                                                     const VmcPose& sent);

}  // namespace marey::live
