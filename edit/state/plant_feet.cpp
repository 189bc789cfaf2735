// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/plant_feet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "edit/state/op_weights.h"
#include "edit/state/reach_foot.h"
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "retarget/base/smooth_step.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/feet/leg_placement.h"

namespace marey::edit {
namespace {

using retarget::FootPlace;
using retarget::NormalizedPose;

// A frame whose feet move by less than this keeps its pose to the bit. [m]
constexpr double kUnmoved_m = 1e-9;
// The same for the rotation of feet and toes: 1 minus the dot product of quaternions.
constexpr double kUnturned = 1e-15;

/// The motion in normalized postures and as frames of its feet.
struct PlantFrames {
  std::vector<NormalizedPose> poses;
  std::array<std::vector<FootPlace>, 2> feet;
};

PlantFrames plant_frames(const EditState& state) {
  PlantFrames out;
  const Skeleton& skeleton = state.motion.skeleton;
  std::vector<RigidTransform> joints(skeleton.joints.size());
  out.poses.resize(state.motion.poses.size());
  for (std::size_t t = 0; t < out.poses.size(); ++t) {
    world_from_joints(skeleton, state.motion.poses[t], joints);
    retarget::normalize(
        state.map, joints, out.poses[t], retarget::RootNormalization::kNone);
    for (int side = 0; side < 2; ++side) {
      out.feet[static_cast<std::size_t>(side)].push_back(
          retarget::foot_of(state.map, out.poses[t], joints, side));
    }
  }
  return out;
}

double moved_m(const FootPlace& a, const FootPlace& b) {
  return glm::distance(a.ankle_in_world, b.ankle_in_world);
}

bool is_turned(const glm::dquat& a, const glm::dquat& b) {
  const double dot = glm::dot(a, b);
  return 1.0 - dot * dot / (glm::dot(a, a) * glm::dot(b, b)) > kUnturned;
}

bool is_same_place(const FootPlace& a, const FootPlace& b) {
  return moved_m(a, b) < kUnmoved_m && !is_turned(a.foot, b.foot) &&
         !is_turned(a.toes, b.toes);
}

std::vector<std::size_t> leg_joints(const EditState& state) {
  constexpr std::array kLegs{EditGroup::kLeftLeg, EditGroup::kRightLeg};
  std::vector<std::size_t> out;
  for (const JointIndex joint : joints_of_groups(state, kLegs)) {
    out.push_back(index(joint));
  }
  return out;
}

// A bearing foot that is further from its place does not reach it. [m]
constexpr double kReached_m = 5e-4;

/// Takes legs and root from the settled postures, and everything else from the motion.
/// Returns the number of frames in which a bearing foot does not reach its place.
int take_legs(const std::vector<NormalizedPose>& settled,
              const PlantFrames& before,
              const std::array<std::vector<FootPlace>, 2>& feet,
              EditState& state) {
  const Skeleton& skeleton = state.motion.skeleton;
  const std::vector<std::size_t> legs = leg_joints(state);
  std::vector<RigidTransform> joints(skeleton.joints.size());
  Pose expanded;
  int missed = 0;
  std::array<std::vector<char>, 2> bears;
  for (std::size_t side = 0; side < 2; ++side) {
    bears[side] = retarget::frame_marks(state.contacts.feet[side].stance, settled.size());
  }
  for (std::size_t t = 0; t < settled.size(); ++t) {
    const glm::dvec3 sunk = settled[t].root - before.poses[t].root;
    if (glm::length(sunk) < kUnmoved_m && is_same_place(before.feet[0][t], feet[0][t]) &&
        is_same_place(before.feet[1][t], feet[1][t])) {
      continue;
    }
    retarget::expand(settled[t], skeleton, state.map, joints, expanded);
    Pose& pose = state.motion.poses[t];
    pose.root_in_world += sunk;
    for (const std::size_t joint : legs) {
      pose.parent_from_joint[joint] = expanded.parent_from_joint[joint];
    }
    world_from_joints(skeleton, pose, joints);
    bool is_missed = false;
    for (int side = 0; side < 2; ++side) {
      // Joints without a bone between hips and thigh are at rest in settled postures.
      const auto s = static_cast<std::size_t>(side);
      const glm::dvec3& ankle = joints[index(state.map.leg(side).end)].translation;
      double off_m = glm::distance(ankle, feet[s][t].ankle_in_world);
      if (off_m > kUnmoved_m) {
        off_m = reach_foot(skeleton, state.map, side, feet[s][t], pose);
      }
      is_missed |= off_m > kReached_m && bears[s][t] != 0;
    }
    if (is_missed) ++missed;
  }
  return missed;
}

// Extension of a swinging leg up to which it is free, the one that it approaches beyond,
// and the time after a stance in which this sets in. [share of the leg's length, s]
constexpr double kFreeExtension = 0.97;
constexpr double kMaxExtension = 0.998;
constexpr double kSoftRamp_s = 0.1;

// Returns the extension for a planned one; `own` is that of the leg before.
double soft_extension(double planned, double own) {
  const double from = std::max(own, kFreeExtension);
  if (planned <= from) return planned;
  const double room = std::max(0.0, kMaxExtension - from);
  if (room == 0.0) return from;
  return from + room * (1.0 - std::exp((from - planned) / room));
}

// Frames to the nearest stance; large values without one.
std::vector<double> frames_from_stance(const std::vector<char>& stands) {
  std::vector<double> out(stands.size(), static_cast<double>(stands.size()));
  for (std::size_t t = 0; t < stands.size(); ++t) {
    if (stands[t] != 0) out[t] = 0.0;
    if (t > 0) out[t] = std::min(out[t], out[t - 1] + 1.0);
  }
  for (std::size_t t = stands.size(); t-- > 1;) {
    out[t - 1] = std::min(out[t - 1], out[t] + 1.0);
  }
  return out;
}

// Draws moved swinging feet nearer to the hips of the settled postures.
void soften_swings(const std::vector<NormalizedPose>& settled,
                   const PlantFrames& before,
                   const EditState& state,
                   std::array<std::vector<FootPlace>, 2>& feet) {
  std::vector<RigidTransform> joints(state.motion.skeleton.joints.size());
  const double ramp = kSoftRamp_s * state.motion.rate.hz;
  for (std::size_t side = 0; side < 2; ++side) {
    const retarget::LimbMap& leg = state.map.leg(static_cast<int>(side));
    const auto away = frames_from_stance(
        retarget::frame_marks(state.contacts.feet[side].stance, settled.size()));
    for (std::size_t t = 0; t < settled.size(); ++t) {
      FootPlace& place = feet[side][t];
      if (away[t] == 0.0 || is_same_place(before.feet[side][t], place)) continue;
      world_from_joints(state.motion.skeleton, state.motion.poses[t], joints);
      const glm::dvec3 hip = joints[index(leg.upper)].translation;
      const glm::dvec3 ankle = joints[index(leg.end)].translation;
      const glm::dvec3 settled_hip = hip + settled[t].root - before.poses[t].root;
      const glm::dvec3 reach = place.ankle_in_world - settled_hip;
      const double planned = glm::length(reach) / leg.length_m();
      if (planned <= kFreeExtension) continue;
      const double own = glm::distance(hip, ankle) / leg.length_m();
      const double share = retarget::smooth_step(away[t] / ramp);
      const double wanted = planned + share * (soft_extension(planned, own) - planned);
      place.ankle_in_world = settled_hip + (wanted / planned) * reach;
    }
  }
}

double largest_move_m(const PlantFrames& before,
                      const std::array<std::vector<FootPlace>, 2>& feet) {
  double largest = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t t = 0; t < feet[side].size(); ++t) {
      largest = std::max(largest, moved_m(before.feet[side][t], feet[side][t]));
    }
  }
  return largest;
}

