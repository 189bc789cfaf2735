// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "dynamics/push/push_ends.h"

namespace marey::dynamics {

/// Height of the centre of mass during a push as a polynomial of degree 7 (Kulpa 2005,
/// 6.3): through the states at both ends and through a lowest point in between.
struct ThesisPush {
  double duration_s = 0.0;
  double gravity_m_s2 = kStandardGravity_m_s2;
  /// Coefficients of x = t / duration_s, from x^0. [m]
  std::array<double, 8> coefficients_m{};
  double lowest_at = 0.0;  ///< x of the lowest point.

  /// Precondition: 0 <= t_s <= duration_s, for all three.
  [[nodiscard]] double height_m(double t_s) const;
  [[nodiscard]] double velocity_m_s(double t_s) const;
  /// Returns the force per kilogram: acceleration plus gravity.
  [[nodiscard]] double force_m_s2(double t_s) const;
};

/// Returns the polynomial that is at rest at height `lowest_m` at x = `lowest_at`, in
/// closed form: quintic Hermite of the ends plus x^3 (1 - x)^3 (a + b (x - lowest_at)).
/// Accelerations of the ends below free fall count as free fall: a measured end of less,
/// by noise, would leave no push at all. It may break the rules of allowed_heights().
/// nullopt: not finite, or duration or gravity not above 0. Allocates nothing.
/// Precondition: 0 < lowest_at < 1.
[[nodiscard]] std::optional<ThesisPush> thesis_push(const PushEnds& ends,
                                                    double lowest_at,
                                                    double lowest_m);

/// Rule of the search space that bounds an interval.
enum class PushRule {
  kForce,  ///< The push would be negative.
  kFall,   ///< The body would rise before its lowest point.
  kRise,   ///< The body would sink after its lowest point.
};
struct HeightBound {
  double height_m = 0.0;
  PushRule rule = PushRule::kForce;
  double at = 0.0;  ///< x at which the rule binds.
};
struct HeightInterval {
  HeightBound low;
  HeightBound high;
};

/// Returns the heights of the lowest point at x = `lowest_at` for which the force is
/// never negative, and the body falls before that point and rises after it (6.3.1). The
/// polynomial is affine in the height, so the heights form one interval. Exact to 1e-9 m
/// (bounds at 240 steps and the limits at both ends, then Newton on the binding ones).
/// nullopt: empty; also if the body rises at the start or sinks at the end, or if
/// thesis_push() has no answer. Accelerations of the ends below free fall count as free
/// fall. Some five microseconds; allocates nothing. Precondition: 0 < lowest_at < 1.
[[nodiscard]] std::optional<HeightInterval> allowed_heights(const PushEnds& ends,
                                                            double lowest_at);

/// One column of a search space.
struct SpaceColumn {
  double lowest_at = 0.0;
  HeightInterval heights;
};
/// Returns the search space of figure 6.7: its columns at the centres of `columns` equal
/// parts of (0, 1). Empty columns are left out. Precondition: columns above 0.
[[nodiscard]] std::vector<SpaceColumn> search_space(const PushEnds& ends,
                                                    int columns = 96);

/// Cost of a lowest point. NaN counts as infinite; an infinite cost excludes a point.
using PushCost = std::function<double(double lowest_at, double lowest_m)>;

/// Returns the squared distance from a wanted lowest point, with a deviation of 0.1 in x
/// and 0.1 m in height as units.
[[nodiscard]] PushCost near_point_cost(double lowest_at, double lowest_m);

/// Returns the push with the least cost within the search space (6.3.2): scans the
/// columns, takes the best height of each by golden section, and refines the best
/// column, to 1e-7 in x and 1e-7 m for a cost with one minimum in each column. The space
/// is not convex, so a descent alone may stop in a local minimum. nullopt: the space is
/// empty, or has no finite cost; also, rarely, a space that is narrower in x than a
/// column. Some hundred microseconds; allocates nothing by itself.
[[nodiscard]] std::optional<ThesisPush> choose_thesis_push(const PushEnds& ends,
                                                           const PushCost& cost);

}  // namespace marey::dynamics
