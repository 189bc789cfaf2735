// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/made_jump.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {
namespace {

constexpr double kAdult_m = 1.75;
constexpr double kStandingCom_m = 1.0;
constexpr double kTiptoeCom_m = 1.09;
constexpr double kLandingCom_m = 1.04;
constexpr double kHeelRise_m = 0.09;
constexpr double kHeelRise_s = 0.12;
constexpr double kFlatten_s = 0.06;

constexpr double kDownShare = 0.35;  // Share of gravity at the start of a countermovement.
constexpr double kLeavingRamp_s = 0.04;
constexpr double kMeetingRamp_s = 0.03;

/// Motion along one axis with an acceleration that is linear in time.
struct Piece {
  double from_s = 0.0, p = 0.0, v = 0.0, a = 0.0, jerk = 0.0;

  [[nodiscard]] double position(double time_s) const {
    const double t = time_s - from_s;
    return p + t * (v + t * (a / 2.0 + t * jerk / 6.0));
  }
  [[nodiscard]] double speed(double time_s) const {
    const double t = time_s - from_s;
    return v + t * (a + t * jerk / 2.0);
  }
};

/// Pieces one after another, without a jump of position or speed.
class Course {
 public:
  void begin(double p) { pieces_ = {{0.0, p, 0.0, 0.0, 0.0}}; }
  /// Ends the last piece at a time, and continues with this acceleration.
  void continue_with(double from_s, double a, double jerk = 0.0) {
    const Piece& last = pieces_.back();
    pieces_.push_back({from_s, last.position(from_s), last.speed(from_s), a, jerk});
  }
  [[nodiscard]] double at(double time_s) const {
    return piece_at(time_s).position(time_s);
  }
  [[nodiscard]] double speed(double time_s) const {
    return piece_at(time_s).speed(time_s);
  }

 private:
  [[nodiscard]] const Piece& piece_at(double time_s) const {
    const Piece* last = &pieces_.front();
    for (const Piece& one : pieces_) {
      if (time_s >= one.from_s) last = &one;
    }
    return *last;
  }

