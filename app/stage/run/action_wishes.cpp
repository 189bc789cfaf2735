// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/action_wishes.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>
#include <vector>

#include "app/stage/run/target_places.h"
#include "core/nearest_word.h"

namespace marey::app {
namespace {

constexpr double kNever_s = 1e9;  // Started by the script.
constexpr double kDegree_rad = 0.017453292519943295;
constexpr double kConstraintFade_s = 0.3;

const std::string kNoText;

bool is_empty_loop(const SceneAction& action, const MotionClip& clip) {
  const auto* play = std::get_if<ScenePlay>(&action.deed);
  if (play == nullptr || clip.loops) return false;
  return play->loops || play->cycles.value_or(1) > 1;
}

// The segment of the body on which a deed acts; empty: none.
const std::string& segment_of(const SceneAction& action) {
  if (const auto* deed = std::get_if<SceneConstrain>(&action.deed)) {
    return deed->point.segment;
  }
  if (const auto* deed = std::get_if<SceneFollow>(&action.deed)) {
    return deed->point.segment;
  }
  return kNoText;
}

Goal goal_of(const SceneConstrain& deed) {
  switch (deed.type) {
    case SceneConstraintType::kPoint:
      return DistanceToPoint{deed.distance_m, glm::dvec3(0.0)};
    case SceneConstraintType::kInside:
      return AllowedSpace{-0.5 * deed.size_m, 0.5 * deed.size_m};
    case SceneConstraintType::kOutside:
      return ForbiddenSpace{-0.5 * deed.size_m, 0.5 * deed.size_m};
    case SceneConstraintType::kOriented:
      return SegmentOrientation{
          deed.world_from_t_pose.value_or(glm::dquat(1.0, 0.0, 0.0, 0.0))};
  }
  return DistanceToPoint{};
}

void set_parameter(ThrowParameter parameter, double value, engine::ThrowChanges& out) {
  switch (parameter) {
    case ThrowParameter::kCaptured:
      return;
    case ThrowParameter::kPlaceLeft:
      out.x_m = value;
      return;
    case ThrowParameter::kPlaceUp:
      out.y_m = value;
      return;
    case ThrowParameter::kPlaceForward:
      out.z_m = value;
      return;
    case ThrowParameter::kAzimuth:
      out.azimuth_rad = kDegree_rad * value;
      return;
    case ThrowParameter::kElevation:
      out.elevation_rad = kDegree_rad * value;
      return;
    case ThrowParameter::kSpeed:
      out.speed_m_s = value;
      return;
    case ThrowParameter::kRelease:
      out.release_s = value;
      return;
  }
}

Status check_clip_name(const Scene& scene,
                       const SceneAction& action,
                       const std::string& clip,
                       const engine::MotionBase& base) {
  if (clip.empty() || base.find(clip)) return Done{};
  std::vector<std::string_view> names;
  for (const MotionClip& known : base.clips()) names.push_back(known.name);
  const auto nearest = meant_word(clip, names);
  return bad_input(place_of(scene, action),
                   "the base has no clip \"" + clip + "\"",
                   nearest ? "did you mean \"" + std::string(*nearest) + "\"?"
                           : "see the clips with marey base list " + scene.base);
}

}  // namespace

const std::string& clip_of(const SceneAction& action) {
  return std::visit(
      [](const auto& deed) -> const std::string& {
        using Deed = std::decay_t<decltype(deed)>;
        if constexpr (std::is_same_v<Deed, ScenePlay> ||
                      std::is_same_v<Deed, SceneReach> ||
                      std::is_same_v<Deed, SceneThrow> ||
                      std::is_same_v<Deed, SceneSteer> ||
                      std::is_same_v<Deed, SceneJump>) {
          return deed.clip;
        } else {
          return kNoText;
        }
      },
      action.deed);
}

std::string place_of(const Scene& scene, const SceneAction& action) {
  std::string out = "scene \"" + scene.name + "\"";
  if (action.line > 0) out += ", line " + std::to_string(action.line);
  if (!action.id.empty()) out += " (\"" + action.id + "\")";
  return out;
}

std::optional<double> event_s(const MotionClip& clip, std::string_view event) {
  const auto found = std::find_if(clip.notes.begin(),
                                  clip.notes.end(),
                                  [&](const Annotation& n) { return n.text == event; });
  if (found == clip.notes.end()) return std::nullopt;
  return found->start_s;
}

engine::ActionWish action_wish(const SceneAction& action) {
  engine::ActionWish wish;
  wish.clip = clip_of(action);
  for (std::size_t g = 0; g < kEditGroups.size(); ++g) {
    wish.priority[g] =
        static_cast<float>(action.group_priority[g].value_or(action.priority));
  }
  wish.layer = action.layer;
  if (action.fade_in_s) wish.fade_in_s = *action.fade_in_s;
  if (action.fade_out_s) wish.fade_out_s = *action.fade_out_s;
  return wish;
}

engine::ActionWish play_wish(const SceneAction& action, const ScenePlay& play) {
  engine::ActionWish wish = action_wish(action);
  wish.rate = play.rate;
  wish.loops = play.loops || play.cycles.value_or(1) > 1;
  if (play.from_s > 0.0) {
    wish.entry_s = play.from_s;
    wish.entry_search_s = 0.0;
  }
  switch (play.transition) {
    case SceneTransition::kAuto:
      break;
    case SceneTransition::kCrossfade:
      wish.transition = engine::TransitionKind::kCrossfade;
      break;
    case SceneTransition::kInertial:
    case SceneTransition::kExtrapolate:
      wish.transition = engine::TransitionKind::kInertial;
      break;
  }
  return wish;
}

engine::ReachWish reach_wish(const SceneAction& action,
                             const SceneReach& reach,
                             double event_s) {
  engine::ReachWish wish;
  wish.action = action_wish(action);
  // The arrival counts from the clip's start.
  wish.action.entry_search_s = 0.0;
  if (reach.arrive_s && *reach.arrive_s > 0.0) {
    wish.action.rate = std::clamp(event_s / *reach.arrive_s, 0.25, 4.0);
  }
  wish.side = reach.hand == SceneHand::kLeft ? 0 : 1;
  wish.target.approach = reach.approach_in_world;
  if (reach.approach_in_world || reach.arrival_speed_m_s > 0.0) {
    wish.target.speed_m_s = reach.arrival_speed_m_s;
  }
  wish.target.world_from_hand = reach.world_from_t_pose;
  wish.options.after =
      reach.holds ? engine::AfterArrival::kHold : engine::AfterArrival::kReturn;
  return wish;
}

engine::SteerWish steer_wish(const SceneAction& action, const SceneSteer& steer) {
  engine::SteerWish wish;
  wish.action = action_wish(action);
  wish.settings.max_turn_rad = steer.max_turn_rad;
  wish.settings.max_turn_rad_s = steer.max_turn_rad_s;
  wish.settings.min_scale = steer.step_length[0];
  wish.settings.max_scale = steer.step_length[1];
  return wish;
}

engine::ThrowWish throw_wish(const SceneAction& action,
                             const SceneThrow& deed,
                             const ThrowTrial* trial,
                             double gravity_m_s2) {
  engine::ThrowWish wish;
  wish.action = action_wish(action);
  wish.action.entry_search_s = 0.0;
  wish.side = deed.hand == SceneHand::kLeft ? 0 : 1;
  wish.asked = {deed.place_m[0],
                deed.place_m[1],
                deed.place_m[2],
                deed.azimuth_rad,
                deed.elevation_rad,
                deed.speed_m_s,
                deed.release_s};
  if (trial != nullptr) set_parameter(trial->parameter, trial->value, wish.asked);
  wish.ball.gravity_m_s2 = gravity_m_s2;
  wish.ball.drag_1_m = deed.drag_1_m;
  return wish;
}

engine::JumpWish jump_wish(const SceneAction& action, const SceneJump& jump) {
  engine::JumpWish wish;
  wish.action = action_wish(action);
  // The jump is planned from the first frame of its clip.
  wish.action.entry_search_s = 0.0;
  wish.changes.apex_m = jump.apex_m;
  wish.changes.apex_by_m = jump.apex_by_m;
  wish.changes.airtime_s = jump.airtime_s;
  wish.changes.length_m = jump.length_m;
  wish.changes.box_m = jump.box_m;
  return wish;
}

std::string constraint_id(std::size_t action) {
  return "script " + std::to_string(action);
}

std::string load_name(std::size_t action) {
  return "load " + std::to_string(action);
}

std::optional<Constraint> constraint_of(const SceneAction& action, std::size_t k) {
  Constraint out;
  out.id = constraint_id(k);
  out.activation.start_s = kNever_s;
  out.activation.start_duration_s = action.fade_in_s.value_or(kConstraintFade_s);
  out.activation.stop_duration_s = action.fade_out_s.value_or(kConstraintFade_s);
  if (const auto* deed = std::get_if<SceneConstrain>(&action.deed)) {
    out.point = deed->point;
    out.goal = goal_of(*deed);
    out.range = deed->range;
    out.importance = deed->importance;
    out.precision_m = deed->precision_m;
    return out;
  }
  if (const auto* deed = std::get_if<SceneFollow>(&action.deed)) {
    out.point = deed->point;
    out.goal = DistanceToPoint{};
    return out;
  }
  return std::nullopt;
}

Status check_action(const Scene& scene,
                    const SceneAction& action,
                    const StageBody& body,
                    const engine::MotionBase& base) {
  const std::string& clip = clip_of(action);
  if (const Status ok = check_clip_name(scene, action, clip, base); !ok) return ok;
  if (const auto* steer = std::get_if<SceneSteer>(&action.deed)) {
    const Status ok = check_clip_name(scene, action, steer->stop_clip, base);
    if (!ok) return ok;
  }
  if (!clip.empty() && is_empty_loop(action, base.clip(*base.find(clip)))) {
    return bad_input(place_of(scene, action),
                     "the clip \"" + clip + "\" is no loop, so it cannot repeat",
                     "play it once, or build the base with --loops " + clip);
  }
  const std::string& segment = segment_of(action);
  if (!segment.empty() && !joint_of_segment(body, segment)) {
    return bad_input(place_of(scene, action),
                     "the body \"" + body.id + "\" has no segment \"" + segment + "\"",
                     "name a bone as in VRM, or a joint of the body");
  }
  const char* event = std::holds_alternative<SceneReach>(action.deed)   ? "arrive"
                      : std::holds_alternative<SceneThrow>(action.deed) ? "release"
                                                                        : nullptr;
  if (event != nullptr && !event_s(base.clip(*base.find(clip)), event)) {
    return bad_input(place_of(scene, action),
                     "the clip \"" + clip + "\" has no event \"" + event + "\"",
                     "add it with the operation event of marey edit, and build the base");
  }
  if (const auto* reach = std::get_if<SceneReach>(&action.deed)) {
    if (reach->offset_in_t_pose != glm::dvec3(0.0)) {
      return bad_input(place_of(scene, action),
                       "a reach with offset_m is not supported: its palm arrives",
                       "leave offset_m out, or use \"constrain\"");
    }
  }
  return Done{};
}

}  // namespace marey::app
