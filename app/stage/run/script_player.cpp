// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/script_player.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "app/stage/run/action_wishes.h"
#include "core/base/assert.h"

namespace marey::app {
namespace {

constexpr double kEver_s = std::numeric_limits<double>::infinity();

engine::CharacterId character(std::size_t body) {
  return engine::CharacterId{static_cast<int>(body)};
}

std::optional<std::size_t> target_place(const Scene& scene, const SceneAction& action) {
  const SceneTarget* target = scene.target(target_of(action));
  if (target == nullptr) return std::nullopt;
  return static_cast<std::size_t>(target - scene.targets.data());
}

// The end that the script gives an action which starts at `start_s`.
double stop_time_s(const SceneAction& action,
                   const engine::MotionBase& base,
                   double start_s) {
  if (action.for_s) return start_s + *action.for_s;
  const auto* play = std::get_if<ScenePlay>(&action.deed);
  if (play == nullptr || play->cycles.value_or(1) <= 1) return kEver_s;
  const double cycle_s = base.clip(*base.find(play->clip)).duration_s() / play->rate;
  return start_s + *play->cycles * cycle_s;
}

}  // namespace

Result<ScriptPlayer> ScriptPlayer::make(const Scene& scene,
                                        std::span<const StageBody> bodies,
                                        const engine::MotionBase& base,
                                        const std::map<std::string, TrialList>& trials) {
  ScriptPlayer out(scene, bodies, base);
  for (std::size_t k = 0; k < scene.script.size(); ++k) {
    const SceneAction& action = scene.script[k];
    const auto members = members_of(scene, action.body);
    MAREY_ASSERT(members.has_value());
    for (std::size_t i = 0; i < members->count; ++i) {
      const Status ok = check_action(scene, action, bodies[members->first + i], base);
      if (!ok) return ok.error();
    }
    const auto* deed = std::get_if<SceneThrow>(&action.deed);
    if (deed != nullptr && !deed->trials.empty() && !trials.contains(deed->trials)) {
      return bad_input(place_of(scene, action),
                       "the trials \"" + deed->trials + "\" were not read",
                       "read them with read_trials()");
    }
    out.add_instances(k, trials);
  }
  out.link_waiting();
  return out;
}

void ScriptPlayer::add_instances(std::size_t action,
                                 const std::map<std::string, TrialList>& trials) {
  const SceneAction& line = scene_->script[action];
  const auto members = members_of(*scene_, line.body);
  for (std::size_t i = 0; i < members->count; ++i) {
    Instance instance;
    instance.action = action;
    instance.body = members->first + i;
    if (const auto target = target_place(*scene_, line)) {
      instance.use = TargetUse{*target, instance.body, i};
    }
    if (const auto* deed = std::get_if<SceneThrow>(&line.deed)) {
      if (const auto list = trials.find(deed->trials); list != trials.end()) {
        instance.order = trial_order(list->second);
        trials_.insert(*list);
      }
    }
    instances_.push_back(std::move(instance));
  }
}

void ScriptPlayer::link_waiting() {
  for (Instance& instance : instances_) {
    const std::string& after = action_of(instance).after;
    if (after.empty()) continue;
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      if (instances_[i].body == instance.body && action_of(instances_[i]).id == after) {
        instance.after = i;
      }
    }
  }
}

bool ScriptPlayer::may_start(const Instance& instance, double time_s) const {
  const SceneAction& action = action_of(instance);
  if (time_s < action.time_s) return false;
  if (!instance.after) return action.after.empty();
  const Instance& before = instances_[*instance.after];
  if (action.event.empty()) return before.phase == Phase::kEnded;
  if (before.phase == Phase::kWaiting) return false;
  const auto& events = runs_[before.run].events;
  return std::any_of(events.begin(), events.end(), [&](const StageEvent& e) {
    return e.name == action.event;
  });
}

Result<std::optional<engine::ActionId>> ScriptPlayer::request_throw(
    Instance& instance, const glm::dvec3& target, engine::Engine& engine) {
  const SceneAction& action = action_of(instance);
  const auto& deed = std::get<SceneThrow>(action.deed);
  const ThrowTrial* trial = nullptr;
  if (instance.next_trial < instance.order.size()) {
    const TrialList& list = trials_.at(deed.trials);
    trial = &list.trials[instance.order[instance.next_trial].trial];
  }
  engine::ThrowWish wish = throw_wish(action, deed, trial, scene_->gravity_m_s2);
  if (!deed.aim.empty()) wish.aim_in_world = target;
  auto id = engine.play(character(instance.body), wish);
  if (!id) return id.error();
  instance.has_result = false;
  return std::optional(*id);
}

