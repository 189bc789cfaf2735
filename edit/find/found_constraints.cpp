// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/found_constraints.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <variant>

#include "edit/find/box_touches.h"
#include "edit/state/plant_feet.h"

#include "core/humanoid.h"
#include "core/pose.h"
#include "retarget/adapt/plan_supports.h"
#include "retarget/adapt/support_constraints.h"
#include "retarget/body/body_volume.h"
#include "retarget/constraints/resolve_segment.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/hands/find_touches.h"
#include "retarget/hands/touch_constraints.h"

namespace marey::edit {
namespace {

constexpr double kTouchFade_s = 0.3;
constexpr double kTouchPrecision_m = 0.005;
/// The first and the last frame of a touch must be fully active despite rounding.
constexpr double kSlackFrames = 0.01;

void add_found_prefix(std::vector<Constraint>& constraints) {
  for (Constraint& constraint : constraints) {
    constraint.id = std::string(kFoundPrefix) + constraint.id;
  }
}

/// Extends a detected interval by a small part of a frame.
void add_slack(FrameRate rate, Activation& when) {
  if (when.start_s) *when.start_s -= kSlackFrames / rate.hz;
  if (when.stop_s) *when.stop_s += kSlackFrames / rate.hz;
}

bool overlap(const FrameRange& a, const FrameRange& b) {
  return a.first <= b.last && b.first <= a.last;
}

/// World frames of all joints, frame after frame.
std::vector<std::vector<RigidTransform>> all_joints(const Motion& motion) {
  std::vector<std::vector<RigidTransform>> out;
  out.reserve(motion.poses.size());
  for (const Pose& pose : motion.poses) {
    out.push_back(world_from_joints(motion.skeleton, pose));
  }
  return out;
}

/// Distance of the hand of a touch from where the touch requires it.
class TouchGap {
 public:
  TouchGap(const EditState& state, const Constraint& touch)
      : state_(state), touch_(touch) {}

  [[nodiscard]] double at(std::span<const RigidTransform> joints) const {
    const glm::dvec3 hand = place_of(touch_.point, joints);
    if (const auto* goal = std::get_if<DistanceToPoint>(&touch_.goal)) {
      return std::abs(glm::distance(hand, goal->p_in_world) - goal->distance_m);
    }
    const auto* goal = std::get_if<DistanceToBody>(&touch_.goal);
    if (goal == nullptr) return 0.0;
    const double distance_m = glm::distance(hand, place_of(goal->other, joints));
    return std::abs(distance_m - goal->distance_m);
  }

 private:
  [[nodiscard]] glm::dvec3 place_of(const BodyPoint& point,
                                    std::span<const RigidTransform> joints) const {
    const auto joint =
        retarget::resolve_segment(state_.motion.skeleton, point.segment).value();
    const glm::dquat& t_pose_from_joint =
        state_.map.joints[index(joint)].t_pose_from_joint;
    return joints[index(joint)] *
           (glm::conjugate(t_pose_from_joint) * point.offset_in_t_pose);
  }

