// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/skeleton.h"

namespace marey::retarget {

/// An adult in T-pose whose joints are named as a program names them; nothing is marked.
/// `names` has one for each of human_bones(), in their order; a bone without a name is
/// taken out, its children hung on what carried it.
[[nodiscard]] Skeleton named_body(const std::vector<std::string>& names);

/// The same names for left and right: {side} in each stands for `left` or `right`.
/// `names` are of hips, spine, chest, upper chest, neck, head, shoulder, upper arm, lower
/// arm, hand, upper leg, lower leg, foot and toes.
[[nodiscard]] Skeleton sided_body(const std::vector<std::string>& names,
                                  const std::string& left,
                                  const std::string& right);

/// A joint between two: `name` lies at `share` of the way from the joint `below`'s parent
/// to it, and carries it.
[[nodiscard]] Skeleton with_joint_above(const Skeleton& skeleton,
                                        const std::string& below,
                                        const std::string& name,
                                        double share);

}  // namespace marey::retarget
