// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "dynamics/push/push_ends.h"

namespace marey::dynamics {

/// Number of coefficients of the correction (cubic B-splines with clamped knots).
inline constexpr int kForceCoefficients = 12;
/// Number of instants at which the force is bounded.
inline constexpr int kForceInstants = 64;

/// The captured push of one axis, in the form from which another is derived.
/// Preparation is done once; deriving pushes from it allocates nothing.
struct PushReference {
  double duration_s = 0.0;
  /// Force per kilogram at equally spaced times from 0 to duration_s, linear in between;
  /// at least 2. Vertical: acceleration plus gravity, not negative. [m/s^2]
  std::vector<double> force_m_s2;
  /// Running integrals of the force, at the same times: once and twice.
  std::vector<double> impulse_m_s;
  std::vector<double> double_impulse_m;
};
/// Computes the integrals exactly. Precondition: duration_s above 0; at least 2 forces.
[[nodiscard]] PushReference make_push_reference(double duration_s,
                                                std::vector<double> force_m_s2);

struct ForceLimits {
  /// Largest force per kilogram, of the vertical axis. nullopt: no limit. [m/s^2]
  std::optional<double> max_force_m_s2{};
  /// Lowest height that the body can reach. nullopt: no limit. [m]
  std::optional<double> deepest_m{};
  /// The body falls before its lowest point and rises after it. Captured jumps often do
  /// not.
  bool fall_then_rise = false;
};

/// A push whose force is the reference's plus a smooth correction. The reference must
/// outlive it.
class ForcePush {
 public:
  /// Precondition: 0 <= t_s <= duration_s(), for all three. Integrals are exact: the
  /// force is piecewise polynomial.
  [[nodiscard]] double height_m(double t_s) const;
  [[nodiscard]] double velocity_m_s(double t_s) const;
  [[nodiscard]] double force_m_s2(double t_s) const;
  [[nodiscard]] double duration_s() const { return ends_.duration_s; }
  [[nodiscard]] const std::array<double, kForceCoefficients>& correction_m_s2() const {
    return correction_m_s2_;
  }
  /// Largest magnitude of the correction. 0: the reference itself.
  [[nodiscard]] double largest_correction_m_s2() const;

 private:
  friend class ForcePushMaker;
  PushEnds ends_;
  const PushReference* reference_ = nullptr;
  double reference_scale_ = 1.0;  ///< Of the reference's force.
  std::array<double, kForceCoefficients> correction_m_s2_{};
};

/// Moments of a force that ends require: its impulse, and its impulse of the remaining
/// time (height gained without the start's velocity).
struct PushMoments {
  double impulse_m_s = 0.0;     ///< m0 = integral of f.
  double first_moment_m = 0.0;  ///< m1 = integral of (T - t) f.
};
[[nodiscard]] PushMoments push_moments(const PushEnds& ends);
/// Returns true if a force between 0 and `max_force_m_s2` with these moments exists
/// (closed form, docs/accuracy/dynamics.md).
[[nodiscard]] bool is_reachable(const PushMoments& moments,
                                double duration_s,
                                std::optional<double> max_force_m_s2 = std::nullopt);

/// Derives the vertical push between other ends: the smallest correction of the reference
/// (stretched to the new duration, times `scale`) that meets both end states, with a
/// force never below 0 at kForceInstants instants (and between them: at least -1e-6 g),
/// by a primal active set. The correction is 0 at an end whose acceleration is nullopt
/// and whose `tied` is true, so the force continues there. nullopt: no such force exists,
/// or the rounds ended. Some ten microseconds; allocates nothing.
struct ForceEnds {
  bool tied_start = true;
  bool tied_end = true;
  double scale = 1.0;
};
[[nodiscard]] std::optional<ForcePush> derive_push(const PushReference& reference,
                                                   const PushEnds& ends,
                                                   const ForceLimits& limits = {},
                                                   const ForceEnds& at_ends = {});

/// Derives a push of a horizontal axis: no gravity, force of any sign, its magnitude at
/// most `friction` times the force of `vertical` at each instant. nullopt as above.
/// `along_limit` are the bounds at the kForceInstants instants, from the vertical push.
[[nodiscard]] std::optional<ForcePush> derive_horizontal_push(
    const PushReference& reference,
    const PushEnds& ends,
    const std::array<double, kForceInstants>& largest_force_m_s2,
    const ForceEnds& at_ends = {});

}  // namespace marey::dynamics
