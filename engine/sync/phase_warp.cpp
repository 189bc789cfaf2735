// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/phase_warp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/sync/rate_range.h"

#include "core/base/assert.h"

namespace marey::engine {
namespace {

/// New pieces keep this far within the limits of the rate, so that a later replan can
/// always bring the acceleration to 0 in time.
constexpr double kRateMargin = 1e-6;
constexpr double kLowRate = kMinWarpRate + kRateMargin;
constexpr double kHighRate = kMaxWarpRate - kRateMargin;
/// Minimum time of a change of rate. [s]
constexpr double kMinRamp_s = 0.02;
/// Maximum time in which a replan brings the acceleration to 0. [s]
constexpr double kMaxEase_s = 0.1;
/// Time in which the rate becomes end_rate without a knot. [s]
constexpr double kEndRamp_s = 0.2;

using Coefficients = std::array<double, 6>;

/// Returns the quintic over x in [0, 1] with this change over `length_s`, rate and
/// acceleration at the start, and rate at the end with acceleration 0.
Coefficients quintic(double source_s,
                     double change_s,
                     double length_s,
                     double rate,
                     double acceleration,
                     double end_rate) {
  const double v = rate * length_s;
  const double w = end_rate * length_s;
  const double a = 0.5 * acceleration * length_s * length_s;
  // On a line, rounding would leave an acceleration.
  constexpr double kRounding = 1e-12;
  if (std::abs(rate - end_rate) <= kRounding && a == 0.0 &&
      std::abs(change_s - v) <= kRounding * std::min(1.0, v)) {
    return {source_s, v, 0.0, 0.0, 0.0, 0.0};
  }
  return {source_s,
          v,
          a,
          10.0 * change_s - 6.0 * v - 4.0 * w - 3.0 * a,
          -15.0 * change_s + 8.0 * v + 7.0 * w + 3.0 * a,
          6.0 * change_s - 3.0 * v - 3.0 * w - a};
}

/// Limits of the rates at both ends of an interval with this mean rate between which a
/// quintic without acceleration at its ends keeps the rate within its limits: in the
/// middle its rate is 1.875 times the mean, minus 0.875 times the mean of both ends.
std::array<double, 2> end_rates(double mean) {
  return {std::max(kLowRate, (1.875 * mean - kHighRate) / 0.875),
          std::min(kHighRate, (1.875 * mean - kLowRate) / 0.875)};
}

}  // namespace

/// The end of the course so far, and the pieces that are added to it.
struct PhaseWarp::Course {
  PhaseWarp& warp;
  double time_s = 0.0;
  double source_s = 0.0;
  double rate = 1.0;
  double acceleration = 0.0;

  void add(double length_s, const Coefficients& c) {
    warp.pieces_[warp.count_++] = {time_s, length_s, c};
    time_s += length_s;
  }

  /// Changes the rate, and the acceleration to 0, so that both change evenly.
  void ramp(double length_s, double end_rate) {
    if (length_s <= 0.0) return;
    const double change_s = 0.5 * length_s * (rate + end_rate);
    add(length_s, quintic(source_s, change_s, length_s, rate, 0.0, end_rate));
    source_s += change_s;
    rate = end_rate;
  }

  /// Brings the acceleration to 0 linearly.
  void ease(double max_s) {
    if (acceleration == 0.0) return;
    const double room = acceleration < 0.0 ? rate - kMinWarpRate : kMaxWarpRate - rate;
    const double d = std::min(max_s, 1.9 * room / std::abs(acceleration));
    if (d > 0.0) {
      const double a = acceleration * d * d;
      add(d, {source_s, rate * d, 0.5 * a, -a / 6.0, 0.0, 0.0});
      source_s += rate * d + a / 3.0;
      rate += 0.5 * acceleration * d;
    }
    acceleration = 0.0;
  }

  /// Ends exactly at this knot.
  void end_at(const WarpKnot& knot, double end_rate) {
    time_s = knot.time_s;
    source_s = knot.source_s;
    rate = end_rate;
    acceleration = 0.0;
  }

  /// Adds one quintic to a knot if the rate stays within its limits.
  bool single(const WarpKnot& knot, double end_rate) {
    const double length_s = knot.time_s - time_s;
    const Coefficients c = quintic(
        source_s, knot.source_s - source_s, length_s, rate, acceleration, end_rate);
    const bool is_line = c[2] == 0.0 && c[3] == 0.0 && c[4] == 0.0 && c[5] == 0.0;
    const RateRange range = rate_range(c, length_s);
    if (!is_line && (range.min < kLowRate || range.max > kHighRate)) {
      // The rates at the ends may be the limits themselves.
      const double low = std::min({kLowRate, rate, end_rate});
      const double high = std::max({kHighRate, rate, end_rate});
      if (acceleration != 0.0 || range.min < low || range.max > high) return false;
    }
    add(length_s, c);
    end_at(knot, end_rate);
    return true;
  }

