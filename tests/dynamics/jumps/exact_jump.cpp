// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/dynamics/jumps/exact_jump.h"

#include <cmath>
#include <cstddef>

#include "dynamics/push/thesis_push.h"

#include "core/base/assert.h"

namespace marey::dynamics::testing {
namespace {

constexpr double kFoot_m = 0.25;

/// Quintic without acceleration at both ends.
struct LevelWay {
  double from_m, from_m_s, to_m, to_m_s, duration_s;
  [[nodiscard]] double at(double t_s) const {
    const double x = t_s / duration_s;
    const double d = to_m - from_m;
    const double v0 = from_m_s * duration_s;
    const double v1 = to_m_s * duration_s;
    return from_m + v0 * x +
           x * x * x *
               ((10.0 * d - 6.0 * v0 - 4.0 * v1) +
                x * ((-15.0 * d + 8.0 * v0 + 7.0 * v1) +
                     x * (6.0 * d - 3.0 * v0 - 3.0 * v1)));
  }
};

ThesisPush vertical_way(const PushEnds& ends) {
  const auto space = search_space(ends, 48);
  MAREY_ASSERT(!space.empty());
  const SpaceColumn& column = space[space.size() / 2];
  const double lowest_m =
      0.5 * (column.heights.low.height_m + column.heights.high.height_m);
  return *thesis_push(ends, column.lowest_at, lowest_m);
}

void add_soles(const glm::dvec3& middle, double lift_m, BodyTrack& track) {
  for (int side = 0; side < 2; ++side) {
    const glm::dvec3 foot = middle + glm::dvec3(side == 0 ? 0.1 : -0.1, lift_m, 0.0);
    SoleTrack& sole = track.soles[static_cast<std::size_t>(side)];
    sole.heel_in_world.push_back(foot - glm::dvec3(0.0, 0.0, 0.5 * kFoot_m));
    sole.ball_in_world.push_back(foot + glm::dvec3(0.0, 0.0, 0.2 * kFoot_m));
    sole.tip_in_world.push_back(foot + glm::dvec3(0.0, 0.0, 0.5 * kFoot_m));
  }
}

}  // namespace

ExactJump make_exact_jump(const ExactJumpShape& shape) {
  const double g = shape.gravity_m_s2;
  const double flight_s =
      (shape.takeoff_m_s + std::sqrt(shape.takeoff_m_s * shape.takeoff_m_s +
                                     2.0 * g * (shape.takeoff_m - shape.touchdown_m))) /
      g;
  const double down_m_s = g * flight_s - shape.takeoff_m_s;
  const glm::dvec3 level = shape.level_m_s;
  const glm::dvec3 from = shape.from_in_world;
  const glm::dvec3 takeoff = from +
                             0.4 * shape.push_s * glm::dvec3(level.x, 0.0, level.z) +
                             glm::dvec3(0.0, shape.takeoff_m, 0.0);
  const glm::dvec3 touchdown = takeoff + flight_s * glm::dvec3(level.x, 0.0, level.z) +
                               glm::dvec3(0.0, shape.touchdown_m - shape.takeoff_m, 0.0);
  const glm::dvec3 rest = touchdown +
                          0.4 * shape.landing_s * glm::dvec3(level.x, 0.0, level.z) +
                          glm::dvec3(0.0, shape.stand_m - shape.touchdown_m, 0.0);
  const double floor_m = from.y;
  const ThesisPush push = vertical_way(
      {shape.stand_m, 0.0, shape.takeoff_m, shape.takeoff_m_s, shape.push_s, 0.0, -g, g});
  // A landing is a push backwards in time.
  const ThesisPush landing = vertical_way(
      {shape.stand_m, 0.0, shape.touchdown_m, down_m_s, shape.landing_s, 0.0, -g, g});
  ExactJump out;
  out.track.rate = FrameRate{shape.rate_hz};
  out.track.mass_kg = 70.0;
  const double start_s = shape.still_s;
  const double takeoff_s = start_s + shape.push_s;
  const double touchdown_s = takeoff_s + flight_s;
  const double rest_s = touchdown_s + shape.landing_s;
  const auto frames =
      static_cast<std::size_t>((rest_s + shape.still_s) * shape.rate_hz) + 1;
  for (std::size_t i = 0; i < frames; ++i) {
    const double t = static_cast<double>(i) / shape.rate_hz;
    glm::dvec3 p = t < start_s ? from + glm::dvec3(0.0, shape.stand_m, 0.0) : rest;
    glm::dvec3 feet = t < takeoff_s
                          ? from
                          : from + (rest - (from + glm::dvec3(0.0, shape.stand_m, 0.0)));
    double lift_m = 0.0;
    if (t >= start_s && t < takeoff_s) {
      for (const int axis : {0, 2}) {
        p[axis] = LevelWay{from[axis], 0.0, takeoff[axis], level[axis], shape.push_s}.at(
            t - start_s);
      }
      p.y = floor_m + push.height_m(t - start_s);
    } else if (t >= takeoff_s && t < touchdown_s) {
      const double u = t - takeoff_s;
      p = takeoff + u * glm::dvec3(level.x, shape.takeoff_m_s, level.z) -
          glm::dvec3(0.0, 0.5 * g * u * u, 0.0);
      const double share = u / flight_s;
      feet = from + share * (rest - from - glm::dvec3(0.0, rest.y - from.y, 0.0));
      // Feet rise and fall with the body, from the floor to the floor.
      lift_m = 4.0 * share * (1.0 - share) * 0.25;
    } else if (t >= touchdown_s && t < rest_s) {
      const double back_s = rest_s - t;
      for (const int axis : {0, 2}) {
        p[axis] =
            LevelWay{touchdown[axis], level[axis], rest[axis], 0.0, shape.landing_s}.at(
                t - touchdown_s);
      }
      p.y = floor_m + landing.height_m(back_s);
    }
    out.track.com_in_world.push_back(p);
    add_soles(feet, lift_m, out.track);
  }
  Jump& jump = out.jump;
  jump.start = {start_s, from + glm::dvec3(0.0, shape.stand_m, 0.0), glm::dvec3(0.0)};
  jump.lowest_s = start_s + push.lowest_at * shape.push_s;
  jump.lowest_m = floor_m + push.height_m(push.lowest_at * shape.push_s);
  jump.takeoff = {takeoff_s, takeoff, glm::dvec3(level.x, shape.takeoff_m_s, level.z)};
  jump.apex_s = takeoff_s + shape.takeoff_m_s / g;
  jump.apex_m = takeoff.y + 0.5 * shape.takeoff_m_s * shape.takeoff_m_s / g;
  jump.touchdown =
      ComState{touchdown_s, touchdown, glm::dvec3(level.x, -down_m_s, level.z)};
  jump.rest = ComState{rest_s, rest, glm::dvec3(0.0)};
  jump.takeoff_source = Source::kMeasured;
  jump.landing_source = Source::kMeasured;
  jump.takeoff_feet_in_world = from;
  jump.landing_feet_in_world =
      from + (rest - from - glm::dvec3(0.0, rest.y - from.y, 0.0));
  jump.fall_m_s2 = -g;
  jump.gravity_m_s2 = g;
  return out;
}

}  // namespace marey::dynamics::testing
