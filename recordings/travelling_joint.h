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
  /// The largest movement of a joint against its parent that `pose` had to leave out. [m]
  double ignored_translation_m = 0.0;
};

/// The Pose nearest to a file's pose, in which every joint may move against its parent.
///
/// The travelling joint is the first one that branches or ends: the hips, possibly below
/// helper roots. It gets its exact place in the world, by moving the root; bones beyond
/// it keep their rest lengths. `parent_from_joint` has one entry per joint.
[[nodiscard]] PosedBones hand_travel_to_root(
    const Skeleton& skeleton, std::span<const RigidTransform> parent_from_joint);

}  // namespace marey::recordings