void raise(std::vector<NormalizedPose>& poses, double height_m) {
  for (NormalizedPose& pose : poses) pose.root.y += height_m;
}

void settle(const PlantFrames& before,
            std::array<std::vector<FootPlace>, 2> feet,
            const SetFeetOptions& options,
            EditState& state,
            PlantReport& report) {
  std::vector<NormalizedPose> settled = before.poses;
  report.largest_moved_m = largest_move_m(before, feet);
  (void)retarget::settle_on_feet(state.motion.skeleton,
                                 state.map,
                                 state.contacts,
                                 state.motion.rate,
                                 settled,
                                 feet,
                                 options.ground);
  if (options.soft_swings) soften_swings(settled, before, state, feet);
  report.unreachable_frames = take_legs(settled, before, feet, state);
}

}  // namespace

PlantReport plant_feet(EditState& state) {
  PlantReport report;
  const auto& contacts = state.contacts.feet;
  if (contacts[0].stance.empty() && contacts[1].stance.empty()) return report;
  report.slide_before_mm = measure_slide(state).worst_drift_mm;
  const PlantFrames before = plant_frames(state);
  const double rise_m =
      retarget::standing_rise_m(state.map, state.contacts, state.map, 1.0);
  std::vector<NormalizedPose> level = before.poses;
  raise(level, rise_m);
  auto feet = retarget::plan_level_feet(
      state.motion.skeleton, state.map, state.contacts, state.motion.rate, level, {});
  for (auto& path : feet) {
    for (FootPlace& place : path) place.ankle_in_world.y -= rise_m;
  }
  settle(before, std::move(feet), {}, state, report);
  report.slide_after_mm = measure_slide(state).worst_drift_mm;
  return report;
}

