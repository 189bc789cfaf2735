// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/find_jumps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dynamics/flight/com_slopes.h"
#include "dynamics/flight/detect_flights.h"
#include "dynamics/flight/fit_flight.h"
#include "dynamics/flight/foot_edges.h"

#include "core/base/assert.h"
#include "core/base/format_text.h"

namespace marey::dynamics {
namespace {

// A push follows a touch-down if it ends this soon after it.
constexpr double kMaxSupport_s = 1.0;
// The lowest point of a push is this near its end.
constexpr double kMaxRise_s = 1.5;
// A body that stands moves less than this.
constexpr double kStanding_m_s = 0.08;
constexpr double kStanding_g = 0.1;
constexpr double kStanding_s = 0.05;
// A body that has landed moves less than this.
constexpr double kRest_m_s = 0.1;
constexpr double kRest_s = 0.1;
// Difference from free fall that a user should know, and the deviation of a flight's
// middle from the parabola (for an adult) below which none can be measured.
constexpr double kMaxFallError_m_s2 = 1.0;
constexpr double kMinSag_m = 0.005;
// Below this rate the rules of the feet cannot refine an edge.
constexpr double kMinRate_hz = 50.0;
// Stances of which the places of the feet are taken.
constexpr double kTakeoffStance_s = 0.15;
constexpr double kLandingStance_s = 0.2;

using Slopes = ComSlopes;

/// Everything that the steps below share.
struct Search {
  const BodyTrack& track;
  const FindJumpsOptions& options;
  double fall_m_s2 = 0.0;  // Expected, positive.
  double scale = 1.0;      // Scale of the feet.
  Slopes slopes;

