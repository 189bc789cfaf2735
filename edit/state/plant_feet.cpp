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
#include "core/base/smooth_step.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/com/foot_goals.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/feet/ground_legs.h"
#include "retarget/feet/leg_placement.h"
#include "retarget/feet/plan_foot_path.h"

namespace marey::edit {
namespace {

using retarget::FootPlace;
using retarget::NormalizedPose;

// A frame whose feet move by less than this keeps its pose to the bit. [m]
constexpr double kUnmoved_m = 1e-9;
// The same for the rotation of feet and toes: 1 minus the dot product of quaternions.
constexpr double kUnturned = 1e-15;

/// Normalizes one frame of a motion at a time: a normalized posture takes four times the
/// memory of a pose.
class PosturesOf {
 public:
  explicit PosturesOf(const EditState& state)
      : state_(state), joints_(state.motion.skeleton.joints.size()) {}

  /// Returns the posture of a frame as its pose is now.
  NormalizedPose& at(std::size_t frame) {
    world_from_joints(state_.motion.skeleton, state_.motion.poses[frame], joints_);
    retarget::normalize(state_.map, joints_, pose_, retarget::RootNormalization::kNone);
    return pose_;
  }
  /// Returns a foot of the frame of the last at().
  [[nodiscard]] FootPlace foot(int side) const {
    return retarget::foot_of(state_.map, pose_, joints_, side);
  }

