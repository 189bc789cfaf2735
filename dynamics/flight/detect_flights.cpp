// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/flight/detect_flights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/assert.h"
#include "core/base/quantile.h"

namespace marey::dynamics {
namespace {

// Limits of the acceleration as shares of free fall: every frame of a candidate, their
// median, its ends, and a gap between two runs of one flight.
constexpr double kFallingShare = 0.6;
constexpr double kMedianShare = 0.8;
constexpr double kEndShare = 0.75;
constexpr double kGapShare = 0.25;
constexpr double kMaxGap_s = 0.04;
// Soles of a flying body are this far above their floors, for a foot of kAdultFoot_m.
constexpr double kMinClearance_m = 0.020;
// The same where no foot confirms either end.
constexpr double kClearOfFloor_m = 0.04;

/// Frames of a candidate: [first, end).
struct FallingRun {
  std::size_t first = 0;
  std::size_t end = 0;
};

std::vector<FallingRun> falling_runs(const std::vector<double>& a,
                                     double fall_m_s2,
                                     double rate_hz) {
  std::vector<FallingRun> runs;
  const auto max_gap = static_cast<std::size_t>(std::floor(kMaxGap_s * rate_hz));
  for (std::size_t first = 0; first < a.size();) {
    if (a[first] >= -kFallingShare * fall_m_s2) {
      ++first;
      continue;
    }
    std::size_t end = first;
    while (end < a.size() && a[end] < -kFallingShare * fall_m_s2) ++end;
    bool is_joined = false;
    if (!runs.empty() && first - runs.back().end <= max_gap) {
      const auto from = a.begin() + static_cast<std::ptrdiff_t>(runs.back().end);
      const auto to = a.begin() + static_cast<std::ptrdiff_t>(first);
      is_joined = std::all_of(
          from, to, [&](double value) { return value < -kGapShare * fall_m_s2; });
    }
    if (is_joined) {
      runs.back().end = end;
    } else {
      runs.push_back({first, end});
    }
    first = end;
  }
  return runs;
}

// Place between frames `i` and `i + 1` at which the acceleration passes the level.
double passes(const std::vector<double>& a, std::size_t i, double level) {
  const double step = a[i + 1] - a[i];
  const double share = step == 0.0 ? 0.5 : (level - a[i]) / step;
  return static_cast<double>(i) + std::clamp(share, 0.0, 1.0);
}

// Ends of a run by the centre of mass alone.
FreeFlight by_com(const std::vector<double>& a,
                  const FallingRun& run,
                  double fall_m_s2,
                  double rate_hz) {
  FreeFlight flight;
  const double level = -kEndShare * fall_m_s2;
  std::size_t in = run.first;
  while (in + 1 < run.end && a[in] > level) ++in;
  std::size_t out = run.end - 1;
  while (out > in && a[out] > level) --out;
  const auto edge = [&](double frames) {
    return FlightEdge{frames / rate_hz, frames / rate_hz, false, {}};
  };
  if (run.first > 0 && in > 0) flight.takeoff = edge(passes(a, in - 1, level));
  if (run.end < a.size()) flight.landing = edge(passes(a, out, level));
  flight.last_s = static_cast<double>(a.size() - 1) / rate_hz;
  return flight;
}

void refine_edges(const BodyTrack& track, double scale, FreeFlight& flight) {
  const auto take = [](const std::optional<FootEdge>& by_feet, FlightEdge& edge) {
    if (!by_feet) return;
    edge.time_s = by_feet->time_s;
    edge.by_feet = true;
    edge.bears = by_feet->bears;
  };
  if (flight.takeoff) {
    take(foot_takeoff(track, scale, flight.takeoff->by_com_s, kEdgeTolerance_s),
         *flight.takeoff);
  }
  if (flight.landing) {
    take(foot_landing(track, scale, flight.landing->by_com_s, kEdgeTolerance_s),
         *flight.landing);
  }
  // Edges of the feet that leave no flight are those of another step.
  if (flight.takeoff && flight.landing &&
      flight.landing->time_s <= flight.takeoff->time_s) {
    for (FlightEdge* edge : {&*flight.takeoff, &*flight.landing}) {
      *edge = {edge->by_com_s, edge->by_com_s, false, {}};
    }
  }
  if (flight.takeoff) flight.first_s = flight.takeoff->time_s;
  if (flight.landing) flight.last_s = flight.landing->time_s;
}

// Largest height of the lowest sole point above the line from its height before the
// flight to that after it.
double clearance_m(const BodyTrack& track, const FallingRun& run) {
  const std::size_t last = track.com_in_world.size() - 1;
  const auto reach = static_cast<std::size_t>(std::ceil(0.1 * track.rate.hz));
  const std::size_t before = run.first > reach ? run.first - reach : 0;
  const std::size_t after = std::min(last, run.end + reach);
  double from_m = lowest_sole_m(track, run.first);
  for (std::size_t i = before; i < run.first; ++i) {
    from_m = std::min(from_m, lowest_sole_m(track, i));
  }
  double to_m = lowest_sole_m(track, std::min(last, run.end));
  for (std::size_t i = run.end; i <= after; ++i) {
    to_m = std::min(to_m, lowest_sole_m(track, i));
  }
  double clear_m = 0.0;
  for (std::size_t i = run.first; i < run.end; ++i) {
    const double share = static_cast<double>(i - run.first + 1) /
                         static_cast<double>(run.end - run.first + 1);
    const double floor_m = from_m + share * (to_m - from_m);
    clear_m = std::max(clear_m, lowest_sole_m(track, i) - floor_m);
  }
  return clear_m;
}

}  // namespace

std::vector<FreeFlight> detect_flights(const BodyTrack& track,
                                       const ComSlopes& slopes,
                                       const DetectFlightsOptions& options) {
  MAREY_ASSERT(track.rate.hz > 0.0);
  const std::vector<double>& a = slopes.up_m_s2;
  const double hz = track.rate.hz;
  const double scale = foot_scale(track);
  const bool has_soles = !track.soles[0].tip_in_world.empty();
  std::vector<FreeFlight> flights;
  if (a.size() < 4) return flights;
  for (const FallingRun& run : falling_runs(a, options.fall_m_s2, hz)) {
    const auto from = a.begin() + static_cast<std::ptrdiff_t>(run.first);
    const auto to = a.begin() + static_cast<std::ptrdiff_t>(run.end);
    if (median({from, to}) > -kMedianShare * options.fall_m_s2) continue;
    FreeFlight flight = by_com(a, run, options.fall_m_s2, hz);
    refine_edges(track, scale, flight);
    if (has_soles && flight.takeoff && flight.landing) {
      const bool is_confirmed = flight.takeoff->by_feet || flight.landing->by_feet;
      const double least_m = is_confirmed ? kMinClearance_m : kClearOfFloor_m;
      if (clearance_m(track, run) < least_m * scale) continue;
    }
    if (flight.last_s - flight.first_s < options.min_flight_s) continue;
    if (!flights.empty() && flight.first_s < flights.back().last_s) continue;
    flights.push_back(flight);
  }
  return flights;
}

}  // namespace marey::dynamics