  [[nodiscard]] double hz() const { return track.rate.hz; }
  [[nodiscard]] int last_frame() const {
    return static_cast<int>(track.com_in_world.size()) - 1;
  }
  [[nodiscard]] int frame_at(double time_s) const {
    return std::clamp(static_cast<int>(std::lround(time_s * hz())), 0, last_frame());
  }
  [[nodiscard]] double height_m(int frame) const {
    return track.com_in_world[static_cast<std::size_t>(frame)].y;
  }
  [[nodiscard]] ComState state_of(int frame) const {
    const auto i = static_cast<std::size_t>(frame);
    return {frame / hz(), track.com_in_world[i], slopes.velocity_m_s[i]};
  }
  // State between frames: both neighbours interpolated.
  [[nodiscard]] ComState state_at(double time_s) const {
    const double at = std::clamp(time_s * hz(), 0.0, static_cast<double>(last_frame()));
    const int i = std::min(static_cast<int>(at), std::max(0, last_frame() - 1));
    const ComState a = state_of(i);
    const ComState b = state_of(std::min(i + 1, last_frame()));
    const double share = at - i;
    return {time_s,
            (1.0 - share) * a.p_in_world + share * b.p_in_world,
            (1.0 - share) * a.velocity_m_s + share * b.velocity_m_s};
  }
};

/// A flight with its parabola.
struct FittedFlight {
  FreeFlight flight;
  FlightFit fit;
  double free_fall_m_s2 = 0.0;  // Upwards; 0: too few frames.
};

std::optional<FittedFlight> fit_one(const Search& search, const FreeFlight& flight) {
  const auto& com = search.track.com_in_world;
  const FlightTimes times{flight.first_s, flight.last_s};
  FittedFlight out{flight, {}, 0.0};
  double gravity_m_s2 = search.fall_m_s2;
  if (const auto fall = fit_fall_m_s2(com, search.track.rate, times)) {
    out.free_fall_m_s2 = *fall;
    const double error = std::abs(*fall + search.fall_m_s2);
    const double flight_s = times.landing_s - times.takeoff_s;
    const double relative = search.fall_m_s2 / kStandardGravity_m_s2;
    const double limit = std::max(kMaxFallError_m_s2 * relative,
                                  8.0 * kMinSag_m * search.scale / (flight_s * flight_s));
    if (error > limit && *fall < 0.0) gravity_m_s2 = -*fall;
  }
  const auto fit = fit_flight(com, search.track.rate, times, gravity_m_s2);
  if (!fit) return std::nullopt;
  out.fit = *fit;
  return out;
}

ComState state_of_fit(const FlightFit& fit, double time_s) {
  return {time_s, fit.position_at(time_s), fit.velocity_at(time_s)};
}

int lowest_frame(const Search& search, double from_s, double to_s) {
  const int first = std::clamp(
      static_cast<int>(std::ceil(from_s * search.hz())), 0, search.last_frame());
  const int last = std::max(
      first,
      std::min(search.last_frame(), static_cast<int>(std::floor(to_s * search.hz()))));
  int at = first;
  for (int i = first; i <= last; ++i) {
    if (search.height_m(i) < search.height_m(at)) at = i;
  }
  return at;
}

// Last frame before `end` of a time in which the body stands: slow in every frame, and
// without acceleration in the mean, since single accelerations are noisy.
std::optional<int> end_of_standing(const Search& search, int end) {
  const int count =
      std::max(2, static_cast<int>(std::lround(kStanding_s * search.hz())) + 1);
  const double relative = search.fall_m_s2 / kStandardGravity_m_s2;
  int slow = 0;
  double acceleration_sum = 0.0;
  for (int frame = end - 1; frame >= 0; --frame) {
    const auto i = static_cast<std::size_t>(frame);
    const bool is_slow = std::abs(search.slopes.up_m_s[i]) < kStanding_m_s * relative;
    slow = is_slow ? slow + 1 : 0;
    acceleration_sum += search.slopes.up_m_s2[i];
    const int after = frame + count;
    if (after < end) {
      acceleration_sum -= search.slopes.up_m_s2[static_cast<std::size_t>(after)];
    }
    if (slow >= count &&
        std::abs(acceleration_sum) < kStanding_g * search.fall_m_s2 * count) {
      return after - 1;
    }
  }
  return std::nullopt;
}

// Last frame before `end` that is at least as high as its neighbours.
std::optional<int> last_highest(const Search& search, int end) {
  for (int frame = end - 1; frame > 0; --frame) {
    const auto i = static_cast<std::size_t>(frame);
    const auto& h = search.slopes.height_m;
    if (h[i] >= h[i - 1] && h[i] > h[i + 1]) return frame;
  }
  return std::nullopt;
}

// Sets P1 and P2.
void find_push(const Search& search, const FittedFlight* before, Jump& jump) {
  const double takeoff_s = jump.takeoff.time_s;
  const double from_s =
      before != nullptr && before->flight.landing ? before->flight.landing->time_s : 0.0;
  const bool is_rebound = before != nullptr && takeoff_s - from_s < kMaxSupport_s;
  const bool is_given = search.options.start_s && *search.options.start_s >= from_s &&
                        *search.options.start_s < takeoff_s;
  const double search_s = is_given     ? *search.options.start_s
                          : is_rebound ? from_s
                                       : std::max(from_s, takeoff_s - kMaxRise_s);
  const int lowest = lowest_frame(search, search_s, takeoff_s);
  jump.lowest_s = lowest / search.hz();
  jump.lowest_m = search.height_m(lowest);
  if (is_given) {
    jump.start_kind = PushStart::kGiven;
    jump.start = search.state_at(*search.options.start_s);
  } else if (is_rebound) {
    jump.start_kind = PushStart::kTouchdown;
    jump.start = state_of_fit(before->fit, from_s);
  } else {
    const int first = static_cast<int>(std::ceil(from_s * search.hz()));
    const auto standing = end_of_standing(search, lowest);
    const auto highest = last_highest(search, lowest);
    if (standing && *standing >= first) {
      jump.start_kind = PushStart::kStanding;
      jump.start = search.state_of(*standing);
    } else if (highest && *highest >= first) {
      jump.start_kind = PushStart::kMoving;
      jump.start = search.state_of(*highest);
    } else if (before != nullptr) {
      jump.start_kind = PushStart::kTouchdown;
      jump.start = state_of_fit(before->fit, from_s);
    } else {
      jump.start_kind = PushStart::kClipStart;
      jump.start = search.state_of(0);
      jump.findings.push_back(
          fair_finding("clip-start",
                       "",
                       "the clip begins during the push, which is therefore incomplete",
                       "give the start of the push, or use a longer clip"));
    }
  }
  if (jump.lowest_s < jump.start.time_s) {
    jump.lowest_s = jump.start.time_s;
    jump.lowest_m = jump.start.p_in_world.y;
  }
}

// Sets P5: the first frame of a time at rest.
void find_rest(const Search& search, const Jump* next, Jump& jump) {
  if (!jump.touchdown) return;
  const int needed = std::max(1, static_cast<int>(std::lround(kRest_s * search.hz())));
  const double relative = search.fall_m_s2 / kStandardGravity_m_s2;
  const double end_s =
      next != nullptr ? next->takeoff.time_s : search.last_frame() / search.hz();
  const int last = static_cast<int>(std::floor(end_s * search.hz()));
  int run = 0;
  for (int frame = static_cast<int>(std::ceil(jump.touchdown->time_s * search.hz()));
       frame <= last;
       ++frame) {
    const double speed = search.slopes.up_m_s[static_cast<std::size_t>(frame)];
    run = std::abs(speed) < kRest_m_s * relative ? run + 1 : 0;
    if (run > needed) {
      jump.rest = search.state_of(frame - needed);
      return;
    }
  }
  if (next == nullptr) return;
  jump.rest = next->takeoff;
  jump.rest_is_takeoff = true;
}

void find_feet(const Search& search, const FreeFlight& flight, Jump& jump) {
  const BodyTrack& track = search.track;
  const double takeoff_s = jump.takeoff.time_s;
  if (track.soles[0].tip_in_world.empty()) {
    const glm::dvec3& p = jump.takeoff.p_in_world;
    jump.takeoff_feet_in_world = {p.x, 0.0, p.z};
    if (jump.touchdown) {
      const glm::dvec3& q = jump.touchdown->p_in_world;
      jump.landing_feet_in_world = glm::dvec3(q.x, 0.0, q.z);
    }
    return;
  }
  const double from_s = std::clamp(
      takeoff_s - kTakeoffStance_s, std::min(jump.start.time_s, takeoff_s), takeoff_s);
  jump.takeoff_feet_in_world =
      standing_place(track, flight.takeoff->bears, from_s, takeoff_s);
  if (!jump.touchdown) return;
  const double landing_s = jump.touchdown->time_s;
  jump.landing_feet_in_world = standing_place(
      track, flight.landing->bears, landing_s, landing_s + kLandingStance_s);
}

void say_edges(const FreeFlight& flight, bool has_soles, Jump& jump) {
  const auto say = [&](const char* what, const FlightEdge& edge) {
    const std::string cause =
        has_soles
            ? format_text(
                  "%s at %.3f s is that of the centre of mass: no foot %s the floor "
                  "within %.0f ms of it",
                  what,
                  edge.time_s,
                  edge.time_s == jump.takeoff.time_s ? "leaves" : "meets",
                  1e3 * kEdgeTolerance_s)
            : format_text(
                  "%s at %.3f s is that of the centre of mass: the feet are "
                  "unknown",
                  what,
                  edge.time_s);
    jump.findings.push_back(
        fair_finding("inferred", "", cause, "check the time against the video"));
  };
  if (!flight.takeoff->by_feet) say("take-off", *flight.takeoff);
  if (flight.landing && !flight.landing->by_feet) say("landing", *flight.landing);
}

void say_fall(const Search& search, Jump& jump) {
  if (std::abs(jump.gravity_m_s2 - search.fall_m_s2) < 1e-12) return;
  std::string parts;
  if (jump.fall_rising_m_s2 != 0.0 && jump.fall_falling_m_s2 != 0.0) {
    parts = format_text(
        " (rising %.1f, falling %.1f)", jump.fall_rising_m_s2, jump.fall_falling_m_s2);
  }
  Finding finding =
      fair_finding("gravity",
                   "",
                   format_text("falls at %.1f m/s^2%s, a body falls at -%.2f",
                               jump.fall_m_s2,
                               parts.c_str(),
                               search.fall_m_s2),
                   "check the capture's rate and scale, or use ballistic");
  jump.findings.push_back(finding.measured(jump.fall_m_s2, -search.fall_m_s2, "m/s^2"));
}

// Everything of a jump but push and rest.
Jump flight_of(const Search& search, const FittedFlight& one) {
  const FreeFlight& flight = one.flight;
  Jump jump;
  jump.takeoff = state_of_fit(one.fit, flight.first_s);
  jump.gravity_m_s2 = one.fit.gravity_m_s2;
  jump.flight_rms_m = one.fit.rms_m;
  jump.apex_s =
      std::clamp(flight.first_s + jump.takeoff.velocity_m_s.y / one.fit.gravity_m_s2,
                 flight.first_s,
                 flight.last_s);
  jump.apex_m = one.fit.position_at(jump.apex_s).y;
  jump.fall_m_s2 = one.free_fall_m_s2;
  const auto part = [&](double from_s, double to_s) {
    return fit_fall_m_s2(search.track.com_in_world, search.track.rate, {from_s, to_s})
        .value_or(0.0);
  };
  jump.fall_rising_m_s2 = part(flight.first_s, jump.apex_s);
  jump.fall_falling_m_s2 = part(jump.apex_s, flight.last_s);
  jump.takeoff_source = flight.takeoff->by_feet ? Source::kMeasured : Source::kInferred;
  if (flight.landing) {
    jump.touchdown = state_of_fit(one.fit, flight.last_s);
    if (flight.landing->by_feet) jump.landing_source = Source::kMeasured;
  } else {
    jump.findings.push_back(
        fair_finding("cut",
                     "",
                     "the clip ends in flight: only the take-off can be used",
                     "use a longer clip"));
  }
  say_fall(search, jump);
  say_edges(flight, !search.track.soles[0].tip_in_world.empty(), jump);
  if (search.hz() < kMinRate_hz) {
    jump.findings.push_back(fair_finding(
        "rate",
        "",
        format_text("at %.0f frames a second, times are uncertain by a frame (%.0f ms)",
                    search.hz(),
                    1e3 / search.hz()),
        "capture at 100 Hz or more"));
  }
  return jump;
}

bool is_finite(const std::vector<glm::dvec3>& points) {
  return std::all_of(points.begin(), points.end(), [](const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });
}

void assert_valid(const BodyTrack& track, const FindJumpsOptions& options) {
  MAREY_ASSERT(track.rate.hz > 0.0);
  MAREY_ASSERT(options.gravity_m_s2 > 0.0);
  MAREY_ASSERT(!options.expected_fall_m_s2 || *options.expected_fall_m_s2 > 0.0);
  MAREY_ASSERT(is_finite(track.com_in_world));
  for (const SoleTrack& sole : track.soles) {
    for (const auto* points :
         {&sole.heel_in_world, &sole.ball_in_world, &sole.tip_in_world}) {
      MAREY_ASSERT(points->size() == track.soles[0].heel_in_world.size());
      MAREY_ASSERT(points->empty() || points->size() == track.com_in_world.size());
      MAREY_ASSERT(is_finite(*points));
    }
  }
}

}  // namespace

std::vector<Jump> find_jumps(const BodyTrack& track, const FindJumpsOptions& options) {
  assert_valid(track, options);
  Search search{track, options, 0.0, 1.0, {}};
  search.fall_m_s2 = options.expected_fall_m_s2.value_or(options.gravity_m_s2);
  search.scale = foot_scale(track);
  search.slopes = com_slopes(track.com_in_world, track.rate);
  std::vector<FittedFlight> flights;
  for (const FreeFlight& flight :
       detect_flights(track, search.slopes, {search.fall_m_s2, options.min_flight_s})) {
    if (auto fitted = fit_one(search, flight)) flights.push_back(*std::move(fitted));
  }
  std::vector<Jump> jumps;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    if (!flights[i].flight.takeoff) continue;
    Jump jump = flight_of(search, flights[i]);
    find_push(search, i > 0 ? &flights[i - 1] : nullptr, jump);
    find_feet(search, flights[i].flight, jump);
    jumps.push_back(std::move(jump));
  }
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    find_rest(search, i + 1 < jumps.size() ? &jumps[i + 1] : nullptr, jumps[i]);
  }
  return jumps;
}

}  // namespace marey::dynamics
