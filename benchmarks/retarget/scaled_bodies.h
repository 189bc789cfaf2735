// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/humanoid.h"
#include "core/skeleton.h"

namespace marey {

/// Lengths of the bones of another body, divided by the source's.
struct BodyScale {
  const char* name;
  double legs;
  double trunk;
  double arms;
};

[[nodiscard]] inline bool is_below(const Skeleton& skeleton,
                                   JointIndex joint,
                                   HumanBone bone) {
  std::optional<JointIndex> at = joint;
  while (at) {
    if (skeleton[*at].bone == bone) return true;
    at = skeleton[*at].parent;
  }
  return false;
}

[[nodiscard]] inline Skeleton scaled(const Skeleton& body, const BodyScale& scale) {
  Skeleton out = body;
  for (std::size_t j = 0; j < out.joints.size(); ++j) {
    const JointIndex joint{static_cast<int>(j)};
    const bool is_leg = is_below(body, joint, HumanBone::kLeftUpperLeg) ||
                        is_below(body, joint, HumanBone::kRightUpperLeg);
    const bool is_arm = is_below(body, joint, HumanBone::kLeftShoulder) ||
                        is_below(body, joint, HumanBone::kRightShoulder);
    const double by = is_leg || !body.joints[j].parent ? scale.legs
                      : is_arm                         ? scale.arms
                                                       : scale.trunk;
    out.joints[j].parent_from_joint.translation *= by;
    if (out.joints[j].tip_in_joint) *out.joints[j].tip_in_joint *= by;
  }
  return out;
}

}  // namespace marey