 private:
  const EditState& state_;
  std::vector<RigidTransform> joints_;
  NormalizedPose pose_;
};

/// Returns the legs of all frames, the roots raised by `rise_m`.
retarget::GroundLegs ground_legs(const EditState& state, double rise_m) {
  retarget::GroundLegs out;
  PosturesOf postures(state);
  std::vector<RigidTransform> joints(state.motion.skeleton.joints.size());
  for (std::size_t t = 0; t < state.motion.poses.size(); ++t) {
    NormalizedPose& pose = postures.at(t);
    pose.root.y += rise_m;
    retarget::add_legs(state.motion.skeleton, state.map, pose, joints, out);
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

/// Settles each posture on its feet, and takes legs and root from it.
class LegTaker {
 public:
  LegTaker(const retarget::GroundLegs& ground, EditState& state)
      : ground_(ground),
        state_(state),
        legs_(leg_joints(state)),
        postures_(state),
        joints_(state.motion.skeleton.joints.size()) {
    for (std::size_t side = 0; side < 2; ++side) {
      bears_[side] =
          retarget::frame_marks(state.contacts.feet[side].stance, ground.frame_count());
    }
  }

  /// Returns false if a bearing foot does not reach its place.
  bool take(std::size_t t, double sink_m) {
    NormalizedPose& settled = postures_.at(t);
    const glm::dvec3 root = settled.root;
    bool is_same = true;
    for (int side = 0; side < 2; ++side) {
      is_same = is_same && is_same_place(postures_.foot(side), planned(t, side));
    }
    (void)retarget::settle_pose(state_.map, ground_, t, sink_m, settled);
    const glm::dvec3 sunk = settled.root - root;
    if (is_same && glm::length(sunk) < kUnmoved_m) return true;
    const Skeleton& skeleton = state_.motion.skeleton;
    retarget::expand(settled, skeleton, state_.map, joints_, expanded_);
    Pose& pose = state_.motion.poses[t];
    pose.root_in_world += sunk;
    for (const std::size_t joint : legs_) {
      pose.parent_from_joint[joint] = expanded_.parent_from_joint[joint];
    }
    world_from_joints(skeleton, pose, joints_);
    bool is_missed = false;
    for (int side = 0; side < 2; ++side) {
      // Joints without a bone between hips and thigh are at rest in settled postures.
      const FootPlace& foot = planned(t, side);
      const glm::dvec3& ankle = joints_[index(state_.map.leg(side).end)].translation;
      double off_m = glm::distance(ankle, foot.ankle_in_world);
      if (off_m > kUnmoved_m) off_m = reach_foot(skeleton, state_.map, side, foot, pose);
      is_missed |= off_m > kReached_m && bears_[static_cast<std::size_t>(side)][t] != 0;
    }
    return !is_missed;
  }

 private:
  [[nodiscard]] const FootPlace& planned(std::size_t t, int side) const {
    return ground_.legs[static_cast<std::size_t>(side)].foot[t];
  }

  const retarget::GroundLegs& ground_;
  EditState& state_;
  std::vector<std::size_t> legs_;
  std::array<std::vector<char>, 2> bears_;
  PosturesOf postures_;
  std::vector<RigidTransform> joints_;
  Pose expanded_;
};

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

// Draws moved swinging feet nearer to the hips, which sink by `sink_m` in each frame.
void soften_swings(std::span<const double> sink_m,
                   const EditState& state,
                   std::array<std::vector<FootPlace>, 2>& feet) {
  PosturesOf postures(state);
  std::vector<RigidTransform> joints(state.motion.skeleton.joints.size());
  const double ramp = kSoftRamp_s * state.motion.rate.hz;
  for (std::size_t side = 0; side < 2; ++side) {
    const retarget::LimbMap& leg = state.map.leg(static_cast<int>(side));
    const auto away = frames_from_stance(
        retarget::frame_marks(state.contacts.feet[side].stance, sink_m.size()));
    for (std::size_t t = 0; t < sink_m.size(); ++t) {
      if (away[t] == 0.0) continue;
      FootPlace& place = feet[side][t];
      (void)postures.at(t);
      if (is_same_place(postures.foot(static_cast<int>(side)), place)) continue;
      world_from_joints(state.motion.skeleton, state.motion.poses[t], joints);
      const glm::dvec3 hip = joints[index(leg.upper)].translation;
      const glm::dvec3 ankle = joints[index(leg.end)].translation;
      const glm::dvec3 settled_hip = hip - glm::dvec3(0.0, sink_m[t], 0.0);
      const glm::dvec3 reach = place.ankle_in_world - settled_hip;
      const double planned = glm::length(reach) / leg.length_m();
      if (planned <= kFreeExtension) continue;
      const double own = glm::distance(hip, ankle) / leg.length_m();
      const double share = smooth_step(away[t] / ramp);
      const double wanted = planned + share * (soft_extension(planned, own) - planned);
      place.ankle_in_world = settled_hip + (wanted / planned) * reach;
    }
  }
}

double largest_move_m(const EditState& state,
                      const std::array<std::vector<FootPlace>, 2>& feet) {
  double largest = 0.0;
  PosturesOf postures(state);
  for (std::size_t t = 0; t < state.motion.poses.size(); ++t) {
    (void)postures.at(t);
    for (int side = 0; side < 2; ++side) {
      const auto s = static_cast<std::size_t>(side);
      largest = std::max(largest, moved_m(postures.foot(side), feet[s][t]));
    }
  }
  return largest;
}

void settle(std::array<std::vector<FootPlace>, 2> feet,
            const SetFeetOptions& options,
            EditState& state,
            PlantReport& report) {
  report.largest_moved_m = largest_move_m(state, feet);
  retarget::GroundLegs legs = ground_legs(state, 0.0);
  for (std::size_t side = 0; side < 2; ++side) {
    MAREY_ASSERT(feet[side].size() == legs.frame_count());
    legs.legs[side].foot = std::move(feet[side]);
  }
  if (legs.frame_count() == 0) return;
  const std::vector<double> sink = retarget::root_sinks_m(state.map,
                                                          state.contacts,
                                                          state.motion.rate,
                                                          legs,
                                                          options.ground.anticipation_s,
                                                          options.ground.straight);
  if (options.soft_swings) {
    std::array<std::vector<FootPlace>, 2> soft{std::move(legs.legs[0].foot),
                                               std::move(legs.legs[1].foot)};
    soften_swings(sink, state, soft);
    for (std::size_t side = 0; side < 2; ++side) {
      legs.legs[side].foot = std::move(soft[side]);
    }
  }
  LegTaker taker(legs, state);
  for (std::size_t t = 0; t < sink.size(); ++t) {
    if (!taker.take(t, sink[t])) ++report.unreachable_frames;
  }
}

}  // namespace

PlantReport plant_feet(EditState& state) {
  PlantReport report;
  const auto& contacts = state.contacts.feet;
  if (contacts[0].stance.empty() && contacts[1].stance.empty()) return report;
  report.slide_before_mm = measure_slide(state).worst_drift_mm;
  const double rise_m =
      retarget::standing_rise_m(state.map, state.contacts, state.map, 1.0);
  std::array<std::vector<FootPlace>, 2> feet;
  {
    const retarget::GroundLegs level = ground_legs(state, rise_m);
    for (std::size_t side = 0; side < 2; ++side) {
      feet[side] = retarget::plan_foot_path(level.legs[side].foot,
                                            contacts[side],
                                            state.map.feet[side],
                                            state.map.leg_length_m,
                                            state.motion.rate);
      for (FootPlace& place : feet[side]) place.ankle_in_world.y -= rise_m;
    }
  }
  settle(std::move(feet), {}, state, report);
  report.slide_after_mm = measure_slide(state).worst_drift_mm;
  return report;
}

PlantReport set_feet(EditState& state,
                     const std::array<std::vector<std::optional<FootPlace>>, 2>& feet,
                     const SetFeetOptions& options) {
  PlantReport report;
  report.slide_before_mm = measure_slide(state).worst_drift_mm;
  const std::size_t count = state.motion.poses.size();
  MAREY_ASSERT(feet[0].size() == count && feet[1].size() == count);
  std::array<std::vector<FootPlace>, 2> planned;
  PosturesOf postures(state);
  for (std::size_t t = 0; t < count; ++t) {
    (void)postures.at(t);
    for (int side = 0; side < 2; ++side) {
      const auto s = static_cast<std::size_t>(side);
      planned[s].push_back(feet[s][t] ? *feet[s][t] : postures.foot(side));
    }
  }
  settle(std::move(planned), options, state, report);
  report.slide_after_mm = measure_slide(state).worst_drift_mm;
  return report;
}

std::vector<FootPlace> foot_places(const EditState& state, int side) {
  return retarget::foot_places(state.motion, state.map, side);
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