  /// Returns the source time at `knot.time_s` nearest to that of the knot that a ramp, a
  /// constant rate and a ramp reach. Precondition: acceleration 0.
  [[nodiscard]] double nearest_source_s(const WarpKnot& knot, double end_rate) const {
    const double length_s = knot.time_s - time_s;
    const double ramp_s = std::min(kMinRamp_s, 0.5 * length_s);
    const double ramps_s = ramp_s * 0.5 * (rate + end_rate);
    const double low_s = kLowRate * (length_s - ramp_s) + ramps_s;
    const double high_s = kHighRate * (length_s - ramp_s) + ramps_s;
    return source_s + std::clamp(knot.source_s - source_s, low_s, high_s);
  }

  /// Adds the longest ramps with a constant rate between them. Precondition: the knot is
  /// nearest_source_s(); acceleration 0.
  void ramps(const WarpKnot& knot, double end_rate) {
    const double length_s = knot.time_s - time_s;
    const double change_s = knot.source_s - source_s;
    const double ends = 0.5 * (rate + end_rate);
    double ramp_s = 0.5 * length_s;
    // The rate between, (change - ramp * ends) / (length - ramp), is monotone in ramp.
    if (ends > kLowRate) {
      ramp_s = std::min(ramp_s, (change_s - kLowRate * length_s) / (ends - kLowRate));
    }
    if (ends < kHighRate) {
      ramp_s = std::min(ramp_s, (kHighRate * length_s - change_s) / (kHighRate - ends));
    }
    ramp_s = std::max(ramp_s, 0.0);
    const double middle_s = length_s - 2.0 * ramp_s;
    const double middle_rate =
        std::clamp((change_s - ramp_s * ends) / (length_s - ramp_s), kLowRate, kHighRate);
    const double stop_s = knot.time_s;
    ramp(ramp_s, middle_rate);
    constexpr double kMinPiece_s = 1e-9;
    if (middle_s > kMinPiece_s) ramp(middle_s, middle_rate);
    ramp(stop_s - time_s, end_rate);
    end_at(knot, end_rate);
  }

  /// Returns whether `knot` can be met from here.
  [[nodiscard]] bool reaches(const WarpKnot& knot, double end_rate) const;
};

namespace {

/// Slope at knot k of the course from `start`.
double slope(const WarpKnot& before, const WarpKnot& at, const WarpKnot& after) {
  const double a = (at.source_s - before.source_s) / (at.time_s - before.time_s);
  const double b = (after.source_s - at.source_s) / (after.time_s - at.time_s);
  // The knot itself is out of reach if the mean is not positive; its neighbours decide.
  const double mean = a <= 0.0 ? kLowRate : (a == b ? a : 2.0 * a * b / (a + b));
  if (std::abs(a - b) <= 1e-12) return std::clamp(a, kMinWarpRate, kMaxWarpRate);
  const auto [low_a, high_a] = end_rates(std::clamp(a, kLowRate, kHighRate));
  const auto [low_b, high_b] = end_rates(std::clamp(b, kLowRate, kHighRate));
  const double low = std::max(low_a, low_b);
  const double high = std::min(high_a, high_b);
  return low <= high ? std::clamp(mean, low, high)
                     : std::clamp(mean, kLowRate, kHighRate);
}

}  // namespace

bool PhaseWarp::Course::reaches(const WarpKnot& knot, double end_rate) const {
  PhaseWarp trial_warp;
  Course trial{trial_warp, time_s, source_s, rate, acceleration};
  if (knot.time_s - time_s < 2.0 * kMinRamp_s) return false;
  if (trial.single(knot, end_rate)) return true;
  trial.ease(std::min(kMaxEase_s, (knot.time_s - time_s) / 3.0));
  return trial.nearest_source_s(knot, end_rate) == knot.source_s ||
         std::abs(trial.nearest_source_s(knot, end_rate) - knot.source_s) < 1e-12;
}

void PhaseWarp::start(double now_s, double source_s, double rate) {
  MAREY_ASSERT(rate >= kMinWarpRate && rate <= kMaxWarpRate);
  count_ = 0;
  end_s_ = now_s;
  end_source_s_ = source_s;
  end_rate_ = rate;
}

std::size_t PhaseWarp::keep_until(double now_s, double until_s) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const double next_s = i + 1 < count_ ? pieces_[i + 1].start_s : end_s_;
    if (next_s <= now_s || pieces_[i].start_s >= until_s) continue;
    pieces_[kept++] = pieces_[i];
  }
  if (end_s_ < until_s) {
    const double from_s = std::max(now_s, end_s_);
    const double length_s = until_s - from_s;
    if (length_s > 0.0) {
      pieces_[kept++] = {
          from_s,
          length_s,
          {end_source_s_ + end_rate_ * (from_s - end_s_), end_rate_ * length_s}};
    }
  }
  return kept;
}

