// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/skeleton.h"

namespace marey::recordings {

/// How high the first joint stands when the rest pose stands on the floor with its lowest
/// joint or tip: where a body rests whose file does not say. [m]
/// Precondition: one root, which is the first joint.
[[nodiscard]] double standing_height(const Skeleton& skeleton);

}  // namespace marey::recordings