Result<std::optional<engine::ActionId>> ScriptPlayer::request(Instance& instance,
                                                              double step_s,
                                                              const glm::dvec3& target,
                                                              engine::Engine& engine) {
  const SceneAction& action = action_of(instance);
  const engine::CharacterId who = character(instance.body);
  Result<engine::ActionId> id = engine::ActionId{};
  if (const auto* play = std::get_if<ScenePlay>(&action.deed)) {
    id = engine.play(who, play_wish(action, *play));
  } else if (const auto* reach = std::get_if<SceneReach>(&action.deed)) {
    const double arrive_s = *event_s(base_->clip(*base_->find(reach->clip)), "arrive");
    engine::ReachWish wish = reach_wish(action, *reach, arrive_s);
    wish.target.p_in_world = target;
    id = engine.play(who, wish);
  } else if (const auto* steer = std::get_if<SceneSteer>(&action.deed)) {
    engine::SteerWish wish = steer_wish(action, *steer);
    wish.goal_xz_m = {target.x, target.z};
    id = engine.play(who, wish);
  } else if (const auto* jump = std::get_if<SceneJump>(&action.deed)) {
    engine::JumpWish wish = jump_wish(action, *jump);
    if (!jump->target.empty()) wish.landing_in_world = target;
    id = engine.play(who, wish);
  } else if (std::holds_alternative<SceneThrow>(action.deed)) {
    return request_throw(instance, target, engine);
  } else if (std::holds_alternative<SceneCarry>(action.deed)) {
    (void)engine.player(who).carry(load_name(instance.action), true);
    return std::optional<engine::ActionId>();
  } else {
    const auto handle = engine.player(who).constraint(constraint_id(instance.action));
    MAREY_ASSERT(handle.has_value());
    auto constraint = *handle;
    constraint.start(engine.time_s() + step_s);
    return std::optional<engine::ActionId>();
  }
  if (!id) return id.error();
  return std::optional(*id);
}

void ScriptPlayer::start(Instance& instance,
                         double time_s,
                         double step_s,
                         const TargetPlaces& places,
                         engine::Engine& engine) {
  const SceneAction& action = action_of(instance);
  instance.phase = Phase::kActive;
  instance.start_s = time_s;
  instance.stop_s = stop_time_s(action, *base_, time_s);
  instance.run = runs_.size();
  runs_.push_back({instance.action, instance.body, time_s, kEver_s, {}});
  if (std::holds_alternative<SceneStop>(action.deed)) {
    stop_others(instance, time_s, engine);
    end(instance, time_s, engine);
    return;
  }
  const glm::dvec3 target =
      instance.use ? places.in_world(*instance.use, time_s, engine) : glm::dvec3(0.0);
  instance.last_target = target;
  const auto id = request(instance, step_s, target, engine);
  if (!id) {
    Error error = id.error();
    error.where = place_of(*scene_, action) + ", body \"" + bodies_[instance.body].id +
                  "\": " + error.where;
    problems_.push_back(std::move(error));
    instance.phase = Phase::kEnded;
    runs_[instance.run].end_s = time_s;
    return;
  }
  instance.id = *id;
}

void ScriptPlayer::end(Instance& instance, double time_s, engine::Engine& engine) {
  if (instance.phase != Phase::kActive) return;
  const SceneAction& action = action_of(instance);
  instance.phase = Phase::kEnded;
  runs_[instance.run].end_s = time_s;
  if (instance.id) {
    (void)engine.stop(character(instance.body), *instance.id);
  } else if (std::holds_alternative<SceneCarry>(action.deed)) {
    (void)engine.player(character(instance.body))
        .carry(load_name(instance.action), false);
  } else if (!std::holds_alternative<SceneStop>(action.deed)) {
    auto handle = engine.player(character(instance.body))
                      .constraint(constraint_id(instance.action));
    if (handle) handle->stop(time_s);
  }
}

void ScriptPlayer::stop_others(const Instance& by,
                               double time_s,
                               engine::Engine& engine) {
  const auto& deed = std::get<SceneStop>(action_of(by).deed);
  for (Instance& other : instances_) {
    if (&other == &by || other.body != by.body) continue;
    const SceneAction& action = action_of(other);
    if (!deed.action.empty() && action.id != deed.action) continue;
    if (deed.action.empty() && deed.layer && action.layer != *deed.layer) continue;
    end(other, time_s, engine);
  }
}

void ScriptPlayer::begin_step(double time_s,
                              double step_s,
                              const TargetPlaces& places,
                              engine::Engine& engine) {
  for (Instance& instance : instances_) {
    if (instance.phase == Phase::kActive && time_s >= instance.stop_s) {
      end(instance, time_s, engine);
    }
  }
  // In the order of the file: an action that waits for one above it starts at once.
  for (Instance& instance : instances_) {
    if (instance.phase == Phase::kWaiting && may_start(instance, time_s)) {
      start(instance, time_s, step_s, places, engine);
    } else if (instance.phase == Phase::kActive && !instance.order.empty()) {
      throw_again(instance, time_s, step_s, places, engine);
    }
  }
}

void ScriptPlayer::throw_again(Instance& instance,
                               double time_s,
                               double step_s,
                               const TargetPlaces& places,
                               engine::Engine& engine) {
  const auto& deed = std::get<SceneThrow>(action_of(instance).deed);
  const double next_s =
      instance.start_s + static_cast<double>(instance.next_trial + 1) * deed.every_s;
  if (time_s < next_s || instance.next_trial + 1 >= instance.order.size()) return;
  ++instance.next_trial;
  const glm::dvec3 target =
      instance.use ? places.in_world(*instance.use, time_s, engine) : glm::dvec3(0.0);
  const auto id = request(instance, step_s, target, engine);
  if (id) {
    instance.id = *id;
    instance.clip_s.reset();
  } else {
    problems_.push_back(id.error());
  }
}

}  // namespace marey::app
