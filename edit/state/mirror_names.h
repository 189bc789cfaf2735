// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/ids.h"
#include "core/skeleton.h"

namespace marey::edit {

/// Returns the letter of the other side: R for L, l for r; the letter itself if it names
/// none.
[[nodiscard]] char other_side_letter(char c);

/// Returns a name with left and right exchanged: the first of the words left and right
/// (in lower case, capitals or with a capital), or a single L or R that stands at an end
/// of the name or between points, colons, dashes or underscores. The name itself without
/// such a word.
[[nodiscard]] std::string mirrored_name(std::string_view name);

/// Returns the counterpart of each joint on the other side; the joint itself in the
/// middle of the body or if there is none. Bones come before names. Always symmetric: the
/// counterpart of the counterpart is the joint.
[[nodiscard]] std::vector<JointIndex> mirrored_joints(const Skeleton& skeleton);

}  // namespace marey::edit
