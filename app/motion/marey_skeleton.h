// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/skeleton.h"

namespace marey::app {

/// Returns true for the skeletons that make_humanoid() makes: its bones in their order,
/// with no rotation at rest. A mannequin fits them. Linear in joints.
[[nodiscard]] bool is_marey_skeleton(const Skeleton& skeleton);

}  // namespace marey::app
