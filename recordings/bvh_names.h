// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/skeleton.h"
#include "recordings/bvh.h"

namespace marey::recordings {

/// What each joint is called in a BVH file: no blanks, no two alike. Of joints that ask
/// for the same name, those that are human bones come first; the others get "_2", "_3".
[[nodiscard]] std::vector<std::string> bvh_names(const Skeleton& skeleton,
                                                 BvhNames names);

}  // namespace marey::recordings