  const EditState& state_;
  const Constraint& touch_;
};

/// Limits the fades of touches to the time in which the hand is near. While it is further
/// away, a touch that fades in would pull hand and body towards each other.
void shorten_fades(const EditState& state, std::vector<Constraint>& touches) {
  constexpr double kNear_m = 0.05;
  constexpr double kMinFade_s = 0.1;
  const double hz = state.motion.rate.hz;
  const auto joints = all_joints(state.motion);
  const int last = state.frame_count() - 1;
  for (Constraint& touch : touches) {
    const TouchGap gap(state, touch);
    // Returns the time from an edge, in whole frames, in which the hand stays near.
    const auto near_s = [&](double edge_s, int step, double fade_s) {
      int frame = static_cast<int>(step < 0 ? std::ceil(edge_s * hz - kSlackFrames)
                                            : std::floor(edge_s * hz + kSlackFrames));
      double out_s = 0.0;
      while (out_s < fade_s) {
        frame += step;
        if (frame < 0 || frame > last) return fade_s;
        if (gap.at(joints[static_cast<std::size_t>(frame)]) > kNear_m) break;
        out_s += 1.0 / hz;
      }
      return std::clamp(out_s, std::min(kMinFade_s, fade_s), fade_s);
    };
    Activation& when = touch.activation;
    if (when.start_s) {
      const double full_s = *when.start_s + when.start_duration_s;
      when.start_duration_s = near_s(full_s, -1, when.start_duration_s);
      when.start_s = full_s - when.start_duration_s;
    }
    if (when.stop_s) {
      when.stop_duration_s = near_s(*when.stop_s, 1, when.stop_duration_s);
    }
  }
}

/// Returns the fade on one side of a touch on an object: at most half the pause.
double room_s(const BoxTouch& touch,
              const std::vector<BoxTouch>& all,
              bool before,
              FrameRate rate) {
  double room = kTouchFade_s;
  for (const BoxTouch& other : all) {
    if (&other == &touch || other.side != touch.side) continue;
    const int pause = before ? touch.frames.first - other.frames.last
                             : other.frames.first - touch.frames.last;
    if (pause > 0) room = std::min(room, 0.5 * pause / rate.hz);
  }
  return room;
}

std::vector<Constraint> box_constraints(const EditState& state,
                                        const std::vector<BoxTouch>& touches,
                                        std::span<const EditObject> objects) {
  const FrameRate rate = state.motion.rate;
  std::vector<Constraint> out;
  std::map<std::string, int> used;
  for (const BoxTouch& touch : touches) {
    const HumanBone hand = touch.side == 0 ? HumanBone::kLeftHand : HumanBone::kRightHand;
    const JointIndex joint = *state.map.joint_of[marey::index(hand)];
    const std::string words = std::string(touch.side == 0 ? "left" : "right") +
                              " hand on " + objects[touch.object].name;
    Constraint constraint;
    constraint.id = words + " " + std::to_string(++used[words]);
    constraint.point = {
        std::string(name(hand)),
        state.map.joints[index(joint)].t_pose_from_joint * touch.p_in_joint};
    constraint.goal = DistanceToPoint{0.0, touch.p_in_world};
    constraint.precision_m = kTouchPrecision_m;
    Activation& when = constraint.activation;
    when.start_duration_s = room_s(touch, touches, true, rate);
    when.stop_duration_s = room_s(touch, touches, false, rate);
    if (touch.frames.first > 0) {
      when.start_s = touch.frames.first / rate.hz - when.start_duration_s;
    }
    if (touch.frames.last + 1 < state.frame_count()) {
      when.stop_s = touch.frames.last / rate.hz;
    }
    add_slack(rate, when);
    out.push_back(std::move(constraint));
  }
  return out;
}

}  // namespace

std::string_view family_name(std::string_view id) {
  std::string_view out = given_name(id);
  const std::size_t last = out.find_last_not_of("0123456789");
  if (last == std::string_view::npos || last + 1 == out.size() || out[last] != ' ') {
    return out;
  }
  return out.substr(0, last);
}

std::vector<Constraint> found_supports(const EditState& detected) {
  // Adaptation plants the feet first. Footprints that differ from the planted ones by
  // millimetres would move the whole body, and bend knees that are straight.
  EditState state = detected;
  (void)plant_feet(state);
  retarget::PlanSupportsOptions options;
  options.floor_height_m =
      -retarget::standing_rise_m(state.map, state.contacts, state.map, 1.0);
  const auto tracks =
      retarget::plan_supports(state.motion, state.map, state.contacts, options);
  std::vector<Constraint> out =
      retarget::support_constraints(tracks, state.motion.rate).constraints;
  add_found_prefix(out);
  return out;
}

std::vector<Constraint> found_touches(const EditState& state,
                                      std::span<const EditObject> objects) {
  const Motion& motion = state.motion;
  const auto volume = retarget::average_volume(motion.skeleton, state.map);
  const std::vector<BoxTouch> boxes =
      find_box_touches(motion, state.map, volume, objects);
  retarget::Touches touches = retarget::find_touches(motion, state.map, volume);
  std::erase_if(touches.still, [&](const retarget::StillHand& still) {
    return std::any_of(boxes.begin(), boxes.end(), [&](const BoxTouch& touch) {
      return touch.side == still.side && overlap(touch.frames, still.frames);
    });
  });
  retarget::TouchConstraintsOptions options;
  options.fade_s = kTouchFade_s;
  options.precision_m = kTouchPrecision_m;
  options.nearest_alone = true;
  std::vector<Constraint> out =
      retarget::constraints_of(
          touches, motion.skeleton, state.map, volume, 0, motion.rate, options)
          .constraints;
  for (Constraint& constraint : out) add_slack(motion.rate, constraint.activation);
  for (Constraint& constraint : box_constraints(state, boxes, objects)) {
    out.push_back(std::move(constraint));
  }
  shorten_fades(state, out);
  add_found_prefix(out);
  return out;
}

}  // namespace marey::edit
