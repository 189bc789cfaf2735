// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "dynamics/push/dual_active_set.h"
#include "dynamics/push/force_push.h"
#include "dynamics/push/force_splines.h"
#include "dynamics/push/push_reference.h"

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

static_assert(kProgramSize == kForceCoefficients);
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
/// Weight of the squared second derivative, in units of the duration.
constexpr double kRoughnessWeight = 1e-4;
/// Rules are added while the worst force breaks its bound by more than this share of g.
constexpr double kForceTolerance = 5e-7;
constexpr double kHeightTolerance_m = 1e-7;
constexpr double kSpeedTolerance_m_s = 1e-7;
constexpr double kSameMoments = 1e-12;
constexpr int kMaxRules = 96;
/// Largest multiplier of a tied end, in units of g.
constexpr double kTieCost = 2.0;

/// Constants of the splines: computed once.
struct SplineTables {
  ForceSplines splines{kForceCoefficients};
  ProgramMatrix root{};
  ProgramRow impulse{};       ///< Integral of each spline.
  ProgramRow first_moment{};  ///< Integral of (1 - x) times each spline.
  std::array<ProgramRow, kForceInstants> values{};
  std::array<ProgramRow, kForceInstants> integrals{};
  std::array<ProgramRow, kForceInstants> double_integrals{};

  SplineTables() {
    const auto m = splines.roughness_matrix(kRoughnessWeight);
    ProgramMatrix matrix{};
    for (std::size_t i = 0; i < matrix.size(); ++i) {
      std::copy_n(m.begin() + static_cast<std::ptrdiff_t>(i * matrix.size()),
                  matrix.size(),
                  matrix[i].begin());
    }
    root = inverse_root(matrix);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double x = static_cast<double>(k) / (kForceInstants - 1);
      splines.write_values(x, values[k]);
      splines.write_integrals(x, integrals[k]);
      splines.write_double_integrals(x, double_integrals[k]);
    }
    impulse = integrals.back();
    first_moment = double_integrals.back();
  }
};

const SplineTables& spline_tables() {
  static const SplineTables tables;
  return tables;
}

double dot_program_rows(const ProgramRow& a, const ProgramRow& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double instant_x(std::size_t k) {
  return static_cast<double>(k) / (kForceInstants - 1);
}

bool all_finite(const PushEnds& ends, const ForceEnds& at_ends) {
  return std::isfinite(ends.start_m) && std::isfinite(ends.start_m_s) &&
         std::isfinite(ends.end_m) && std::isfinite(ends.end_m_s) &&
         std::isfinite(ends.duration_s) && std::isfinite(ends.gravity_m_s2) &&
         std::isfinite(ends.start_m_s2.value_or(0.0)) &&
         std::isfinite(ends.end_m_s2.value_or(0.0)) && std::isfinite(at_ends.scale);
}

}  // namespace

/// Solves one axis: the program, and the push as it stands at the program's point.
class ForcePushMaker {
 public:
  ForcePushMaker(const PushReference& reference,
                 const PushEnds& ends,
                 const ForceEnds& at_ends,
                 double gravity_m_s2)
      : at_ends_(at_ends) {
    push_.ends_ = ends;
    push_.gravity_m_s2_ = gravity_m_s2;
    push_.reference_ = &reference;
    push_.reference_scale_ = at_ends.scale;
  }

