// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "core/skeleton.h"
#include "retarget/bones/found_bones.h"
#include "retarget/bones/neutral_evidence.h"

namespace marey::retarget {

/// Returns the T-pose of set_rest_t_pose(): the rotation of each joint's frame in marey's
/// axes. `foot_pitch_rad` as in NamedNeutral.
[[nodiscard]] std::vector<glm::dquat> t_pose_of_bones(const Skeleton& skeleton,
                                                      const FoundBones& found,
                                                      const NeutralEvidence& evidence,
                                                      double foot_pitch_rad);

}  // namespace marey::retarget
