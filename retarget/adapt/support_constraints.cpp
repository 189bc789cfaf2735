// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/support_constraints.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/transform.h"

namespace marey::retarget {
namespace {

// Rounding for readable files: 0.1 ms and micrometres.
constexpr double kTicksPerSecond = 1e4;
constexpr double kTicksPerMetre = 1e6;

double floor_s(double s) {
  // Tolerance for rounding errors of a whole number of ticks.
  constexpr double kSame = 1e-6;
  return std::floor(s * kTicksPerSecond + kSame) / kTicksPerSecond;
}

glm::dvec3 rounded(const glm::dvec3& p_m) {
  return glm::round(p_m * kTicksPerMetre) / kTicksPerMetre;
}

struct Stance {
  const SupportTrack* track = nullptr;
  FrameRange frames;
};

// Converts a name such as "found leftFoot ball after flat" to "leftFoot ball".
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

// Frames before and after this stance without another stance of the same foot.
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

// Returns true for two stances of one foot with a direct transition: they share a frame.
bool share_a_frame(const Stance& a, const Stance& b) {
  return a.track->constraint.point.segment == b.track->constraint.point.segment &&
         a.frames.first <= b.frames.last && b.frames.first <= a.frames.last;
}

bool is_flat(const Stance& stance) {
  return !std::get<Support>(stance.track->constraint.goal).turns;
}

// Returns the frame of each stance's footprint. Stances with a direct transition hold
// together for a moment, and a foot that rotates rises on its heel: such stances use one
// frame, the first in which the foot is flat, so that their footprints belong to one
// posture.
std::vector<std::size_t> footprint_frames(const std::vector<Stance>& stances) {
  constexpr int kNone = -1;
  std::vector<int> frames(stances.size(), kNone);
  std::vector<std::size_t> by_time(stances.size());
  std::iota(by_time.begin(), by_time.end(), std::size_t{0});
  std::ranges::stable_sort(
      by_time, {}, [&](std::size_t i) { return stances[i].frames.first; });
  for (const std::size_t flat : by_time) {
    if (!is_flat(stances[flat]) || frames[flat] != kNone) continue;
    std::vector<std::size_t> chain{flat};
    frames[flat] = stances[flat].frames.first;
    while (!chain.empty()) {
      const std::size_t at = chain.back();
      chain.pop_back();
      for (std::size_t i = 0; i < stances.size(); ++i) {
        if (frames[i] != kNone || !share_a_frame(stances[at], stances[i])) continue;
        frames[i] = frames[at];
        chain.push_back(i);
      }
    }
  }
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < stances.size(); ++i) {
    out.push_back(static_cast<std::size_t>(frames[i] == kNone ? stances[i].frames.first
                                                              : frames[i]));
  }
  return out;
}

// Returns the maximum distance of a point of the foot from its position at the start of a
// stance. [m]
double travel_m(const Stance& stance, const glm::dvec3& offset_in_t_pose) {
  const SupportTrack& track = *stance.track;
  const auto place = [&](int frame) {
    const auto t = static_cast<std::size_t>(frame);
    return track.p_in_world[t] + track.world_from_t_pose[t] * offset_in_t_pose;
  };
  double max_m = 0.0;
  for (int t = stance.frames.first; t <= stance.frames.last; ++t) {
    max_m = std::max(max_m, glm::distance(place(t), place(stance.frames.first)));
  }
  return max_m;
}

// Returns true if a flat foot rotates during its stance.
bool turns_standing(const Stance& stance) {
  constexpr double kTurned_rad = 0.15;
  const auto& turn = stance.track->world_from_t_pose;
  const glm::dquat from =
      glm::conjugate(turn[static_cast<std::size_t>(stance.frames.first)]);
  for (int t = stance.frames.first; t <= stance.frames.last; ++t) {
    const glm::dquat turned = turn[static_cast<std::size_t>(t)] * from;
    if (glm::length(marey::rotation_vector(turned)) > kTurned_rad) return true;
  }
  return false;
}

Constraint constraint_of(const Stance& stance,
                         std::size_t at,
                         const Room& room,
                         FrameRate rate) {
  const SupportTrack& track = *stance.track;
  Constraint out = track.constraint;
  auto& support = std::get<Support>(out.goal);
  support.footprint_in_world = rounded(track.p_in_world[at]);
  if (!support.turns && turns_standing(stance)) {
    support.turns = true;
    if (travel_m(stance, track.ball_in_t_pose) <= travel_m(stance, glm::dvec3(0.0))) {
      out.point.offset_in_t_pose = track.ball_in_t_pose;
      support.footprint_in_world = rounded(
          track.p_in_world[at] + track.world_from_t_pose[at] * track.ball_in_t_pose);
    }
  } else if (!support.turns) {
    support.world_from_t_pose = track.world_from_t_pose[at];
  }
  out.point.offset_in_t_pose = rounded(out.point.offset_in_t_pose);
  Activation& when = out.activation;
  when.start_duration_s =
      floor_s(std::min(when.start_duration_s, 0.5 * room.before / rate.hz));
  when.stop_duration_s =
      floor_s(std::min(when.stop_duration_s, 0.5 * room.after / rate.hz));
  // Rounds outward, so that the first and the last frame stay active.
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
  // The flat foot comes first. The first of several supports of one foot is closed
  // exactly, so the next or previous stance agrees with it.
  std::ranges::stable_partition(stances, is_flat);
  ConstraintSet set;
  const std::vector<std::size_t> footprint_frame = footprint_frames(stances);
  for (std::size_t i = 0; i < stances.size(); ++i) {
    set.constraints.push_back(constraint_of(
        stances[i], footprint_frame[i], room_of(stances[i], stances), rate));
    set.constraints.back().id = name_of(*stances[i].track);
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
