// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: robust estimates of poses from many proposals with outliers.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/transform.h"

namespace marey::calib {

/// Pose of b in a's frame.
struct Link {
  std::size_t a = 0;
  std::size_t b = 0;
  RigidTransform a_from_b;
  int support = 0;    ///< Number of proposals that agree with the pose.
  double spread = 0;  ///< Mean disagreement of these with the pose: metres plus radians.
};

/// Returns the distance in metres plus the angle in radians. A radian counts as much as a
/// metre, because cameras look at a volume a few metres away.
[[nodiscard]] double disagreement(const RigidTransform& x, const RigidTransform& y);

/// Proposals with this disagreement or more do not support each other. [m and rad]
inline constexpr double kMaxDisagreement = 0.3;

/// Returns the medoid of the proposals under a bounded distance. From many proposals, a
/// few hundred are evenly selected. Precondition: not empty.
[[nodiscard]] Link medoid_transform(std::size_t a,
                                    std::size_t b,
                                    std::span<const RigidTransform> a_from_b);

/// Chains links from `first` along a spanning tree (Prim's algorithm, best supported link
/// first). Returns x_from_first per element; nullopt if no link reaches it.
[[nodiscard]] std::vector<std::optional<RigidTransform>> propagate_poses(
    std::size_t first, std::span<const Link> links, std::size_t count);

}  // namespace marey::calib