  /// Adds the moments and the ends.
  [[nodiscard]] bool meet_ends() {
    const SplineTables& tables = spline_tables();
    const PushEnds& ends = push_.ends_;
    const double t = ends.duration_s;
    const PushReference& reference = *push_.reference_;
    PushEnds on_axis = ends;
    on_axis.gravity_m_s2 = push_.gravity_m_s2_;
    const PushMoments moments = push_moments(on_axis);
    const double mean = moments.impulse_m_s / t;
    const double lever = moments.first_moment_m / (t * t);
    const double scale = at_ends_.scale;
    const double size = std::abs(mean) + ends.gravity_m_s2;
    const auto missing = [&](double wanted, double given) {
      const double out = wanted - given;
      return std::abs(out) <= kSameMoments * size ? 0.0 : out;
    };
    const double rest_mean = missing(mean, scale * reference_once(reference, 1.0));
    const double rest_lever = missing(lever, scale * reference_twice(reference, 1.0));
    return program_.add(equality(tables.impulse, rest_mean)) &&
           program_.add(equality(tables.first_moment, rest_lever)) &&
           meet_end(0, at_ends_.tied_start, ends.start_m_s2) &&
           meet_end(1, at_ends_.tied_end, ends.end_m_s2);
  }

  /// Adds rules until all limits of the vertical axis hold.
  [[nodiscard]] bool obey(const ForceLimits& limits) {
    for (int i = 0; i < kMaxRules; ++i) {
      update_push();
      const auto rule = broken_rule(limits);
      if (!rule) return true;
      if (!program_.add(*rule)) return false;
    }
    return false;
  }

  /// Adds rules until the magnitudes at the instants hold.
  [[nodiscard]] bool obey(const std::array<double, kForceInstants>& largest_m_s2) {
    for (int i = 0; i < kMaxRules; ++i) {
      auto rule = broken_magnitude(largest_m_s2);
      if (!rule) rule = broken_tie();
      if (!rule) {
        update_push();
        return true;
      }
      if (!program_.add(*rule)) return false;
    }
    return false;
  }

  [[nodiscard]] const ForcePush& push() const { return push_; }

 private:
  static ProgramRule equality(const ProgramRow& row, double value) {
    return {row, value, -kNoLimit, kNoLimit};
  }
  static ProgramRule at_least(const ProgramRow& row, double value) {
    return {row, value, 0.0, kNoLimit};
  }
  static ProgramRule at_most(const ProgramRow& row, double value) {
    ProgramRule rule{row, -value, 0.0, kNoLimit};
    for (double& entry : rule.row) entry = -entry;
    return rule;
  }

  [[nodiscard]] double tie_cost() const { return kTieCost * push_.ends_.gravity_m_s2; }
  static ProgramRow end_row(int end) {
    ProgramRow row{};
    row[end == 0 ? 0 : row.size() - 1] = 1.0;
    return row;
  }

  [[nodiscard]] bool meet_end(int end,
                              bool is_tied,
                              std::optional<double> acceleration_m_s2) {
    if (acceleration_m_s2) {
      const double reference =
          at_ends_.scale * reference_force(*push_.reference_, end == 0 ? 0.0 : 1.0);
      const double force = *acceleration_m_s2 + push_.gravity_m_s2_;
      const double least = push_.gravity_m_s2_ > 0.0 ? 0.0 : force;
      return program_.add(equality(end_row(end), std::max(force, least) - reference));
    }
    if (!is_tied) return true;
    return program_.add({end_row(end), 0.0, -tie_cost(), tie_cost(), end});
  }

