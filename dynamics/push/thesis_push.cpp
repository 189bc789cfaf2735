// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/thesis_push.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/push/thesis_rules.h"

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

constexpr int kScannedColumns = 96;
constexpr double kNoCost = std::numeric_limits<double>::infinity();
const double kGolden = 0.5 * (std::sqrt(5.0) - 1.0);

struct CostedX {
  double x = 0.0;
  double cost = kNoCost;
};

/// Finds a minimum of `cost` between `from` and `to` by golden section. Costs may be
/// infinite: then it stays near the best x so far, of which `best` is the first.
template <class Cost>
CostedX golden_section(
    const Cost& cost, double from, double to, double tolerance, CostedX best) {
  const auto probe = [&](double x) {
    const CostedX here{x, cost(x)};
    if (here.cost < best.cost) best = here;
    return here;
  };
  CostedX left = probe(to - kGolden * (to - from));
  CostedX right = probe(from + kGolden * (to - from));
  while (to - from > tolerance) {
    const bool both_infinite = left.cost == kNoCost && right.cost == kNoCost;
    if (both_infinite ? best.x < right.x : left.cost <= right.cost) {
      to = right.x;
      right = left;
      left = probe(to - kGolden * (to - from));
    } else {
      from = left.x;
      left = right;
      right = probe(from + kGolden * (to - from));
    }
  }
  return best;
}

/// Returns the best height of one column, above the world's origin; both ends are
/// candidates.
CostedX best_height(const PushCost& cost,
                    double lowest_at,
                    double low_m,
                    double high_m,
                    double tolerance_m) {
  const auto cost_at = [&](double height_m) {
    const double value = cost(lowest_at, height_m);
    return std::isnan(value) ? kNoCost : value;
  };
  CostedX best{low_m, cost_at(low_m)};
  const CostedX high{high_m, cost_at(high_m)};
  if (high.cost < best.cost) best = high;
  return golden_section(cost_at, low_m, high_m, tolerance_m, best);
}

double centre_of_column(int k, int columns) {
  return (k + 0.5) / columns;
}

/// Heights by which the rules miss each other at the centres of the columns; kNoCost: at
/// every height one fails.
using Narrowness = std::array<double, kScannedColumns>;

/// Returns an x at which the space is not empty although it is empty at all columns: it
/// is narrower than a column. Searches around the columns that miss it by the least, and
/// by little.
std::optional<double> find_narrow_space(const UnitEnds& ends, const Narrowness& columns) {
  constexpr int kParts = 24;
  constexpr double kPart = 2.0 / kScannedColumns / kParts;
  const auto narrowness = [&](double s) {
    const auto heights = s > 0.0 && s < 1.0 ? ruled_heights(ends, s) : std::nullopt;
    return heights ? -heights->width_m() : kNoCost;
  };
  const double little_m = 0.02 * (ends.start_force - ends.start_acceleration);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k] > little_m) continue;
    const double before = k > 0 ? columns[k - 1] : kNoCost;
    const double after = k + 1 < columns.size() ? columns[k + 1] : kNoCost;
    if (before < columns[k] || after < columns[k]) continue;
    const double centre = centre_of_column(static_cast<int>(k), kScannedColumns);
    CostedX best{centre, columns[k]};
    for (int part = 0; part < kParts; ++part) {
      const double s = centre + (part + 0.5 - 0.5 * kParts) * kPart;
      const double here = narrowness(s);
      if (here < best.cost) best = {s, here};
    }
    best = golden_section(narrowness, best.x - kPart, best.x + kPart, 1e-6, best);
    if (best.cost <= 0.0) return best.x;
  }
  return std::nullopt;
}

}  // namespace

double ThesisPush::height_m(double t_s) const {
  const double x = t_s / duration_s;
  double sum = 0.0;
  for (std::size_t k = 8; k-- > 0;) sum = sum * x + coefficients_m[k];
  return sum;
}

double ThesisPush::velocity_m_s(double t_s) const {
  const double x = t_s / duration_s;
  double sum = 0.0;
  for (std::size_t k = 8; k-- > 1;)
    sum = sum * x + static_cast<double>(k) * coefficients_m[k];
  return sum / duration_s;
}

double ThesisPush::force_m_s2(double t_s) const {
  const double x = t_s / duration_s;
  double sum = 0.0;
  for (std::size_t k = 8; k-- > 2;)
    sum = sum * x + static_cast<double>(k * (k - 1)) * coefficients_m[k];
  return sum / (duration_s * duration_s) + gravity_m_s2;
}

