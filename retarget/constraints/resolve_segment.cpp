// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/resolve_segment.h"

#include "core/humanoid.h"

namespace marey::retarget {

std::optional<JointIndex> resolve_segment(const Skeleton& skeleton,
                                          std::string_view name) {
  if (const std::optional<HumanBone> bone = human_bone(name)) {
    if (const std::optional<JointIndex> joint = skeleton.find(*bone)) return joint;
  }
  return skeleton.find(name);
}

}  // namespace marey::retarget