  /// Returns a released tie whose correction has crossed 0.
  [[nodiscard]] std::optional<ProgramRule> broken_tie() const {
    for (int end = 0; end < 2; ++end) {
      const auto sign = program_.released_sign(end);
      if (!sign) continue;
      ProgramRow row = end_row(end);
      const double correction = dot_program_rows(row, program_.point());
      if (*sign * correction >= -kForceTolerance * push_.ends_.gravity_m_s2) continue;
      for (double& entry : row) entry *= *sign;
      return ProgramRule{row, 0.0, 0.0, 2.0 * tie_cost(), end, *sign};
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<ProgramRule> broken_rule(const ForceLimits& limits) {
    auto rule = broken_force(limits.max_force_m_s2);
    if (!rule) rule = broken_tie();
    if (!rule && limits.deepest_m) rule = broken_height(*limits.deepest_m);
    if (!rule && limits.highest_m) rule = broken_top(*limits.highest_m);
    if (!rule && limits.fall_then_rise) rule = broken_direction();
    return rule;
  }

  [[nodiscard]] std::optional<ProgramRule> broken_force(
      std::optional<double> max_force_m_s2) const {
    const double tolerance = kForceTolerance * push_.ends_.gravity_m_s2;
    const auto [min, max] = push_.extremes();
    const double below = -min.force_m_s2;
    const double above = max_force_m_s2 ? max.force_m_s2 - *max_force_m_s2 : 0.0;
    if (std::max(below, above) <= tolerance) return std::nullopt;
    const double x = below >= above ? min.at : max.at;
    ProgramRow row{};
    spline_tables().splines.write_values(x, row);
    const double reference = at_ends_.scale * reference_force(*push_.reference_, x);
    if (below >= above) return at_least(row, -reference);
    return at_most(row, *max_force_m_s2 - reference);
  }

  [[nodiscard]] std::size_t lowest_instant() const {
    std::size_t lowest = 0;
    double lowest_m = kNoLimit;
    for (std::size_t k = 0; k < kForceInstants; ++k) {
      const double height_m = push_.height_m(instant_x(k) * push_.duration_s());
      if (height_m < lowest_m) {
        lowest_m = height_m;
        lowest = k;
      }
    }
    return lowest;
  }

  [[nodiscard]] std::optional<ProgramRule> broken_height(double deepest_m) const {
    const std::size_t lowest = lowest_instant();
    double from_x = instant_x(lowest > 0 ? lowest - 1 : 0);
    double to_x = instant_x(std::min<std::size_t>(lowest + 1, kForceInstants - 1));
    const double t = push_.duration_s();
    for (int i = 0; i < 30; ++i) {  // Bisection for velocity 0.
      const double x = 0.5 * (from_x + to_x);
      (push_.velocity_m_s(x * t) < 0.0 ? from_x : to_x) = x;
    }
    const double x = from_x;
    const double height_m = push_.height_m(x * t);
    if (height_m >= deepest_m - kHeightTolerance_m) return std::nullopt;
    ProgramRow row{};
    spline_tables().splines.write_double_integrals(x, row);
    const double now = dot_program_rows(row, program_.point());
    return at_least(row, now + (deepest_m - height_m) / (t * t));
  }

  [[nodiscard]] std::optional<ProgramRule> broken_top(double highest_m) const {
    const double t = push_.duration_s();
    std::size_t highest = 0;
    double top_m = -kNoLimit;
    for (std::size_t k = 1; k + 1 < kForceInstants; ++k) {
      const double height_m = push_.height_m(instant_x(k) * t);
      if (height_m <= top_m) continue;
      top_m = height_m;
      highest = k;
    }
    if (top_m <= highest_m + kHeightTolerance_m) return std::nullopt;
    const double x = instant_x(highest);
    ProgramRow row{};
    spline_tables().splines.write_double_integrals(x, row);
    const double now = dot_program_rows(row, program_.point());
    return at_most(row, now + (highest_m - top_m) / (t * t));
  }

  [[nodiscard]] std::optional<ProgramRule> broken_direction() {
    if (!lowest_) lowest_ = lowest_instant();
    const double t = push_.duration_s();
    double worst_m_s = kSpeedTolerance_m_s;
    std::optional<std::size_t> worst;
    for (std::size_t k = 0; k < kForceInstants; ++k) {
      if (k == *lowest_) continue;
      const double speed_m_s = push_.velocity_m_s(instant_x(k) * t);
      const double wrong_m_s = k < *lowest_ ? speed_m_s : -speed_m_s;
      if (wrong_m_s <= worst_m_s) continue;
      worst_m_s = wrong_m_s;
      worst = k;
    }
    if (!worst) return std::nullopt;
    const ProgramRow& row = spline_tables().integrals[*worst];
    const double now = dot_program_rows(row, program_.point());
    if (*worst < *lowest_) return at_most(row, now - worst_m_s / t);
    return at_least(row, now + worst_m_s / t);
  }

  [[nodiscard]] std::optional<ProgramRule> broken_magnitude(
      const std::array<double, kForceInstants>& largest_m_s2) const {
    const SplineTables& tables = spline_tables();
    double worst = kForceTolerance * push_.ends_.gravity_m_s2;
    std::optional<std::size_t> at;
    bool is_above = false;
    for (std::size_t k = 0; k < kForceInstants; ++k) {
      const double correction = dot_program_rows(tables.values[k], program_.point());
      const double reference = reference_at(k);
      const double largest = std::max(largest_m_s2[k], std::abs(reference));
      const double excess = std::abs(reference + correction) - largest;
      if (excess <= worst) continue;
      worst = excess;
      at = k;
      is_above = reference + correction > 0.0;
    }
    if (!at) return std::nullopt;
    const double reference = reference_at(*at);
    const double largest = std::max(largest_m_s2[*at], std::abs(reference));
    if (is_above) return at_most(tables.values[*at], largest - reference);
    return at_least(tables.values[*at], -largest - reference);
  }

  [[nodiscard]] double reference_at(std::size_t k) const {
    return at_ends_.scale * reference_force(*push_.reference_, instant_x(k));
  }

  /// Copies the program's point into the push.
  void update_push() {
    const ForceSplines& splines = spline_tables().splines;
    push_.correction_m_s2_ = program_.point();
    constexpr double kWidth = 1.0 / ForcePush::kPieces;
    double once = 0.0;
    double twice = 0.0;
    for (int i = 0; i < ForcePush::kPieces; ++i) {
      ForcePush::Piece& piece = push_.pieces_[static_cast<std::size_t>(i)];
      std::array<double, 4> c{};
      for (int k = 0; k < 4; ++k) {
        const double weight = push_.correction_m_s2_[static_cast<std::size_t>(i + k)];
        const auto& cubic = splines.cubic(i, k);
        for (std::size_t m = 0; m < 4; ++m) c[m] += weight * cubic[m];
      }
      piece = {c, once, twice};
      twice += kWidth * once +
               kWidth * kWidth * (c[0] / 2.0 + c[1] / 6.0 + c[2] / 12.0 + c[3] / 20.0);
      once += kWidth * (c[0] + c[1] / 2.0 + c[2] / 3.0 + c[3] / 4.0);
    }
  }

  ForceEnds at_ends_;
  DualActiveSet program_{spline_tables().root};
  ForcePush push_;
  std::optional<std::size_t> lowest_;  ///< Instant for fall_then_rise.
};

std::optional<ForcePush> derive_push(const PushReference& reference,
                                     const PushEnds& ends,
                                     const ForceLimits& limits,
                                     const ForceEnds& at_ends) {
  if (!all_finite(ends, at_ends)) return std::nullopt;
  MAREY_ASSERT(ends.duration_s > 0.0 && ends.gravity_m_s2 > 0.0 && at_ends.scale >= 0.0);
  const PushMoments moments = push_moments(ends);
  if (!is_reachable(moments, ends.duration_s, limits.max_force_m_s2)) return std::nullopt;
  ForcePushMaker maker(reference, ends, at_ends, ends.gravity_m_s2);
  if (!maker.meet_ends() || !maker.obey(limits)) return std::nullopt;
  return maker.push();
}

std::optional<ForcePush> derive_horizontal_push(
    const PushReference& reference,
    const PushEnds& ends,
    const std::array<double, kForceInstants>& largest_force_m_s2,
    const ForceEnds& at_ends) {
  if (!all_finite(ends, at_ends)) return std::nullopt;
  MAREY_ASSERT(ends.duration_s > 0.0 && ends.gravity_m_s2 > 0.0 && at_ends.scale >= 0.0);
  ForcePushMaker maker(reference, ends, at_ends, 0.0);
  if (!maker.meet_ends() || !maker.obey(largest_force_m_s2)) return std::nullopt;
  return maker.push();
}

}  // namespace marey::dynamics
