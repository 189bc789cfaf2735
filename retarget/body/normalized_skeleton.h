// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_pose.h"

namespace marey::retarget {

/// Removes the body's size from a posture (eq. 1.3). Lossless: expand() on the same body
/// restores every marked bone and vertebra. One to two microseconds; allocates nothing.
/// Precondition: `world_from_joint` are the joints' frames in the world, as
/// world_from_joints() returns them, for the skeleton that `map` was made from.
void normalize(const BodyMap& map,
               std::span<const RigidTransform> world_from_joint,
               NormalizedPose& out,
               RootNormalization root = RootNormalization::kLegLength);

/// Normalizes in one call; allocates its forward kinematics.
[[nodiscard]] NormalizedPose normalize(
    const Skeleton& skeleton,
    const BodyMap& map,
    const Pose& pose,
    RootNormalization root = RootNormalization::kLegLength);

/// Applies a normalized posture to a body (eq. 1.4). Limb ends are at root + v * sum of
/// lengths, elbows and knees follow from the law of cosines. Vertebrae are sampled from
/// the spine curves and turned so that neck and shoulders reach the positions that these
/// determine (place_spine()). A limb that cannot fold or stretch as far as required goes
/// as far as it can. Joints without a mark, and bones that the source does not have, keep
/// their rest rotation in their parent. `world_from_joint` gets every joint's frame in
/// the world, `out` the pose. A few microseconds; allocates nothing when `out` has one
/// entry per joint already.
/// Precondition: `map` was made from `body`; one `world_from_joint` per joint.
void expand(const NormalizedPose& pose,
            const Skeleton& body,
            const BodyMap& map,
            std::span<RigidTransform> world_from_joint,
            Pose& out);

/// Expands in one call; allocates its result.
[[nodiscard]] Pose expand(const NormalizedPose& pose,
                          const Skeleton& body,
                          const BodyMap& map);

/// Returns the length by which a body's root position is divided [m]; 1 for kNone.
/// Precondition: kArmLength only for a body with arms.
[[nodiscard]] double root_unit_m(const BodyMap& map, RootNormalization root);

}  // namespace marey::retarget
