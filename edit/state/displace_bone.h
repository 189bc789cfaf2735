// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "edit/state/op_report.h"
#include "edit/state/op_weights.h"
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/humanoid.h"

namespace marey::edit {

/// Displacement of one bone, as PoseOp and OffsetOp state it.
struct BoneDisplacement {
  HumanBone bone = HumanBone::kHips;
  std::optional<glm::dquat> rotation;  ///< In the frame of the bone's parent.
  std::optional<glm::dvec3> moved_m;   ///< In the world.
};

/// Adds a displacement to a motion, in each frame by its weight (displacement map; Witkin
/// & Popovic 1995, "Motion warping", eq. 2 and 3): the share `weight` of the rotation's
/// angle, and of the way.
///
/// - A rotation is added in the frame of the bone's parent: q' = exp(w log r) q.
/// - A hand or a foot moves in the world, and its arm or leg follows analytically. A foot
///   keeps its rotation in the world, a hand follows the forearm. Where the limb is too
///   short the whole body helps, with the other foot, or both, in place
///   (reach_with_body()).
/// - The hips move in the world with all that they carry except the feet.
///
/// Feet keep their places if the hips move or turn, and, while they stand, if another
/// bone of a leg turns; the root is lowered where the legs are too short (hold_feet()).
/// Frames with weight 0 keep their pose to the bit. The lineage is touched, and frames
/// with a joint displaced by more than 10 mm are marked (mark_displaced()). Figures:
/// displaced_mm, missed_mm (distance from a target that is out of reach), lowered_mm,
/// feet_missed_mm. Costs some microseconds per frame, with the whole body's help some
/// tens more.
///
/// Errors (bad input, the place is a key of the recipe): no displacement; a bone that the
/// body does not have; `moved_m` for another bone than hands, feet and hips; numbers that
/// are not finite, more than 100 m, a rotation that is not unit; those of
/// reach_with_body(). Precondition: one weight per frame.
[[nodiscard]] Status displace_bone(const BoneDisplacement& displacement,
                                   const OpWeights& weights,
                                   EditState& state,
                                   OpReport& report);

}  // namespace marey::edit
