// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/deed_wish.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include "core/edit/body_group.h"

namespace marey::app {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;

engine::TransitionKind transition_of(SceneTransition transition) {
  switch (transition) {
    case SceneTransition::kCrossfade:
      return engine::TransitionKind::kCrossfade;
    case SceneTransition::kInertial:
    case SceneTransition::kExtrapolate:
      return engine::TransitionKind::kInertial;
    case SceneTransition::kAuto:
      break;
  }
  return engine::TransitionKind::kAuto;
}

/// Priorities, layer and fades of any action.
engine::ActionWish wish_of(const SceneAction& action, const std::string& clip) {
  engine::ActionWish wish;
  wish.clip = clip;
  for (std::size_t g = 0; g < kEditGroups.size(); ++g) {
    wish.priority[g] =
        static_cast<float>(action.group_priority[g].value_or(action.priority));
  }
  wish.layer = kIdleLayer + 1 + action.layer;
  wish.fade_in_s = action.fade_in_s.value_or(kDeedFade_s);
  wish.fade_out_s = action.fade_out_s.value_or(kDeedFade_s);
  wish.loops = false;
  return wish;
}

void set_trial(const ThrowTrial& trial, engine::ThrowChanges& asked) {
  switch (trial.parameter) {
    case ThrowParameter::kCaptured:
      return;
    case ThrowParameter::kPlaceLeft:
      asked.x_m = trial.value;
      return;
    case ThrowParameter::kPlaceUp:
      asked.y_m = trial.value;
      return;
    case ThrowParameter::kPlaceForward:
      asked.z_m = trial.value;
      return;
    case ThrowParameter::kAzimuth:
      asked.azimuth_rad = trial.value * kRad;
      return;
    case ThrowParameter::kElevation:
      asked.elevation_rad = trial.value * kRad;
      return;
    case ThrowParameter::kSpeed:
      asked.speed_m_s = trial.value;
      return;
    case ThrowParameter::kRelease:
      asked.release_s = trial.value;
      return;
  }
}

}  // namespace

std::optional<double> event_of(const engine::MotionBase& base,
                               const std::string& clip,
                               const std::string& event) {
  const auto found = base.find(clip);
  if (!found) return std::nullopt;
  for (const Annotation& note : base.clip(*found).notes) {
    if (note.text == event) return note.start_s;
  }
  return std::nullopt;
}

engine::ActionWish play_wish(const SceneAction& action) {
  const auto& play = std::get<ScenePlay>(action.deed);
  engine::ActionWish wish = wish_of(action, play.clip);
  wish.loops = play.loops || play.cycles.value_or(1) > 1;
  wish.rate = play.rate;
  wish.transition = transition_of(play.transition);
  if (play.from_s > 0.0) {
    wish.entry_s = play.from_s;
    wish.entry_search_s = 0.0;
  }
  return wish;
}

engine::ReachTarget reach_target(const SceneReach& reach,
                                 const glm::dvec3& p_in_world,
                                 const glm::dvec3& velocity_m_s) {
  engine::ReachTarget target;
  target.p_in_world = p_in_world;
  target.velocity_m_s = velocity_m_s;
  target.approach = reach.approach_in_world;
  target.speed_m_s = reach.arrival_speed_m_s;
  target.world_from_hand = reach.world_from_t_pose;
  return target;
}

engine::ReachWish reach_wish(const SceneAction& action,
                             const glm::dvec3& target_in_world,
                             const engine::MotionBase& base) {
  const auto& reach = std::get<SceneReach>(action.deed);
  engine::ReachWish wish;
  wish.action = wish_of(action, reach.clip);
  wish.side = static_cast<int>(reach.hand);
  wish.target = reach_target(reach, target_in_world, glm::dvec3(0.0));
  wish.options.after =
      reach.holds ? engine::AfterArrival::kHold : engine::AfterArrival::kReturn;
  const auto arrives_s = event_of(base, reach.clip, wish.arrive);
  if (reach.arrive_s && arrives_s && *reach.arrive_s > 0.0) {
    wish.action.rate = *arrives_s / *reach.arrive_s;
    wish.action.entry_s = 0.0;
    wish.action.entry_search_s = 0.0;
  }
  return wish;
}

engine::ThrowWish throw_wish(const Scene& scene,
                             const SceneAction& action,
                             const std::optional<ThrowTrial>& trial,
                             const std::optional<glm::dvec3>& aim) {
  const auto& thrown = std::get<SceneThrow>(action.deed);
  engine::ThrowWish wish;
  wish.action = wish_of(action, thrown.clip);
  wish.action.entry_s = 0.0;
  wish.action.entry_search_s = 0.0;
  wish.side = static_cast<int>(thrown.hand);
  wish.asked = {thrown.place_m[0],
                thrown.place_m[1],
                thrown.place_m[2],
                thrown.azimuth_rad,
                thrown.elevation_rad,
                thrown.speed_m_s,
                thrown.release_s};
  if (trial) set_trial(*trial, wish.asked);
  wish.aim_in_world = aim;
  wish.ball.gravity_m_s2 = scene.gravity_m_s2;
  wish.ball.drag_1_m = thrown.drag_1_m;
  return wish;
}

engine::SteerWish steer_wish(const SceneAction& action,
                             const glm::dvec3& target_in_world) {
  const auto& steer = std::get<SceneSteer>(action.deed);
  engine::SteerWish wish;
  wish.action = wish_of(action, steer.clip);
  wish.action.loops.reset();
  wish.goal_xz_m = {target_in_world.x, target_in_world.z};
  wish.settings.max_turn_rad = steer.max_turn_rad;
  wish.settings.max_turn_rad_s = steer.max_turn_rad_s;
  wish.settings.min_scale = steer.step_length[0];
  wish.settings.max_scale = steer.step_length[1];
  return wish;
}

}  // namespace marey::app
