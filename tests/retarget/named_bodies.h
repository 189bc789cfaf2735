// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/skeleton.h"

namespace marey::retarget {

/// Returns an adult in T-pose with the joint names of a program; nothing is marked.
/// `names` has one for each of human_bones(), in their order; a bone without a name is
/// removed, its children become children of its parent.
[[nodiscard]] Skeleton named_body(const std::vector<std::string>& names);

/// Returns the same with the same names for left and right: {side} in each stands for
/// `left` or `right`. `names` are for hips, spine, chest, upper chest, neck, head,
/// shoulder, upper arm, lower arm, hand, upper leg, lower leg, foot and toes.
[[nodiscard]] Skeleton sided_body(const std::vector<std::string>& names,
                                  const std::string& left,
                                  const std::string& right);

/// Inserts a joint: `name` is at `share` of the way from the parent of the joint `below`
/// to it, and becomes its parent.
[[nodiscard]] Skeleton with_joint_above(const Skeleton& skeleton,
                                        const std::string& below,
                                        const std::string& name,
                                        double share);

}  // namespace marey::retarget