std::optional<ThesisPush> thesis_push(const PushEnds& ends,
                                      double lowest_at,
                                      double lowest_m) {
  MAREY_ASSERT(lowest_at > 0.0 && lowest_at < 1.0);
  const auto unit = unit_ends(ends);
  if (!unit) return std::nullopt;
  const auto quintic = end_quintic(*unit);
  const HeightBumps bumps = bumps_at(quintic, lowest_at);
  const double z = lowest_m - ends.start_m;
  const double b = bumps.fixed.slope + z * bumps.per_m.slope;
  const double a = bumps.fixed.value + z * bumps.per_m.value - b * lowest_at;

  ThesisPush push;
  push.duration_s = ends.duration_s;
  push.gravity_m_s2 = ends.gravity_m_s2;
  push.lowest_at = lowest_at;
  auto& c = push.coefficients_m;
  for (std::size_t k = 0; k < quintic.size(); ++k) c[k] = quintic[k];
  c[0] += ends.start_m;
  // (x^3 - 3 x^4 + 3 x^5 - x^6) (a + b x)
  c[3] += a;
  c[4] += b - 3.0 * a;
  c[5] += 3.0 * (a - b);
  c[6] += 3.0 * b - a;
  c[7] -= b;
  for (const double coefficient : c)
    if (!std::isfinite(coefficient / (ends.duration_s * ends.duration_s)))
      return std::nullopt;
  return push;
}

std::optional<HeightInterval> allowed_heights(const PushEnds& ends, double lowest_at) {
  MAREY_ASSERT(lowest_at > 0.0 && lowest_at < 1.0);
  const auto unit = unit_ends(ends);
  if (!unit) return std::nullopt;
  const auto heights = ruled_heights(*unit, lowest_at);
  if (!heights || !(heights->width_m() >= 0.0)) return std::nullopt;
  const auto bound_of = [&](const BindingHeight& end) {
    HeightBound bound{ends.start_m + end.height_m, PushRule::kForce, end.at};
    if (!end.of_force)
      bound.rule = end.at < lowest_at ? PushRule::kFall : PushRule::kRise;
    return bound;
  };
  return HeightInterval{bound_of(heights->low), bound_of(heights->high)};
}

std::vector<SpaceColumn> search_space(const PushEnds& ends, int columns) {
  MAREY_ASSERT(columns > 0);
  std::vector<SpaceColumn> space;
  space.reserve(static_cast<std::size_t>(columns));
  for (int k = 0; k < columns; ++k) {
    const double s = centre_of_column(k, columns);
    if (const auto heights = allowed_heights(ends, s)) space.push_back({s, *heights});
  }
  return space;
}

PushCost near_point_cost(double lowest_at, double lowest_m) {
  return [lowest_at, lowest_m](double at, double height_m) {
    constexpr double kDeviation = 0.1;
    constexpr double kDeviation_m = 0.1;
    const double across = (at - lowest_at) / kDeviation;
    const double up = (height_m - lowest_m) / kDeviation_m;
    return across * across + up * up;
  };
}

std::optional<ThesisPush> choose_thesis_push(const PushEnds& ends, const PushCost& cost) {
  const auto unit = unit_ends(ends);
  if (!unit) return std::nullopt;
  constexpr double kColumn = 1.0 / kScannedColumns;
  constexpr double kScanTolerance_m = 1e-3;
  constexpr double kTolerance_m = 1e-7;
  constexpr double kTolerance = 1e-7;
  const auto column_cost =
      [&](double s, const RuledHeights& heights, double tolerance_m) {
        return best_height(cost,
                           s,
                           ends.start_m + heights.low.height_m,
                           ends.start_m + heights.high.height_m,
                           tolerance_m);
      };

  CostedX best;
  Narrowness narrowness;
  narrowness.fill(kNoCost);
  bool is_empty = true;
  for (int k = 0; k < kScannedColumns; ++k) {
    const double s = centre_of_column(k, kScannedColumns);
    const auto heights = ruled_heights(*unit, s);
    if (!heights) continue;
    narrowness[static_cast<std::size_t>(k)] = -heights->width_m();
    if (!(heights->width_m() >= 0.0)) continue;
    is_empty = false;
    const CostedX here{s, column_cost(s, *heights, kScanTolerance_m).cost};
    if (here.cost < best.cost) best = here;
  }
  if (is_empty) {
    const auto narrow = find_narrow_space(*unit, narrowness);
    if (narrow)
      best = {*narrow,
              column_cost(*narrow, *ruled_heights(*unit, *narrow), kTolerance_m).cost};
  }
  if (best.cost == kNoCost) return std::nullopt;

  const auto cost_of_column = [&](double s) {
    const auto heights = ruled_heights(*unit, s);
    if (!heights || !(heights->width_m() >= 0.0)) return kNoCost;
    return column_cost(s, *heights, kTolerance_m).cost;
  };
  best.cost = cost_of_column(best.x);
  best = golden_section(cost_of_column,
                        std::max(best.x - kColumn, 0.25 * kColumn),
                        std::min(best.x + kColumn, 1.0 - 0.25 * kColumn),
                        kTolerance,
                        best);
  const auto heights = ruled_heights(*unit, best.x);
  return thesis_push(ends, best.x, column_cost(best.x, *heights, kTolerance_m).x);
}

}  // namespace marey::dynamics
