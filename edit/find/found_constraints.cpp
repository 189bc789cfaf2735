// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/found_constraints.h"

#include <algorithm>
#include <map>
#include <utility>

#include "edit/find/box_touches.h"

#include "core/humanoid.h"
#include "retarget/adapt/plan_supports.h"
#include "retarget/adapt/support_constraints.h"
#include "retarget/body/body_volume.h"
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

std::vector<Constraint> found_supports(const EditState& state) {
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
  std::vector<Constraint> out =
      retarget::constraints_of(
          touches, motion.skeleton, state.map, volume, 0, motion.rate, options)
          .constraints;
  for (Constraint& constraint : out) add_slack(motion.rate, constraint.activation);
  for (Constraint& constraint : box_constraints(state, boxes, objects)) {
    out.push_back(std::move(constraint));
  }
  add_found_prefix(out);
  return out;
}

}  // namespace marey::edit