  std::vector<Piece> pieces_;
};

/// A constant acceleration, and the time for which it lasts.
struct Effort {
  double m_s2 = 0.0;
  double duration_s = 0.0;
};

/// From rest, then a ramp to free fall: the effort that reaches a speed over a height.
Effort push_effort(double height_m, double speed_m_s, double g, double ramp_s) {
  double low = 0.1 * g;
  double high = 100.0 * g;
  Effort out;
  for (int i = 0; i < 200; ++i) {
    out.m_s2 = 0.5 * (low + high);
    const double a = out.m_s2;
    out.duration_s = (speed_m_s - 0.5 * (a - g) * ramp_s) / a;
    const double t = out.duration_s;
    const double reached_m =
        0.5 * a * t * t + a * t * ramp_s + ramp_s * ramp_s * (0.5 * a - (a + g) / 6.0);
    (t > 0.0 && reached_m > height_m ? low : high) = a;
  }
  return out;
}

/// A ramp from free fall, then an effort that stops a fall of this speed over a depth.
Effort landing_effort(double depth_m, double speed_m_s, double g, double ramp_s) {
  double low = 0.1 * g;
  double high = 200.0 * g;
  Effort out;
  for (int i = 0; i < 200; ++i) {
    out.m_s2 = 0.5 * (low + high);
    const double a = out.m_s2;
    const double left_m_s = speed_m_s - 0.5 * (a - g) * ramp_s;
    out.duration_s = left_m_s / a;
    const double fallen_m = speed_m_s * ramp_s -
                            ramp_s * ramp_s * ((a + g) / 6.0 - 0.5 * g) +
                            0.5 * left_m_s * out.duration_s;
    (left_m_s > 0.0 && fallen_m > depth_m ? low : high) = a;
  }
  return out;
}

double smooth(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Builds the truth and the curves, then samples them.
class JumpMaker {
 public:
  JumpMaker(const std::vector<MadeFlight>& flights, const MadeJumpOptions& options)
      : flights_(flights),
        options_(options),
        size_(options.stature_m / kAdult_m),
        slow_(std::sqrt(size_ * 9.81 / options.gravity_m_s2)),
        fast_(size_ / slow_) {}

  MadeJump make() {
    plan();
    sample();
    return out_;
  }

 private:
  // Continues downwards to a lowest height, and returns its time.
  double squat(double now_s, double lowest_m, double push_m_s2) {
    const double g = options_.gravity_m_s2;
    const double depth_m = up_.at(now_s) - lowest_m;
    const double speed_m_s = -up_.speed(now_s);
    if (speed_m_s < 1e-9) {
      const double b = kDownShare * g;
      const double down_s = std::sqrt(2.0 * depth_m / (b * (1.0 + b / push_m_s2)));
      up_.continue_with(now_s, -b);
      up_.continue_with(now_s + down_s, push_m_s2);
      return now_s + down_s * (1.0 + b / push_m_s2);
    }
    const double ramp_s = kMeetingRamp_s * slow_;
    const Effort effort = landing_effort(depth_m, speed_m_s, g, ramp_s);
    up_.continue_with(now_s, -g, (effort.m_s2 + g) / ramp_s);
    up_.continue_with(now_s + ramp_s, effort.m_s2);
    return now_s + ramp_s + effort.duration_s;
  }

  // Continues with one push and one flight, and returns the time of its landing.
  double fly(double now_s, const MadeFlight& flight, double floor_m) {
    const double g = options_.gravity_m_s2;
    const double ramp_s = kLeavingRamp_s * slow_;
    MadeFlightTruth truth;
    truth.floor_m = floor_m;
    truth.lowest_m = floor_m + (kStandingCom_m - flight.squat_m) * size_;
    const double rise_m = (kTiptoeCom_m - kStandingCom_m + flight.squat_m) * size_;
    const Effort effort = push_effort(rise_m, flight.up_m_s * fast_, g, ramp_s);
    truth.lowest_s = squat(now_s, truth.lowest_m, effort.m_s2);
    const double ramp_from_s = truth.lowest_s + effort.duration_s;
    truth.takeoff_s = ramp_from_s + ramp_s;
    up_.continue_with(truth.lowest_s, effort.m_s2);
    up_.continue_with(ramp_from_s, effort.m_s2, -(effort.m_s2 + g) / ramp_s);
    up_.continue_with(truth.takeoff_s, -g);
    const double push_s = truth.takeoff_s - now_s;
    const double ahead_m_s = flight.ahead_m_s * fast_;
    ahead_.continue_with(now_s, (ahead_m_s - ahead_.speed(now_s)) / push_s);
    ahead_.continue_with(truth.takeoff_s, 0.0);
    const auto position = [&](double t) {
      return glm::dvec3(0.0, up_.at(t), ahead_.at(t));
    };
    const auto velocity = [&](double t) {
      return glm::dvec3(0.0, up_.speed(t), ahead_.speed(t));
    };
    truth.takeoff_in_world = position(truth.takeoff_s);
    truth.takeoff_m_s = velocity(truth.takeoff_s);
    truth.landing_floor_m = floor_m + flight.box_m * size_;
    const double fall_m =
        truth.takeoff_in_world.y - truth.landing_floor_m - kLandingCom_m * size_;
    const double v = truth.takeoff_m_s.y;
    truth.landing_s = truth.takeoff_s + (v + std::sqrt(v * v + 2.0 * g * fall_m)) / g;
    truth.landing_in_world = position(truth.landing_s);
    truth.landing_m_s = velocity(truth.landing_s);
    truth.apex_m = truth.takeoff_in_world.y + 0.5 * v * v / g;
    out_.flights.push_back(truth);
    return truth.landing_s;
  }

  void plan() {
    double now_s = options_.standing_s * slow_;
    double floor_m = options_.first_floor_m;
    out_.start_s = now_s;
    up_.begin(floor_m + kStandingCom_m * size_);
    ahead_.begin(0.0);
    for (const MadeFlight& flight : flights_) {
      now_s = fly(now_s, flight, floor_m);
      floor_m = out_.flights.back().landing_floor_m;
    }
    // The body rises to standing: half of the way faster, half of it slower.
    const double low_s = squat(now_s, floor_m + (kStandingCom_m - 0.2) * size_, 0.0);
    const double half_s = 0.3 * slow_;
    const double a = 0.2 * size_ / (half_s * half_s);
    up_.continue_with(low_s, a);
    up_.continue_with(low_s + half_s, -a);
    out_.rest_s = low_s + 2.0 * half_s;
    up_.continue_with(out_.rest_s, 0.0);
    ahead_.continue_with(now_s, -ahead_.speed(now_s) / (out_.rest_s - now_s));
    ahead_.continue_with(out_.rest_s, 0.0);
  }

  // Height of the tip, and of the heel above it.
  struct Foot {
    double tip_m = 0.0, heel_m = 0.0, z = 0.0;
  };

  [[nodiscard]] Foot foot_at(double time_s) const {
    const double heel_m = kHeelRise_m * size_;
    Foot foot{options_.first_floor_m, 0.0, 0.0};
    for (std::size_t i = 0; i < out_.flights.size(); ++i) {
      const MadeFlightTruth& one = out_.flights[i];
      const double from_z = one.takeoff_in_world.z;
      if (time_s < one.takeoff_s) {
        if (i == 0) foot.z = from_z;
        const double rise =
            smooth((time_s - one.takeoff_s) / (kHeelRise_s * slow_) + 1.0);
        foot.heel_m = std::max(foot.heel_m, heel_m * rise);
        foot.z = from_z;
        return foot;
      }
      if (time_s < one.landing_s) {
        const double share = (time_s - one.takeoff_s) / (one.landing_s - one.takeoff_s);
        const double leg =
            (one.takeoff_in_world.y - one.floor_m) * (1.0 - smooth(share)) +
            (one.landing_in_world.y - one.landing_floor_m) * smooth(share);
        const double tuck = 0.1 * size_ * std::pow(std::sin(3.14159265358979 * share), 2);
        foot.tip_m = up_.at(time_s) - leg + tuck;
        foot.heel_m = heel_m;
        foot.z = from_z + share * (one.landing_in_world.z - from_z);
        return foot;
      }
      foot.tip_m = one.landing_floor_m;
      foot.z = one.landing_in_world.z;
      foot.heel_m =
          heel_m * (1.0 - smooth((time_s - one.landing_s) / (kFlatten_s * slow_)));
    }
    return foot;
  }

  void sample() {
    out_.track.rate = FrameRate{options_.rate_hz};
    out_.track.mass_kg = 70.0;
    Dice dice(options_.seed);
    const auto disturbed = [&](const glm::dvec3& p) {
      const double s = options_.noise_m;
      return s > 0.0 ? p + glm::dvec3(dice.noise(s), dice.noise(s), dice.noise(s)) : p;
    };
    const double end_s = out_.rest_s + options_.standing_s * slow_;
    const int frames = static_cast<int>(std::floor(end_s * options_.rate_hz)) + 1;
    for (int k = 0; k < frames; ++k) {
      const double t = k / options_.rate_hz;
      out_.track.com_in_world.push_back(disturbed({0.0, up_.at(t), ahead_.at(t)}));
      const Foot foot = foot_at(t);
      const auto add = [&](std::vector<glm::dvec3>& points, const glm::dvec3& p) {
        points.push_back(disturbed(turned_in_flight(t, p)));
      };
      for (std::size_t side = 0; side < 2; ++side) {
        const bool hangs = options_.one_footed && side == 1;
        const double x = (side == 0 ? 0.1 : -0.1) * size_;
        const double y = foot.tip_m + (hangs ? 0.3 * size_ : 0.0);
        const double z = foot.z - (hangs ? 0.3 * size_ : 0.0);
        SoleTrack& sole = out_.track.soles[side];
        add(sole.tip_in_world, {x, y, z + 0.13 * size_});
        add(sole.ball_in_world, {x, y + 0.3 * foot.heel_m, z + 0.05 * size_});
        add(sole.heel_in_world, {x, y + foot.heel_m, z - 0.13 * size_});
      }
    }
  }

  [[nodiscard]] glm::dvec3 turned_in_flight(double time_s, const glm::dvec3& p) const {
    if (!options_.somersault) return p;
    for (const MadeFlightTruth& one : out_.flights) {
      if (time_s < one.takeoff_s || time_s > one.landing_s) continue;
      const double share = (time_s - one.takeoff_s) / (one.landing_s - one.takeoff_s);
      const double angle = 2.0 * 3.14159265358979 * smooth(share);
      const double y = p.y - up_.at(time_s);
      const double z = p.z - ahead_.at(time_s);
      return {p.x,
              up_.at(time_s) + y * std::cos(angle) - z * std::sin(angle),
              ahead_.at(time_s) + y * std::sin(angle) + z * std::cos(angle)};
    }
    return p;
  }

  const std::vector<MadeFlight>& flights_;
  MadeJumpOptions options_;
  double size_, slow_, fast_;
  Course up_, ahead_;
  MadeJump out_;
};

}  // namespace

MadeJump made_jump(const std::vector<MadeFlight>& flights,
                   const MadeJumpOptions& options) {
  return JumpMaker(flights, options).make();
}

std::vector<MadeFlight> random_flights(std::uint64_t seed) {
  Dice dice(seed);
  const auto one = [&](double box_m) {
    MadeFlight flight;
    flight.up_m_s = dice.between(1.5, 3.0);
    flight.ahead_m_s = dice.between(-0.5, 2.0);
    flight.squat_m = dice.between(0.15, 0.35);
    flight.box_m = box_m;
    return flight;
  };
  const double kind = dice.between(0.0, 3.0);
  std::vector<MadeFlight> flights;
  if (kind < 1.0) {
    flights.push_back(one(dice.between(-0.3, 0.1)));
  } else if (kind < 2.0) {
    flights.push_back(one(-0.4));
    flights.front().up_m_s = dice.between(0.9, 1.5);
    flights.push_back(one(0.0));
  } else {
    const int hops = static_cast<int>(dice.between(2.0, 4.99));
    for (int i = 0; i < hops; ++i) flights.push_back(one(0.0));
  }
  return flights;
}

}  // namespace marey::testing