bool PhaseWarp::replan(double now_s,
                       std::span<const WarpKnot> knots,
                       double end_rate,
                       double keep_s) {
  const double from_s = now_s + std::max(keep_s, 0.0);
  Course course{*this, from_s, source_s(from_s), rate(from_s), acceleration(from_s)};
  // An acceleration this small is rounding.
  if (std::abs(course.acceleration) < 1e-10) course.acceleration = 0.0;
  end_rate = std::clamp(end_rate, kMinWarpRate, kMaxWarpRate);
  while (!knots.empty() && knots.front().time_s <= from_s) knots = knots.subspan(1);
  std::size_t needed = kMaxPieces - kNewPieces;
  {
    const PhaseWarp old = *this;
    const std::size_t kept = keep_until(now_s, from_s);
    if (kept > needed) {
      *this = old;
      return false;
    }
    count_ = kept;
  }
  const WarpKnot start{course.time_s, course.source_s};
  const auto slope_at = [&](std::size_t k) {
    return k + 1 < knots.size()
               ? slope(k > 0 ? knots[k - 1] : start, knots[k], knots[k + 1])
               : end_rate;
  };
  bool met = true;
  std::size_t first = 0;
  while (first + 1 < knots.size() && !course.reaches(knots[first], slope_at(first))) {
    ++first;
    met = false;
  }
  for (std::size_t k = first; k < knots.size(); ++k) {
    // Ease, two ramps and the constant rate between them.
    const std::size_t room = kMaxPieces - count_;
    if (room < kNewPieces) {
      met = false;
      break;
    }
    const bool is_last = k + 1 == knots.size() || room < 2 * kNewPieces;
    met = follow(course, knots[k], is_last ? end_rate : slope_at(k)) && met;
    if (is_last) {
      met = met && k + 1 == knots.size();
      break;
    }
  }
  if (knots.empty()) {
    course.ease(kMaxEase_s);
    course.ramp(kEndRamp_s, end_rate);
  }
  end_s_ = course.time_s;
  end_source_s_ = course.source_s;
  end_rate_ = course.rate;
  return met;
}

bool PhaseWarp::follow(Course& course, const WarpKnot& knot, double slope_there) {
  if (course.single(knot, slope_there)) return true;
  course.ease(std::min(kMaxEase_s, (knot.time_s - course.time_s) / 3.0));
  const WarpKnot nearest{knot.time_s, course.nearest_source_s(knot, slope_there)};
  course.ramps(nearest, slope_there);
  return std::abs(nearest.source_s - knot.source_s) < 1e-12;
}

const PhaseWarp::Piece* PhaseWarp::piece_at(double time_s) const {
  if (count_ == 0 || time_s < pieces_[0].start_s || time_s >= end_s_) return nullptr;
  std::size_t i = count_ - 1;
  while (pieces_[i].start_s > time_s) --i;
  return &pieces_[i];
}

double PhaseWarp::source_s(double time_s) const {
  if (const Piece* piece = piece_at(time_s)) {
    const double x = (time_s - piece->start_s) / piece->length_s;
    const Coefficients& c = piece->c;
    return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  }
  if (count_ > 0 && time_s < pieces_[0].start_s) {
    const Piece& piece = pieces_[0];
    return piece.c[0] + piece.c[1] / piece.length_s * (time_s - piece.start_s);
  }
  return end_source_s_ + end_rate_ * (time_s - end_s_);
}

double PhaseWarp::rate(double time_s) const {
  if (const Piece* piece = piece_at(time_s)) {
    const double x = (time_s - piece->start_s) / piece->length_s;
    const Coefficients& c = piece->c;
    return (c[1] +
            x * (2.0 * c[2] + x * (3.0 * c[3] + x * (4.0 * c[4] + x * 5.0 * c[5])))) /
           piece->length_s;
  }
  if (count_ > 0 && time_s < pieces_[0].start_s) {
    return pieces_[0].c[1] / pieces_[0].length_s;
  }
  return end_rate_;
}

double PhaseWarp::acceleration(double time_s) const {
  const Piece* piece = piece_at(time_s);
  if (!piece) return 0.0;
  const double x = (time_s - piece->start_s) / piece->length_s;
  const Coefficients& c = piece->c;
  return (2.0 * c[2] + x * (6.0 * c[3] + x * (12.0 * c[4] + x * 20.0 * c[5]))) /
         (piece->length_s * piece->length_s);
}

double PhaseWarp::end_s() const {
  return end_s_;
}

}  // namespace marey::engine
