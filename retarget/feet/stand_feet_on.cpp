// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/stand_feet_on.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/transform.h"
#include "core/base/smooth_step.h"
#include "retarget/feet/floor_at.h"

namespace marey::retarget {
namespace {

constexpr glm::dquat kLevel(1.0, 0.0, 0.0, 0.0);

glm::dvec2 xz_of(const glm::dvec3& p) {
  return {p.x, p.z};
}

// Displacement of one stance from the level floor to its part.
struct Carry {
  FloorStance stance;
  glm::dvec3 pivot{0.0};  // On the level floor, under the deciding point.
  glm::dvec3 shift_m{0.0};
  glm::dquat turn = kLevel;
  glm::dvec3 moved_before_m{0.0};  // By its part, when the stance began.
};

struct FloorFeetTask {
  const Floor& floor;
  const std::array<std::vector<FootPlace>, 2>& flat;
  const Contacts& contacts;
  const BodyMap& map;
  FrameRate rate;
  int first_frame = 0;
  const StandFeetOptions& options;

  [[nodiscard]] std::size_t count() const { return flat[0].size(); }
  [[nodiscard]] double time_s(int frame) const {
    return (first_frame + static_cast<double>(frame)) / rate.hz;
  }
  [[nodiscard]] glm::dvec3 moved(FloorPartIndex part, int frame) const {
    return part ? moved_at(floor.parts[*part], time_s(frame)) : glm::dvec3(0.0);
  }
};

bool holds(const FrameRange& run, int frame) {
  return run.first <= frame && frame <= run.last;
}

// Returns the point of a stance that decides on which part it stands.
glm::dvec3 pivot_of(const FloorFeetTask& task,
                    std::size_t side,
                    const FrameRange& stance) {
  const auto& flat = task.flat[side];
  glm::dvec3 p(0.0);
  bool found = false;
  for (const FrameRange& run : task.contacts.feet[side].heel) {
    const int t = std::max(run.first, stance.first);
    if (found || t > std::min(run.last, stance.last)) continue;
    p = flat[static_cast<std::size_t>(t)].ankle_in_world;
    found = true;
  }
  if (!found) {
    const FootPlace& place = flat[static_cast<std::size_t>(stance.first)];
    p = place.ankle_in_world + place.foot * task.map.feet[side].ball_from_ankle_in_t_pose;
  }
  return {p.x, 0.0, p.z};
}

glm::dquat turn_to(const glm::dvec3& normal, double max_rad) {
  if (normal == glm::dvec3(0, 1, 0)) return kLevel;
  const glm::dvec3 turn = rotation_vector(rotation_between(glm::dvec3(0, 1, 0), normal));
  const double angle_rad = glm::length(turn);
  return rotation_from_vector(turn * std::min(1.0, max_rad / angle_rad));
}

Carry land(const FloorFeetTask& task,
           std::size_t side,
           const FrameRange& stance,
           const glm::dvec2& carried_xz_m) {
  Carry carry;
  carry.pivot = pivot_of(task, side, stance);
  const FloorSpot spot =
      floor_at(task.floor, xz_of(carry.pivot) + carried_xz_m, task.time_s(stance.first));
  carry.stance = {stance, spot.part};
  carry.shift_m = {carried_xz_m.x, spot.height_m, carried_xz_m.y};
  carry.turn = turn_to(spot.normal_in_world, task.options.max_foot_pitch_rad);
  carry.moved_before_m = task.moved(spot.part, stance.first);
  return carry;
}

// Places the stances of both feet in the order in which they begin, since each is carried
// by those before it.
std::array<std::vector<Carry>, 2> land_all(const FloorFeetTask& task) {
  std::array<std::vector<Carry>, 2> out;
  glm::dvec2 carried_xz_m(0.0);
  for (int t = 0; t < static_cast<int>(task.count()); ++t) {
    glm::dvec2 step_m(0.0);
    int standing = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& stances = task.contacts.feet[side].stance;
      auto& landed = out[side];
      if (landed.size() < stances.size() && stances[landed.size()].first == t) {
        landed.push_back(land(task, side, stances[landed.size()], carried_xz_m));
      }
      if (landed.empty() || !holds(landed.back().stance.frames, t)) continue;
      const FloorPartIndex part = landed.back().stance.part;
      step_m += xz_of(task.moved(part, t + 1) - task.moved(part, t));
      ++standing;
    }
    if (standing > 0) carried_xz_m += step_m / static_cast<double>(standing);
  }
  return out;
}

FootPlace carried(const FloorFeetTask& task,
                  const Carry& carry,
                  int frame,
                  FootPlace place) {
  const glm::dvec3 shift_m =
      carry.shift_m + (task.moved(carry.stance.part, frame) - carry.moved_before_m);
  if (carry.turn != kLevel) {
    place.ankle_in_world =
        carry.pivot + carry.turn * (place.ankle_in_world - carry.pivot);
    place.foot = glm::normalize(carry.turn * place.foot);
    place.toes = glm::normalize(carry.turn * place.toes);
  }
  place.ankle_in_world += shift_m;
  return place;
}

glm::dquat between(const glm::dquat& a, const glm::dquat& b, double share) {
  return a == b ? a : glm::slerp(a, b, share);
}

FootPlace between(const FootPlace& a, const FootPlace& b, double share) {
  return {a.ankle_in_world + share * (b.ankle_in_world - a.ankle_in_world),
          between(a.foot, b.foot, share),
          between(a.toes, b.toes, share)};
}

// Returns the depth of a foot within the floor. [m]
double depth_m(const FloorFeetTask& task,
               std::size_t side,
               int frame,
               const FootPlace& place) {
  const FootMap& foot = task.map.feet[side];
  const glm::dvec3 ball =
      place.ankle_in_world + place.foot * foot.ball_from_ankle_in_t_pose;
  double max_depth_m = 0.0;
  for (const auto& [p, rest_m] : {std::pair(place.ankle_in_world, foot.ankle_height_m),
                                  std::pair(ball, foot.ball_height_m)}) {
    const FloorSpot spot = floor_at(task.floor, xz_of(p), task.time_s(frame));
    max_depth_m =
        std::max(max_depth_m, spot.height_m + rest_m / spot.normal_in_world.y - p.y);
  }
  return max_depth_m;
}

// Height of a swing's bump: 0 to 1 to 0 with continuous second derivative.
double bump(double share) {
  constexpr double kFlank = 0.4;
  return smooth_step(share / kFlank) * smooth_step((1.0 - share) / kFlank);
}

// Computes the swing from one stance to the next.
void swing(const FloorFeetTask& task,
           std::size_t side,
           const Carry& from,
           const Carry& to,
           FloorFoot& out) {
  const int first = from.stance.frames.last;
  const int last = to.stance.frames.first;
  const auto share = [&](int t) {
    return static_cast<double>(t - first) / static_cast<double>(last - first);
  };
  double max_m = 0.0;
  for (int t = first + 1; t < last; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const FootPlace& flat = task.flat[side][i];
    out.places[i] = between(
        carried(task, from, t, flat), carried(task, to, t, flat), smooth_step(share(t)));
    out.carried_m[i] = out.places[i].ankle_in_world - flat.ankle_in_world;
    constexpr double kRounding_m = 1e-6;
    const double depth = depth_m(task, side, t, out.places[i]);
    if (bump(share(t)) < kLateLift || depth < kRounding_m) continue;
    const double margin_m = kClearanceInLegs * task.map.leg_length_m;
    max_m = std::max(max_m, (depth + margin_m) / bump(share(t)));
  }
  if (max_m == 0.0) return;
  max_m = std::min(max_m, kMaxLiftInLegs * task.map.leg_length_m);
  for (int t = first + 1; t < last; ++t) {
    out.places[static_cast<std::size_t>(t)].ankle_in_world.y += max_m * bump(share(t));
  }
}

FloorFoot stand(const FloorFeetTask& task,
                std::size_t side,
                const std::vector<Carry>& carries) {
  FloorFoot out{task.flat[side], {}, {}};
  const int count = static_cast<int>(task.count());
  const glm::dvec3 base_m(0.0, task.floor.base_height_m, 0.0);
  out.carried_m.assign(task.count(), base_m);
  if (carries.empty()) {
    for (FootPlace& place : out.places) place.ankle_in_world += base_m;
    return out;
  }
  for (std::size_t k = 0; k < carries.size(); ++k) {
    const Carry& carry = carries[k];
    out.stances.push_back(carry.stance);
    const int from = k == 0 ? 0 : carry.stance.frames.first;
    const int to = k + 1 == carries.size() ? count - 1 : carry.stance.frames.last;
    for (int t = from; t <= to; ++t) {
      const auto i = static_cast<std::size_t>(t);
      const FootPlace& flat = task.flat[side][i];
      out.places[i] = carried(task, carry, t, flat);
      out.carried_m[i] = out.places[i].ankle_in_world - flat.ankle_in_world;
    }
    if (k > 0) swing(task, side, carries[k - 1], carry, out);
  }
  return out;
}

}  // namespace

std::array<FloorFoot, 2> stand_feet_on(const Floor& floor,
                                       const std::array<std::vector<FootPlace>, 2>& flat,
                                       const Contacts& contacts,
                                       const BodyMap& map,
                                       FrameRate rate,
                                       int first_frame,
                                       const StandFeetOptions& options) {
  MAREY_ASSERT(rate.hz > 0.0 && flat[0].size() == flat[1].size());
  MAREY_ASSERT(static_cast<int>(flat[0].size()) == contacts.frame_count);
  const FloorFeetTask task{floor, flat, contacts, map, rate, first_frame, options};
  const auto carries = land_all(task);
  return {stand(task, 0, carries[0]), stand(task, 1, carries[1])};
}

}  // namespace marey::retarget