PlantReport set_feet(EditState& state,
                     const std::array<std::vector<std::optional<FootPlace>>, 2>& feet,
                     const SetFeetOptions& options) {
  PlantReport report;
  report.slide_before_mm = measure_slide(state).worst_drift_mm;
  const PlantFrames before = plant_frames(state);
  std::array<std::vector<FootPlace>, 2> planned = before.feet;
  for (std::size_t side = 0; side < 2; ++side) {
    MAREY_ASSERT(feet[side].size() == planned[side].size());
    for (std::size_t t = 0; t < planned[side].size(); ++t) {
      if (feet[side][t]) planned[side][t] = *feet[side][t];
    }
  }
  settle(before, std::move(planned), options, state, report);
  report.slide_after_mm = measure_slide(state).worst_drift_mm;
  return report;
}

std::vector<FootPlace> foot_places(const EditState& state, int side) {
  return plant_frames(state).feet[static_cast<std::size_t>(side)];
}

SlideFigures measure_slide(const EditState& state) {
  SlideFigures out;
  const Skeleton& skeleton = state.motion.skeleton;
  std::vector<RigidTransform> joints(skeleton.joints.size());
  struct Point {
    std::size_t joint = 0;
    const std::vector<FrameRange>* runs = nullptr;
    std::vector<glm::dvec2> path;
  };
  std::vector<Point> points;
  for (int side = 0; side < 2; ++side) {
    const auto& foot = state.contacts.feet[static_cast<std::size_t>(side)];
    points.push_back({index(state.map.leg(side).end), &foot.heel, {}});
    const auto toes = state.map.joint_of[marey::index(retarget::toes_bone(side))];
    if (toes) points.push_back({index(*toes), &foot.ball, {}});
  }
  for (const Pose& pose : state.motion.poses) {
    world_from_joints(skeleton, pose, joints);
    for (Point& point : points) {
      const glm::dvec3& p = joints[point.joint].translation;
      point.path.emplace_back(p.x, p.z);
    }
  }
  double way_m = 0.0;
  int steps = 0;
  for (const Point& point : points) {
    for (const FrameRange& run : *point.runs) {
      const glm::dvec2 start = point.path[static_cast<std::size_t>(run.first)];
      for (int frame = run.first + 1; frame <= run.last; ++frame) {
        const auto t = static_cast<std::size_t>(frame);
        way_m += glm::distance(point.path[t], point.path[t - 1]);
        ++steps;
        const double drift_mm = 1e3 * glm::distance(point.path[t], start);
        if (drift_mm <= out.worst_drift_mm) continue;
        out.worst_drift_mm = drift_mm;
        out.worst_frame = frame;
      }
    }
  }
  if (steps > 0) out.mean_cm_per_s = 100.0 * way_m / steps * state.motion.rate.hz;
  return out;
}

}  // namespace marey::edit
