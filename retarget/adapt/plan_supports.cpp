// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/plan_supports.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/humanoid.h"
#include "retarget/constraints/constraint_error.h"
#include "retarget/feet/plan_feet.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr std::array<B, 2> kFeet{B::kLeftFoot, B::kRightFoot};
// Merges runs that are separated by less than `gap` frames.
std::vector<FrameRange> merged(const std::vector<FrameRange>& runs, double gap) {
  std::vector<FrameRange> out;
  for (const FrameRange& run : runs) {
    if (!out.empty() && run.first - out.back().last <= gap) {
      out.back().last = run.last;
    } else {
      out.push_back(run);
    }
  }
  return out;
}

std::vector<FrameRange> common(const std::vector<FrameRange>& a,
                               const std::vector<FrameRange>& b) {
  std::vector<FrameRange> out;
  for (const FrameRange& x : a) {
    for (const FrameRange& y : b) {
      const FrameRange both{std::max(x.first, y.first), std::min(x.last, y.last)};
      if (both.first <= both.last) out.push_back(both);
    }
  }
  return out;
}

// Returns the runs with the floor part of each.
std::vector<FloorStance> standing(const std::vector<FrameRange>& runs,
                                  const std::vector<FloorStance>& stances) {
  std::vector<FloorStance> out;
  for (const FrameRange& run : runs) {
    for (const FloorStance& stance : stances) {
      if (run.first < stance.frames.first || run.last > stance.frames.last) continue;
      out.push_back({run, stance.part});
    }
  }
  return out;
}

// Never starts by itself: the caller that drives the track starts it.
constexpr double kNever_s = kCallerStart_s;

// Runs of one point with the same types of transitions at both ends.
struct Bearing {
  const char* name;
  glm::dvec3 offset_in_t_pose;
  bool turns;
  bool fades_in = true;
  bool fades_out = true;
  std::vector<FrameRange> runs{};
};

// Adds the runs in which one joint bears alone, with the adjacent frames of the flat
// foot. Both hold in these frames, so that the transition has no fade; fades are for feet
// in the air.
void add_alone(const std::vector<FrameRange>& runs,
               const std::vector<FrameRange>& flat,
               const Bearing& point,
               std::vector<Bearing>& ways) {
  std::array<Bearing, 4> kinds{point, point, point, point};
  const auto add = [&](int first, int last, bool from_flat, bool to_flat) {
    if (from_flat && to_flat && last - first < 2) return;
    Bearing& kind = kinds[(from_flat ? 2U : 0U) + (to_flat ? 1U : 0U)];
    kind.fades_in = !from_flat;
    kind.fades_out = !to_flat;
    kind.runs.push_back({first, last});
  };
  for (const FrameRange& run : runs) {
    int from = run.first;
    bool from_flat = false;
    for (const FrameRange& both : flat) {
      if (both.first < run.first || both.last > run.last) continue;
      if (both.first > from) add(from, both.first, from_flat, true);
      from = both.last;
      from_flat = true;
    }
    if (from < run.last || !from_flat) add(from, run.last, from_flat, false);
  }
  for (Bearing& kind : kinds) {
    if (!kind.runs.empty()) ways.push_back(std::move(kind));
  }
}

std::string id_of(const std::string& segment, const Bearing& way) {
  std::string id = "found " + segment + " " + way.name;
  if (!way.turns || (way.fades_in && way.fades_out)) return id;
  if (way.fades_in) return id + " before flat";
  return id + (way.fades_out ? " after flat" : " between flat");
}

}  // namespace

std::vector<SupportTrack> plan_supports(const Motion& reference,
                                        const BodyMap& map,
                                        const Contacts& contacts,
                                        const PlanSupportsOptions& options) {
  MAREY_ASSERT(contacts.frame_count == static_cast<int>(reference.poses.size()));
  MAREY_ASSERT(options.ramp_s >= 0.0 && reference.rate.hz > 0.0);
  const auto plans =
      plan_feet(reference, map, contacts, options.floor_height_m, options.floor);
  std::vector<SupportTrack> tracks;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!options.feet[side]) continue;
    const FootContacts& bears = contacts.feet[side];
    const FootMap& foot = map.feet[side];
    const FloorFoot& plan = plans[side];
    const glm::dvec3 ball = foot.ball_from_ankle_in_t_pose;
    // Heel and ball come first. The first of several supports of one limb is closed
    // exactly, and these hold while the flat foot fades in or out next to them.
    const std::vector<FrameRange> flat = common(bears.heel, bears.ball);
    std::vector<Bearing> ways;
    add_alone(bears.heel, flat, {"heel", glm::dvec3(0.0), true}, ways);
    add_alone(bears.ball, flat, {"ball", ball, true}, ways);
    ways.push_back({"flat", glm::dvec3(0.0), false, true, true, flat});
    for (const Bearing& way : ways) {
      SupportTrack track;
      const double in_s = way.fades_in ? options.ramp_s : 0.0;
      const double out_s = way.fades_out ? options.ramp_s : 0.0;
      track.bears = merged(way.runs, (in_s + out_s) * reference.rate.hz + 1.0);
      if (track.bears.empty()) continue;
      track.stands = standing(way.runs, plan.stances);
      const std::string segment(name(kFeet[side]));
      track.constraint.id = id_of(segment, way);
      track.ball_in_t_pose = ball;
      track.constraint.point = {segment, way.offset_in_t_pose};
      track.constraint.goal = Support{glm::dvec3(0.0), std::nullopt, way.turns};
      track.constraint.activation = {kNever_s, std::nullopt, in_s, out_s};
      for (const FootPlace& place : plan.places) {
        track.p_in_world.push_back(place.ankle_in_world +
                                   place.foot * way.offset_in_t_pose);
        track.world_from_t_pose.push_back(place.foot);
      }
      tracks.push_back(std::move(track));
    }
  }
  return tracks;
}

}  // namespace marey::retarget
