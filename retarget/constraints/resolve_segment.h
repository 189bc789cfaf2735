// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "core/base/ids.h"
#include "core/skeleton.h"

namespace marey::retarget {

/// Returns the joint of the segment `name`: the joint mapped to VRM's bone of this name,
/// else the joint of this name. Linear in joints.
[[nodiscard]] std::optional<JointIndex> resolve_segment(const Skeleton& skeleton,
                                                        std::string_view name);

}  // namespace marey::retarget
