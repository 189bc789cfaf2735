// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"

namespace marey::recordings {

struct PosedBones {
  Pose pose;
  /// Largest movement of a joint relative to its parent that `pose` does not contain. [m]
  double ignored_translation_m = 0.0;
};

/// Converts a file's pose, in which every joint may move relative to its parent, to the
/// nearest Pose.
///
/// The reference joint is the first one that branches or ends: the hips, possibly below
/// helper roots. Its world position is exact, because the root is moved; bones beyond it
/// keep their rest lengths. `parent_from_joint` has one entry per joint.
[[nodiscard]] PosedBones bake_root_motion(
    const Skeleton& skeleton, std::span<const RigidTransform> parent_from_joint);

}  // namespace marey::recordings
