// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: one answer from many proposals, some of them wrong.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/transform.h"

namespace marey::calib {

/// Where b is in a's frame.
struct Link {
  std::size_t a = 0;
  std::size_t b = 0;
  RigidTransform a_from_b;
  int support = 0;    ///< Proposals that agree with it.
  double spread = 0;  ///< Their mean disagreement with it: metres and radians together.
};

/// Metres and radians apart, summed: a radian counts like a metre, cameras look at a
/// volume a few metres away.
[[nodiscard]] double disagreement(const RigidTransform& x, const RigidTransform& y);

/// Proposals that disagree by this or more do not support each other. [m and rad]
inline constexpr double kFarApart = 0.3;

/// The proposal that most others are near (a medoid under a bounded distance). Of many, a
/// few hundred evenly chosen. Precondition: not empty.
[[nodiscard]] Link agree_on(std::size_t a,
                            std::size_t b,
                            std::span<const RigidTransform> a_from_b);

/// Prim's algorithm, best supported first: x_from_first of all that links reach.
[[nodiscard]] std::vector<std::optional<RigidTransform>> span_from(
    std::size_t first, std::span<const Link> links, std::size_t count);

}  // namespace marey::calib
