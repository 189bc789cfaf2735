// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/skeleton.h"

namespace marey::recordings {

/// Returns the height of the first joint if the lowest joint or tip of the rest pose is
/// on the floor. Used for files that do not state the root's position. [m] Precondition:
/// one root, which is the first joint.
[[nodiscard]] double standing_height(const Skeleton& skeleton);

}  // namespace marey::recordings
