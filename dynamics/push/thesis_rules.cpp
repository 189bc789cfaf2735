// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/thesis_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Heights are affine in the height of the lowest point, so each rule at each x is one
// linear inequality of that height. The rules are divided by the factors that both of
// their parts share: the force by x (1 - x), the velocity by x^2 (1 - x)^2 (x - s). Then
// they are regular where a rule touches an end or the lowest point: a sum of poles at
// both ends and a polynomial.

namespace marey::dynamics {
namespace {

constexpr double kUnbounded_m = std::numeric_limits<double>::infinity();

/// One rule: a function of x, affine in the height z of the lowest point, that is never
/// negative:  p1/x + p2/x^2 + q1/(1-x) + q2/(1-x)^2 + fixed(x) + z per_m(x) >= 0.
struct HeightRule {
  double start_pole = 0.0;
  double start_pole_squared = 0.0;
  double end_pole = 0.0;
  double end_pole_squared = 0.0;
  std::array<double, 4> fixed{};
  std::array<double, 4> per_m{};

  [[nodiscard]] bool has_start_pole() const {
    return start_pole != 0.0 || start_pole_squared != 0.0;
  }
  [[nodiscard]] bool has_end_pole() const {
    return end_pole != 0.0 || end_pole_squared != 0.0;
  }
  /// Returns true if no height meets the rule close to an end.
  [[nodiscard]] bool fails_at_an_end() const {
    return start_pole_squared < 0.0 || (start_pole_squared == 0.0 && start_pole < 0.0) ||
           end_pole_squared < 0.0 || (end_pole_squared == 0.0 && end_pole < 0.0);
  }
};

double cubic(const std::array<double, 4>& c, double x) {
  return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}

/// Velocity in units of the duration at the quintic's start, in Bernstein form.
std::array<double, 5> quintic_velocity(const UnitEnds& e) {
  const double next = e.start_velocity + 0.25 * e.start_acceleration;
  const double before = e.end_velocity - 0.25 * e.end_acceleration;
  const double middle = 5.0 * e.rise - 2.0 * (e.start_velocity + e.end_velocity) -
                        0.25 * (e.start_acceleration - e.end_acceleration);
  return {e.start_velocity, next, middle, before, e.end_velocity};
}

/// Second derivative of a bump over x (1 - x).
std::array<double, 4> bent(const HeightBump& bump, double s) {
  const double b = bump.slope;
  const double a = bump.value - b * s;
  return {6.0 * a, 6.0 * (2.0 * b - 5.0 * a), 6.0 * (5.0 * a - 8.0 * b), 6.0 * 7.0 * b};
}

/// Derivative of a bump over x^2 (1 - x)^2 (x - s), less the part that the quintic
/// cancels at s.
std::array<double, 4> sloped(const HeightBump& bump, double s) {
  return {-6.0 * bump.value + bump.slope * (4.0 - s), -7.0 * bump.slope, 0.0, 0.0};
}

/// (Acceleration + gravity) over x (1 - x).
HeightRule force_rule(const UnitEnds& e, const HeightBumps& bumps, double s) {
  const auto v = quintic_velocity(e);
  const double gravity = e.start_force - e.start_acceleration;
  const double n1 = 4.0 * (v[2] - v[1]) + gravity;
  const double n2 = 4.0 * (v[3] - v[2]) + gravity;
  HeightRule rule;
  rule.start_pole = e.start_force;
  rule.end_pole = e.end_force;
  rule.fixed = bent(bumps.fixed, s);
  rule.fixed[0] += 3.0 * n1 - 2.0 * e.start_force - e.end_force;
  rule.fixed[1] += 3.0 * (n2 - n1) + e.start_force - e.end_force;
  rule.per_m = bent(bumps.per_m, s);
  return rule;
}

/// Velocity over x^2 (1 - x)^2 (x - s): not negative where the body falls before s and
/// rises after it, and above 0 at s where s is a minimum.
HeightRule velocity_rule(const UnitEnds& e, const HeightBumps& bumps, double s) {
  const auto v = quintic_velocity(e);
  const double from_end = 1.0 - s;
  HeightRule rule;
  rule.start_pole_squared = -v[0] / s;
  rule.start_pole = -(v[0] * (from_end / s - 1.0) + 4.0 * v[1]) / s;
  rule.end_pole_squared = v[4] / from_end;
  rule.end_pole = (v[4] * (s / from_end - 1.0) + 4.0 * v[3]) / from_end;
  rule.fixed = sloped(bumps.fixed, s);
  rule.per_m = sloped(bumps.per_m, s);
  return rule;
}

constexpr int kHeightInstants = 240;
struct InstantTable {
  std::array<double, kHeightInstants + 1> x{};
  /// 1/x and 1/(1-x); 0 at their poles, where a rule without that pole is sampled.
  std::array<double, kHeightInstants + 1> per_x{};
  std::array<double, kHeightInstants + 1> per_rest{};
};
constexpr InstantTable kTable = [] {
  InstantTable table;
  for (std::size_t i = 0; i <= kHeightInstants; ++i) {
    table.x[i] = static_cast<double>(i) / kHeightInstants;
    if (i > 0) table.per_x[i] = 1.0 / table.x[i];
    if (i < kHeightInstants) table.per_rest[i] = 1.0 / (1.0 - table.x[i]);
  }
  return table;
}();

/// Bounds of one rule at the instants, one element further on, so that each has two
/// neighbours. A bound of the high end has its sign changed: for both ends the largest
/// binds. -kUnbounded_m: the rule does not bound this end there.
struct SampledRule {
  std::array<double, kHeightInstants + 3> low_m;
  std::array<double, kHeightInstants + 3> minus_high_m;
  std::array<double, kHeightInstants + 1> per_m;
};

void sample_rule(const HeightRule& rule, SampledRule& out) {
  for (std::size_t i = 0; i <= kHeightInstants; ++i) {
    const double p = kTable.per_x[i];
    const double q = kTable.per_rest[i];
    const double fixed = p * (rule.start_pole + p * rule.start_pole_squared) +
                         q * (rule.end_pole + q * rule.end_pole_squared) +
                         cubic(rule.fixed, kTable.x[i]);
    const double per_m = cubic(rule.per_m, kTable.x[i]);
    const double bound_m = -fixed / per_m;
    out.per_m[i] = per_m;
    out.low_m[i + 1] = per_m > 0.0 ? bound_m : -kUnbounded_m;
    out.minus_high_m[i + 1] = per_m < 0.0 ? -bound_m : -kUnbounded_m;
  }
  for (auto* bounds : {&out.low_m, &out.minus_high_m}) {
    bounds->front() = bounds->back() = -kUnbounded_m;
    if (rule.has_start_pole()) (*bounds)[1] = -kUnbounded_m;
    if (rule.has_end_pole()) (*bounds)[kHeightInstants + 1] = -kUnbounded_m;
  }
}

/// The rule at one x: its parts, and the derivatives of the whole at the height that it
/// bounds there.
struct RuleAt {
  double fixed = 0.0;
  double per_m = 0.0;
  double bound_m = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
};

RuleAt rule_at(const HeightRule& rule, double x) {
  const double p = x > 0.0 ? 1.0 / x : 0.0;
  const double q = x < 1.0 ? 1.0 / (1.0 - x) : 0.0;
  RuleAt at;
  at.fixed = p * (rule.start_pole + p * rule.start_pole_squared) +
             q * (rule.end_pole + q * rule.end_pole_squared) + cubic(rule.fixed, x);
  at.per_m = cubic(rule.per_m, x);
  at.bound_m = -at.fixed / at.per_m;
  std::array<double, 4> whole{};
  for (std::size_t k = 0; k < 4; ++k)
    whole[k] = rule.fixed[k] + at.bound_m * rule.per_m[k];
  at.slope = -p * p * (rule.start_pole + 2.0 * p * rule.start_pole_squared) +
             q * q * (rule.end_pole + 2.0 * q * rule.end_pole_squared) + whole[1] +
             x * (2.0 * whole[2] + x * 3.0 * whole[3]);
  at.curvature = p * p * p * (2.0 * rule.start_pole + 6.0 * p * rule.start_pole_squared) +
                 q * q * q * (2.0 * rule.end_pole + 6.0 * q * rule.end_pole_squared) +
                 2.0 * whole[2] + x * 6.0 * whole[3];
  return at;
}

/// Moves x between `from` and `to` to where the bound binds most: Newton's method,
/// safeguarded by bisection, on the slope of the rule at its own bound.
void refine_bound(const HeightRule& rule,
                  bool of_force,
                  double from,
                  double x,
                  double to,
                  BindingHeight& out) {
  constexpr int kRounds = 60;
  constexpr double kClose = 1e-11;
  for (int round = 0; round < kRounds; ++round) {
    const RuleAt at = rule_at(rule, x);
    if (!(at.per_m * out.side > 0.0)) return;
    if (out.side * at.bound_m > out.side * out.height_m)
      out = {out.side, at.bound_m, x, of_force};
    // Ends of the interval, where the bound is largest at the end itself.
    if ((x == 0.0 && at.slope >= 0.0) || (x == 1.0 && at.slope <= 0.0)) return;
    (at.slope > 0.0 ? to : from) = x;
    double next = at.curvature > 0.0 ? x - at.slope / at.curvature : from;
    if (!(next > from && next < to)) next = 0.5 * (from + to);
    if (std::abs(next - x) < kClose) return;
    x = next;
  }
}

/// Tightens one end of the interval by the bound that binds most at the instants.
void tighten_by_instants(const std::array<double, kHeightInstants + 3>& bounds_m,
                         bool of_force,
                         BindingHeight& out) {
  const auto most = std::max_element(bounds_m.begin() + 1, bounds_m.end() - 1);
  if (!(*most > out.side * out.height_m)) return;
  const auto i = static_cast<std::size_t>(most - bounds_m.begin() - 1);
  out = {out.side, out.side * *most, kTable.x[i], of_force};
}

/// Tightens one end of the interval by the local extremes of a rule between the instants.
void tighten_between(const HeightRule& rule,
                     const std::array<double, kHeightInstants + 3>& bounds_m,
                     bool of_force,
                     BindingHeight& out) {
  constexpr std::size_t kLast = kHeightInstants;
  for (std::size_t i = 0; i <= kLast; ++i) {
    const double before = bounds_m[i];
    const double here = bounds_m[i + 1];
    const double after = bounds_m[i + 2];
    if (here < before || here < after || here == -kUnbounded_m) continue;
    // The top of the parabola through three instants, with a margin.
    const double bend = 2.0 * here - before - after;
    const double top = here + (after - before) * (after - before) / (4.0 * bend);
    if (top <= out.side * out.height_m) continue;
    refine_bound(rule,
                 of_force,
                 kTable.x[i - (i > 0 ? 1 : 0)],
                 kTable.x[i],
                 kTable.x[i + (i < kLast ? 1 : 0)],
                 out);
  }
  // Between a pole and the next instant a bound may be hidden.
  const double first = kTable.x[1];
  const double last = kTable.x[kLast - 1];
  if (rule.has_start_pole()) refine_bound(rule, of_force, 0.0, first, first, out);
  if (rule.has_end_pole()) refine_bound(rule, of_force, last, last, 1.0, out);
}

/// Returns true if the rule fails, whatever the height, where the height has no influence
/// on it.
bool fails_without_influence(const HeightRule& rule, const SampledRule& sampled) {
  for (std::size_t i = 0; i < kHeightInstants; ++i) {
    const double here = sampled.per_m[i];
    const double next = sampled.per_m[i + 1];
    if (here * next >= 0.0) continue;
    const double step = kTable.x[1];
    double x = kTable.x[i] + step * here / (here - next);
    for (int round = 0; round < 2; ++round) {
      const auto& c = rule.per_m;
      const double slope = c[1] + x * (2.0 * c[2] + x * 3.0 * c[3]);
      x = std::clamp(x - cubic(c, x) / slope, kTable.x[i], kTable.x[i + 1]);
    }
    if (rule_at(rule, x).fixed < 0.0) return true;
  }
  return false;
}

}  // namespace

std::optional<UnitEnds> unit_ends(const PushEnds& ends) {
  const double t = ends.duration_s;
  const double g = ends.gravity_m_s2;
  if (!(t > 0.0) || !std::isnormal(t * t) || !(g > 0.0)) return std::nullopt;
  const double start_m_s2 = std::max(ends.start_m_s2.value_or(0.0), -g);
  const double end_m_s2 = std::max(ends.end_m_s2.value_or(0.0), -g);
  UnitEnds unit;
  unit.rise = ends.end_m - ends.start_m;
  unit.start_velocity = ends.start_m_s * t;
  unit.end_velocity = ends.end_m_s * t;
  unit.start_acceleration = start_m_s2 * (t * t);
  unit.end_acceleration = end_m_s2 * (t * t);
  unit.start_force = (start_m_s2 + g) * (t * t);
  unit.end_force = (end_m_s2 + g) * (t * t);
  const double all = unit.rise + unit.start_velocity + unit.end_velocity +
                     unit.start_force + unit.end_force;
  return std::isfinite(all) ? std::optional(unit) : std::nullopt;
}

std::array<double, 6> end_quintic(const UnitEnds& e) {
  const double d = e.rise;
  const double v1 = e.start_velocity;
  const double v3 = e.end_velocity;
  const double a1 = e.start_acceleration;
  const double a3 = e.end_acceleration;
  return {0.0,
          v1,
          0.5 * a1,
          10.0 * d - 6.0 * v1 - 4.0 * v3 - 1.5 * a1 + 0.5 * a3,
          -15.0 * d + 8.0 * v1 + 7.0 * v3 + 1.5 * a1 - a3,
          6.0 * d - 3.0 * v1 - 3.0 * v3 - 0.5 * a1 + 0.5 * a3};
}

HeightBumps bumps_at(const std::array<double, 6>& c, double s) {
  const double height = s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5]))));
  const double slope =
      c[1] + s * (2.0 * c[2] + s * (3.0 * c[3] + s * (4.0 * c[4] + s * 5.0 * c[5])));
  const double one = s * (1.0 - s);
  const double w = one * one * one;
  const double steepness = 3.0 * (1.0 - 2.0 * s) / one;  // w'(s) / w(s)
  HeightBumps family;
  family.fixed.value = -height / w;
  family.fixed.slope = -slope / w - family.fixed.value * steepness;
  family.per_m.value = 1.0 / w;
  family.per_m.slope = -steepness / w;
  return family;
}

std::optional<RuledHeights> ruled_heights(const UnitEnds& ends, double s) {
  const HeightBumps bumps = bumps_at(end_quintic(ends), s);
  if (!std::isfinite(bumps.fixed.slope) || !std::isfinite(bumps.per_m.slope))
    return std::nullopt;
  const std::array rules{force_rule(ends, bumps, s), velocity_rule(ends, bumps, s)};
  RuledHeights heights;
  std::array<SampledRule, 2> sampled;
  for (std::size_t k = 0; k < 2; ++k) {
    if (rules[k].fails_at_an_end()) return std::nullopt;
    sample_rule(rules[k], sampled[k]);
    tighten_by_instants(sampled[k].low_m, k == 0, heights.low);
    tighten_by_instants(sampled[k].minus_high_m, k == 0, heights.high);
  }
  if (!(heights.width_m() >= 0.0)) return heights;
  for (std::size_t k = 0; k < 2; ++k) {
    if (fails_without_influence(rules[k], sampled[k])) return std::nullopt;
    tighten_between(rules[k], sampled[k].low_m, k == 0, heights.low);
    tighten_between(rules[k], sampled[k].minus_high_m, k == 0, heights.high);
  }
  return heights;
}

}  // namespace marey::dynamics
