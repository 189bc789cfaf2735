// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <variant>

#include <glm/geometric.hpp>

#include "app/stage/run/action_wishes.h"
#include "app/stage/run/script_player.h"

// Targets, events and results of the actions of a script while they play.

namespace marey::app {
namespace {

engine::CharacterId player_id(std::size_t body) {
  return engine::CharacterId{static_cast<int>(body)};
}

// Moves the goal of a constraint to its target.
void move_goal(const SceneConstrain& deed,
               const glm::dvec3& target,
               retarget::Adapter::Handle handle) {
  switch (deed.type) {
    case SceneConstraintType::kPoint:
      handle.set_target(target);
      return;
    case SceneConstraintType::kInside:
    case SceneConstraintType::kOutside:
      handle.set_space(target - 0.5 * deed.size_m, target + 0.5 * deed.size_m);
      return;
    case SceneConstraintType::kOriented:
      return;
  }
}

std::array<double, 7> values_of(const engine::ThrowParameters& p) {
  return {p.wrist_in_heading_m.x,
          p.wrist_in_heading_m.y,
          p.wrist_in_heading_m.z,
          p.azimuth_rad,
          p.elevation_rad,
          p.speed_m_s,
          p.release_s};
}

}  // namespace

void ScriptPlayer::steer_again(Instance& instance,
                               double step_s,
                               const glm::dvec3& target,
                               engine::Engine& engine) {
  const auto& deed = std::get<SceneSteer>(action_of(instance).deed);
  const engine::CharacterId who = player_id(instance.body);
  if (instance.id && engine.phase(who, *instance.id) != engine::ActionPhase::kDone) {
    (void)engine.aim(who, {target.x, target.z});
    return;
  }
  // It has arrived: another course if the target has moved since.
  const glm::dvec3 hips = engine.pose(who).root_in_world;
  const double away_m = glm::length(glm::dvec2(target.x - hips.x, target.z - hips.z));
  if (!deed.keeps || away_m <= deed.arrive_within_m) return;
  if (const auto id = request(instance, step_s, target, engine)) {
    instance.id = *id;
    instance.clip_s.reset();
  }
}

void ScriptPlayer::aim(std::size_t body,
                       double time_s,
                       double step_s,
                       const TargetPlaces& places,
                       engine::Engine& engine) {
  const engine::CharacterId who = player_id(body);
  for (Instance& instance : instances_) {
    if (instance.body != body || instance.phase != Phase::kActive || !instance.use) {
      continue;
    }
    const SceneAction& action = action_of(instance);
    const glm::dvec3 target = places.in_world(*instance.use, time_s, engine);
    const glm::dvec3 velocity_m_s =
        instance.has_target ? (target - instance.last_target) / step_s : glm::dvec3(0.0);
    if (const auto* deed = std::get_if<SceneConstrain>(&action.deed)) {
      move_goal(
          *deed, target, *engine.player(who).constraint(constraint_id(instance.action)));
    } else if (const auto* follow = std::get_if<SceneFollow>(&action.deed)) {
      if (!instance.follows) {
        const auto joint = joint_of_segment(bodies_[body], follow->point.segment);
        const glm::dvec3 start = point_in_world(bodies_[body],
                                                *joint,
                                                follow->point.offset_in_t_pose,
                                                engine.player(who).world_from_joint());
        engine::FollowSettings settings;
        settings.max_speed_m_s = follow->max_speed_m_s;
        instance.follows = bool(instance.follow.start(start, glm::dvec3(0.0), settings));
      }
      engine.player(who)
          .constraint(constraint_id(instance.action))
          ->set_target(instance.follow.step(target, step_s).p_in_world);
    } else if (const auto* reach = std::get_if<SceneReach>(&action.deed)) {
      const int side = reach->hand == SceneHand::kLeft ? 0 : 1;
      engine::ReachTarget moved = reach_wish(action, *reach, 1.0).target;
      moved.p_in_world = target;
      moved.velocity_m_s = velocity_m_s;
      // A newer reach of this hand has its own target.
      const engine::ReachPlayer* now = engine.player(who).reaching(side);
      if (now != nullptr && instance.id && now->action() == *instance.id) {
        (void)engine.aim(who, side, moved);
      }
    } else if (std::holds_alternative<SceneSteer>(action.deed)) {
      steer_again(instance, step_s, target, engine);
    } else if (const auto* thrown = std::get_if<SceneThrow>(&action.deed)) {
      const int side = thrown->hand == SceneHand::kLeft ? 0 : 1;
      const engine::ThrowPlayer* now = engine.player(who).throwing(side);
      if (now != nullptr && instance.id && now->action() == *instance.id) {
        (void)engine.aim_ball(who, side, target);
      }
    }
    instance.last_target = target;
    instance.has_target = true;
  }
}

void ScriptPlayer::note_events(Instance& instance,
                               double time_s,
                               const engine::Engine& engine) {
  const engine::BlendPlayer& blend = engine.player(player_id(instance.body)).blend();
  const engine::Action* action = blend.find(*instance.id);
  if (action == nullptr || !action->is_alive()) return;
  // A planned jump is a clip of this character alone.
  const MotionClip& clip = blend.base().clip(action->clip);
  const double now = action->warp.source_s(time_s);
  // An event at the entry counts, too.
  const double before =
      instance.clip_s.value_or(action->warp.source_s(time_s - engine.step_s()) - 1e-9);
  instance.clip_s = now;
  for (const Annotation& note : clip.notes) {
    double at = note.start_s;
    if (clip.loops) {
      const double cycle = clip.duration_s();
      at += std::ceil((before - at) / cycle) * cycle;
      if (at <= before) at += cycle;
    }
    if (at <= before || at > now) continue;
    // The instant within the step.
    const double share = (now - at) / (now - before);
    runs_[instance.run].events.push_back({note.text, time_s - share * engine.step_s()});
  }
}

void ScriptPlayer::note_throw(Instance& instance, const engine::Engine& engine) {
  const auto& deed = std::get<SceneThrow>(action_of(instance).deed);
  const int side = deed.hand == SceneHand::kLeft ? 0 : 1;
  const engine::ThrowPlayer* thrown =
      engine.player(player_id(instance.body)).throwing(side);
  if (instance.has_result || thrown == nullptr || !thrown->result()) return;
  if (!instance.id || thrown->action() != *instance.id) return;
  instance.has_result = true;
  StageThrow out;
  out.action = instance.action;
  out.body = instance.body;
  if (!instance.order.empty()) out.trial = instance.next_trial;
  out.asked = values_of(thrown->result()->wanted);
  out.measured = values_of(thrown->result()->measured);
  out.release_s = thrown->result()->ball.time_s;
  out.start_s = out.release_s - out.measured[6];
  throws_.push_back(out);
}

void ScriptPlayer::end_step(double time_s, const engine::Engine& engine) {
  for (Instance& instance : instances_) {
    if (instance.phase != Phase::kActive || !instance.id) continue;
    const SceneAction& action = action_of(instance);
    note_events(instance, time_s, engine);
    if (std::holds_alternative<SceneThrow>(action.deed)) note_throw(instance, engine);
    const auto phase = engine.phase(player_id(instance.body), *instance.id);
    const bool is_over =
        phase == engine::ActionPhase::kDone || phase == engine::ActionPhase::kFadingOut;
    const auto* steer = std::get_if<SceneSteer>(&action.deed);
    if (!is_over || (steer != nullptr && steer->keeps)) continue;
    if (instance.next_trial + 1 < instance.order.size()) continue;
    instance.phase = Phase::kEnded;
    runs_[instance.run].end_s = time_s;
  }
}

}  // namespace marey::app
