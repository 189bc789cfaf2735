// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/support_constraints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/common.hpp>

#include "core/assert.h"

namespace marey::retarget {
namespace {

// Numbers are written to be read: tenths of a millisecond, micrometres.
constexpr double kTicksPerSecond = 1e4;
constexpr double kTicksPerMetre = 1e6;

double floor_s(double s) {
  constexpr double kSame = 1e-6;  // What rounding takes from a whole number of ticks.
  return std::floor(s * kTicksPerSecond + kSame) / kTicksPerSecond;
}

glm::dvec3 rounded(const glm::dvec3& p_m) {
  return glm::round(p_m * kTicksPerMetre) / kTicksPerMetre;
}

struct Stance {
  const SupportTrack* track = nullptr;
  FrameInterval frames;
};

// "found leftFoot ball after flat" is "leftFoot ball".
std::string name_of(const SupportTrack& track) {
  constexpr std::string_view kFound = "found ";
  std::string name = track.constraint.id;
  if (name.starts_with(kFound)) name.erase(0, kFound.size());
  for (const char* detail : {" before flat", " after flat", " between flat"}) {
    const std::size_t at = name.find(detail);
    if (at != std::string::npos) name.erase(at);
  }
  return name;
}

// Frames without a stance of this foot before this one, or after it.
struct Room {
  double before = 1e9;
  double after = 1e9;
};

Room room_of(const Stance& stance, const std::vector<Stance>& all) {
  Room room;
  for (const Stance& other : all) {
    if (&other == &stance) continue;
    if (other.track->constraint.point.segment != stance.track->constraint.point.segment) {
      continue;
    }
    if (other.frames.first < stance.frames.first) {
      room.before = std::min(
          room.before,
          std::max(0.0, static_cast<double>(stance.frames.first - other.frames.last)));
    }
    if (other.frames.last > stance.frames.last) {
      room.after = std::min(
          room.after,
          std::max(0.0, static_cast<double>(other.frames.first - stance.frames.last)));
    }
  }
  return room;
}

Constraint constraint_of(const Stance& stance, const Room& room, FrameRate rate) {
  const SupportTrack& track = *stance.track;
  const auto first = static_cast<std::size_t>(stance.frames.first);
  Constraint out = track.constraint;
  auto& support = std::get<Support>(out.goal);
  support.footprint_in_world = rounded(track.p_in_world[first]);
  if (!support.turns) support.world_from_t_pose = track.world_from_t_pose[first];
  out.point.offset_in_t_pose = rounded(out.point.offset_in_t_pose);
  Activation& when = out.activation;
  when.start_duration_s =
      floor_s(std::min(when.start_duration_s, 0.5 * room.before / rate.hz));
  when.stop_duration_s =
      floor_s(std::min(when.stop_duration_s, 0.5 * room.after / rate.hz));
  // Outward: what is rounded is still active in the first frame and the last.
  when.start_s = floor_s(floor_s(stance.frames.first / rate.hz) - when.start_duration_s);
  when.stop_s = floor_s(stance.frames.last / rate.hz + 2.0 / kTicksPerSecond);
  return out;
}

}  // namespace

ConstraintSet support_constraints(std::span<const SupportTrack> tracks, FrameRate rate) {
  MAREY_ASSERT(rate.hz > 0.0);
  std::vector<Stance> stances;
  for (const SupportTrack& track : tracks) {
    for (const FloorStance& stance : track.stands) {
      stances.push_back({&track, stance.frames});
    }
  }
  // A heel or a ball before the flat foot: of several supports of one foot the first is
  // closed exactly. Tracks are in that order, so that it is kept.
  ConstraintSet set;
  for (const Stance& stance : stances) {
    set.constraints.push_back(constraint_of(stance, room_of(stance, stances), rate));
    set.constraints.back().id = name_of(*stance.track);
  }
  std::map<std::string, std::vector<Constraint*>> of_name;
  for (Constraint& constraint : set.constraints) {
    of_name[constraint.id].push_back(&constraint);
  }
  for (auto& [name, same] : of_name) {
    std::stable_sort(same.begin(), same.end(), [](const auto* a, const auto* b) {
      return a->activation.start_s < b->activation.start_s;
    });
    for (std::size_t i = 0; i < same.size(); ++i) {
      same[i]->id = name + " " + std::to_string(i + 1);
    }
  }
  return set;
}

}  // namespace marey::retarget
