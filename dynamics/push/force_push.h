// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "dynamics/push/push_ends.h"
#include "dynamics/push/push_reach.h"
#include "dynamics/push/push_reference.h"

namespace marey::dynamics {

/// Number of coefficients of the correction (cubic B-splines with clamped knots).
inline constexpr int kForceCoefficients = 12;
/// Number of equally spaced instants, both ends included, at which a horizontal force is
/// bounded.
inline constexpr int kForceInstants = 64;

struct ForceLimits {
  /// Largest force per kilogram, of the vertical axis. nullopt: no limit. [m/s^2]
  std::optional<double> max_force_m_s2{};
  /// Lowest height that the body can reach. nullopt: no limit. [m]
  std::optional<double> deepest_m{};
  /// Highest height that the body can reach before the end. nullopt: no limit. [m]
  std::optional<double> highest_m{};
  /// The body falls before its lowest point and rises after it. Captured jumps often do
  /// not. Applied at kForceInstants instants; the lowest point is at the instant at which
  /// the push without this rule is lowest.
  bool fall_then_rise = false;
};

/// A push whose force is the reference's plus a smooth correction. The reference must
/// outlive it.
class ForcePush {
 public:
  /// Correction on one knot interval, and its integrals up to the interval's start, in
  /// units of the duration.
  struct Piece {
    std::array<double, 4> cubic_m_s2{};  ///< From u^0; u is 0 to 1 on the interval.
    double once_m_s2 = 0.0;
    double twice_m_s2 = 0.0;
  };
  static constexpr int kPieces = kForceCoefficients - 3;

  /// Precondition: 0 <= t_s <= duration_s(), for all three. Integrals are exact: the
  /// force is piecewise polynomial.
  [[nodiscard]] double height_m(double t_s) const;
  [[nodiscard]] double velocity_m_s(double t_s) const;
  [[nodiscard]] double force_m_s2(double t_s) const;
  [[nodiscard]] double duration_s() const { return ends_.duration_s; }
  [[nodiscard]] const std::array<double, kForceCoefficients>& correction_m_s2() const {
    return correction_m_s2_;
  }
  /// Largest magnitude of the coefficients, an upper bound of the correction. 0: the
  /// reference itself.
  [[nodiscard]] double largest_correction_m_s2() const;

  struct Extreme {
    double at = 0.0;  ///< t_s / duration_s().
    double force_m_s2 = 0.0;
  };
  struct Extremes {
    Extreme min, max;
  };
  /// Finds the smallest and largest force, between the samples of the reference, too.
  /// Exact; linear in samples.
  [[nodiscard]] Extremes extremes() const;

 private:
  friend class ForcePushMaker;
  PushEnds ends_;
  double gravity_m_s2_ = 0.0;  ///< 0 on a horizontal axis.
  const PushReference* reference_ = nullptr;
  double reference_scale_ = 1.0;  ///< Factor of the reference's force.
  std::array<double, kForceCoefficients> correction_m_s2_{};
  std::array<Piece, kPieces> pieces_{};
};

/// Treatment of the reference and of the ends.
///
/// A tied end without an acceleration has no correction: the force is the scaled
/// reference's, and the acceleration continues that of the motion around it. The tie is
/// elastic: where it would cost more than kTieCost, the correction at that end leaves 0
/// gradually (an exact penalty), so a tie never makes a push impossible, and the push
/// stays a continuous function of its ends. An end with an acceleration has the force
/// acceleration + gravity, at least 0, exactly. Any other end is free.
struct ForceEnds {
  bool tied_start = true;
  bool tied_end = true;
  double scale = 1.0;  ///< Factor of the reference's force.
};

/// Derives the vertical push between other ends: the smallest correction of the reference
/// (stretched to the new duration, times `scale`) that meets both end states to rounding,
/// with a force between -1e-6 g and the largest force + 1e-6 g at all times, between
/// samples, too. Smallest in the integral of the squared correction plus
/// 1e-4 T^4 times that of its squared second derivative (Kulpa 2005, 6.1, gives the
/// problem; the law is docs/accuracy/dynamics.md's). Where the ends' moments equal the
/// scaled reference's to 1e-12 and no limit is broken, the correction is exactly 0.
///
/// nullopt: is_reachable() is false, a value is not finite, or no correction of
/// kForceCoefficients coefficients obeys the limits (a narrow border inside the reachable
/// range). Dual active set; deterministic; allocates nothing. 3 microseconds without
/// active limits, about 20 with; the search of extremes is linear in samples.
/// Preconditions: duration_s and gravity above 0; scale not negative; the reference is
/// not negative.
[[nodiscard]] std::optional<ForcePush> derive_push(const PushReference& reference,
                                                   const PushEnds& ends,
                                                   const ForceLimits& limits = {},
                                                   const ForceEnds& at_ends = {});

/// Derives a push of a horizontal axis: no gravity, a force of any sign. Its magnitude at
/// kForceInstants instants is at most the given one (friction times the vertical force),
/// or the scaled reference's own where that is larger: a captured force was possible.
/// An end's acceleration is its force. nullopt: no such correction exists, or a value is
/// not finite. Preconditions and cost as derive_push().
[[nodiscard]] std::optional<ForcePush> derive_horizontal_push(
    const PushReference& reference,
    const PushEnds& ends,
    const std::array<double, kForceInstants>& largest_force_m_s2,
    const ForceEnds& at_ends = {});

}  // namespace marey::dynamics
