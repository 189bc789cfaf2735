// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/floor_ride.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/transform.h"

namespace marey::engine {
namespace {

constexpr double kFollow_s = 0.1;       // Time constant of a foot that does not stand.
constexpr double kMaxTurn_rad = 0.593;  // 34 degrees, as on the floors of motions.

glm::dvec3 displacement_of(const Floor& floor, FloorPartIndex part, double time_s) {
  return part ? retarget::moved_at(floor.parts[*part], time_s) : glm::dvec3(0.0);
}

glm::dquat turn_to(const glm::dvec3& normal_in_world) {
  const glm::dvec3 turn_rad =
      rotation_vector(rotation_between({0.0, 1.0, 0.0}, normal_in_world));
  const double angle_rad = glm::length(turn_rad);
  if (angle_rad <= kMaxTurn_rad) return rotation_from_vector(turn_rad);
  return rotation_from_vector(turn_rad * (kMaxTurn_rad / angle_rad));
}

}  // namespace

std::array<FloorShift, 2> FloorRide::step(const Floor& floor,
                                          double time_s,
                                          double step_s,
                                          const std::array<Foot, 2>& feet) {
  const double share = 1.0 - std::exp(-step_s / kFollow_s);
  std::array<FloorShift, 2> out{};
  for (std::size_t side = 0; side < 2; ++side) {
    const Foot& foot = feet[side];
    Ride& ride = rides_[side];
    const auto xz = [&] {
      return glm::dvec2(foot.ankle_in_level.x + ride.carried_m.x,
                        foot.ankle_in_level.z + ride.carried_m.z);
    };
    if (!foot.stands || !ride.stood || !is_known_) {
      const retarget::FloorSpot here = retarget::floor_at(floor, xz(), time_s);
      ride.rest_m = is_known_ ? ride.spot.height_m + ride.rest_m - here.height_m : 0.0;
      ride.part = here.part;
      ride.part_moved_m = displacement_of(floor, ride.part, time_s);
    }
    if (foot.stands) {
      const glm::dvec3 now = displacement_of(floor, ride.part, time_s);
      ride.carried_m += now - ride.part_moved_m;
      ride.part_moved_m = now;
    } else {
      ride.carried_m += share * (rides_[1 - side].carried_m - ride.carried_m);
    }
    ride.stood = foot.stands;
    ride.spot = retarget::plane_at(floor, ride.part, xz(), time_s);
    ride.rest_m -= share * ride.rest_m;
    out[side].turn = turn_to(ride.spot.normal_in_world);
    const glm::dvec3 lean = ride.spot.normal_in_world - glm::dvec3(0.0, 1.0, 0.0);
    out[side].moved_m =
        glm::dvec3(ride.carried_m.x, ride.spot.height_m + ride.rest_m, ride.carried_m.z) +
        foot.ankle_height_m * lean;
    out[side].carried_m = ride.carried_m;
  }
  is_known_ = true;
  return out;
}

}  // namespace marey::engine
