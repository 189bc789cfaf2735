// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/skeleton.h"
#include "recordings/motion/bvh.h"

namespace marey::recordings {

/// Returns the name of each joint in a BVH file: no blanks, all different. If joints need
/// the same name, human bones take precedence; the others get "_2", "_3".
[[nodiscard]] std::vector<std::string> bvh_names(const Skeleton& skeleton,
                                                 BvhNames names);

}  // namespace marey::recordings
