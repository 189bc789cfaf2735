// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "core/skeleton.h"

namespace marey::library {

/// Skeletons that a library's clips can be put on, all with the 22 bones of
/// human_bones().
enum class NamedSkeleton {
  kMarey,    ///< VRM's names and order.
  kSmpl22,   ///< SMPL's names and order.
  kLafan22,  ///< LaFAN1's names and order.
};

/// Returns "marey", "smpl22" or "lafan22".
[[nodiscard]] std::string_view name(NamedSkeleton skeleton);
/// Accepts also "humanoid", which is kMarey.
[[nodiscard]] std::optional<NamedSkeleton> named_skeleton(std::string_view name);

/// Returns the skeleton of an average adult of this stature (average_proportions()) with
/// these names: at rest in a T-pose that faces +Z, all joints' axes parallel to the
/// world's. SMPL's and LaFAN1's own bone lengths are not used; SMPL's licence forbids
/// their distribution. Precondition: stature_m > 0.
[[nodiscard]] Skeleton make_named_skeleton(NamedSkeleton skeleton,
                                           double stature_m = 1.75);

}  // namespace marey::library
