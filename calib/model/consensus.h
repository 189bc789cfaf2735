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

/// Relative pose of two elements (cameras, or tags of a target), which are numbered:
/// the pose of element b in the frame of element a.
struct Link {
  std::size_t a = 0;
  std::size_t b = 0;
  RigidTransform a_from_b;
  int support = 0;    ///< Number of proposals that agree with the pose.
  double spread = 0;  ///< Mean disagreement() of these proposals with the pose.
};

/// Returns the distance in metres plus the angle in radians. A radian counts as much as a
/// metre, because cameras look at a volume a few metres away.
[[nodiscard]] double disagreement(const RigidTransform& x, const RigidTransform& y);

/// Proposals support each other if their disagreement() is below this limit.
inline constexpr double kMaxDisagreement = 0.3;

/// Returns the medoid of the proposals: the one with the minimum sum of disagreements
/// with the others, where one counts as at most kMaxDisagreement. An even selection of
/// 400 is used if there are more. Quadratic in the number of used proposals.
/// Precondition: not empty.
[[nodiscard]] Link medoid_transform(std::size_t a,
                                    std::size_t b,
                                    std::span<const RigidTransform> a_from_b);

/// Computes the poses of `count` elements relative to the element `first` along a
/// spanning tree of links (Prim's algorithm, largest support first). Returns x_from_first
/// per element x; nullopt if no chain of links reaches it. Precondition: elements of
/// links are below `count`.
[[nodiscard]] std::vector<std::optional<RigidTransform>> propagate_poses(
    std::size_t first, std::span<const Link> links, std::size_t count);

}  // namespace marey::calib
