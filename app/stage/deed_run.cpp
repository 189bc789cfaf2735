// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/deed_run.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <glm/geometric.hpp>

#include "app/stage/deed_wish.h"
#include "app/stage/stage_bodies.h"
#include "core/nearest_word.h"

namespace marey::app {
namespace {

constexpr double kNever_s = 1e9;      // Constraints are started by their actions.
constexpr double kGoalMoved_m = 0.1;  // A steer that keeps on begins again after this.
constexpr double kJump_m = 0.5;       // A target that moves so far in a step has jumped.

engine::CharacterId character(const DeedRun& run) {
  return engine::CharacterId{static_cast<int>(run.body)};
}

std::string place_of(const SceneAction& action) {
  const std::string deed(kSceneDeeds[action.deed.index()]);
  return action.id.empty() ? "line " + std::to_string(action.line) + ", action " + deed
                           : "action \"" + action.id + "\"";
}

Error of_action(Error error, const SceneAction& action) {
  error.where = place_of(action) + " of \"" + action.body + "\": " + error.where;
  return error;
}

Goal goal_of(const SceneConstrain& wanted) {
  switch (wanted.type) {
    case SceneConstraintType::kInside:
      return AllowedSpace{-0.5 * wanted.size_m, 0.5 * wanted.size_m};
    case SceneConstraintType::kOutside:
      return ForbiddenSpace{-0.5 * wanted.size_m, 0.5 * wanted.size_m};
    case SceneConstraintType::kOriented:
      return SegmentOrientation{
          wanted.world_from_t_pose.value_or(glm::dquat(1.0, 0.0, 0.0, 0.0))};
    case SceneConstraintType::kPoint:
      break;
  }
  return DistanceToPoint{wanted.distance_m, glm::dvec3(0.0)};
}

Status check_clip(const SceneAction& action,
                  const std::string& clip,
                  const engine::MotionBase& base) {
  if (base.find(clip)) return Done{};
  std::vector<std::string_view> names;
  for (const MotionClip& known : base.clips()) names.push_back(known.name);
  const auto nearest = meant_word(clip, names);
  return bad_input(place_of(action),
                   "the base has no clip \"" + clip + "\"",
                   nearest ? "did you mean \"" + std::string(*nearest) + "\"?"
                           : "see the clips with marey base list");
}

Status forget(const Result<engine::ActionId>& played) {
  if (!played) return played.error();
  return Done{};
}

}  // namespace

std::string deed_constraint_id(std::size_t action) {
  return "action " + std::to_string(action + 1);
}

const std::string* clip_of(const SceneAction& action) {
  return std::visit(
      [](const auto& deed) -> const std::string* {
        if constexpr (requires { deed.clip; }) {
          return &deed.clip;
        } else {
          return nullptr;
        }
      },
      action.deed);
}

std::optional<Constraint> deed_constraint(const SceneAction& action,
                                          std::size_t position) {
  Constraint out;
  out.id = deed_constraint_id(position);
  if (const auto* wanted = std::get_if<SceneConstrain>(&action.deed)) {
    out.point = wanted->point;
    out.goal = goal_of(*wanted);
    out.range = wanted->range;
    out.importance = wanted->importance;
    out.precision_m = wanted->precision_m;
  } else if (const auto* follow = std::get_if<SceneFollow>(&action.deed)) {
    out.point = follow->point;
    out.goal = DistanceToPoint{};
  } else {
    return std::nullopt;
  }
  out.activation.start_s = kNever_s;
  out.activation.start_duration_s = action.fade_in_s.value_or(kDeedFade_s);
  out.activation.stop_duration_s = action.fade_out_s.value_or(kDeedFade_s);
  return out;
}

Status check_deed(const SceneAction& action,
                  engine::CharacterId body,
                  engine::Engine& engine) {
  const engine::MotionBase& base = engine.base();
  if (const std::string* clip = clip_of(action)) {
    if (const Status ok = check_clip(action, *clip, base); !ok) return ok;
  }
  const auto of_this = [&](const auto& asked) -> Status {
    if (asked) return Done{};
    return of_action(asked.error(), action);
  };
  if (std::holds_alternative<SceneJump>(action.deed)) {
    return bad_input(place_of(action),
                     "scenes do not play jumps yet",
                     "change the jump with marey jump and play the result");
  }
  if (std::holds_alternative<SceneReach>(action.deed)) {
    return of_this(engine.ask(body, reach_wish(action, glm::dvec3(0.0, 1.0, 0.5), base)));
  }
  if (const auto* thrown = std::get_if<SceneThrow>(&action.deed)) {
    std::optional<glm::dvec3> aim;
    if (!thrown->aim.empty()) aim = glm::dvec3(0.0, 1.0, 5.0);
    return of_this(engine.ask(body, throw_wish(Scene{}, action, std::nullopt, aim)));
  }
  if (const auto* steer = std::get_if<SceneSteer>(&action.deed)) {
    if (!steer->stop_clip.empty()) {
      if (const Status ok = check_clip(action, steer->stop_clip, base); !ok) return ok;
    }
    const auto made = engine::SteerPlayer::make(base,
                                                engine::ActionId{},
                                                *base.find(steer->clip),
                                                steer_wish(action, glm::dvec3(0.0)));
    return of_this(made);
  }
  return Done{};
}

Status start_deed(const Scene& scene,
                  DeedRun& run,
                  const glm::dvec3& target_in_world,
                  engine::Engine& engine) {
  const SceneAction& action = scene.script[run.action];
  const engine::CharacterId who = character(run);
  Result<engine::ActionId> played = engine::ActionId{};
  if (std::holds_alternative<ScenePlay>(action.deed)) {
    played = engine.play(who, play_wish(action));
  } else if (std::holds_alternative<SceneReach>(action.deed)) {
    played = engine.play(who, reach_wish(action, target_in_world, engine.base()));
  } else if (const auto* thrown = std::get_if<SceneThrow>(&action.deed)) {
    std::optional<glm::dvec3> aim;
    if (!thrown->aim.empty()) aim = target_in_world;
    played = engine.play(who, throw_wish(scene, action, run.changes, aim));
  } else if (std::holds_alternative<SceneSteer>(action.deed)) {
    played = engine.play(who, steer_wish(action, target_in_world));
  } else if (std::holds_alternative<SceneCarry>(action.deed)) {
    engine.player(who).carry(carry_load_name(run.action), true);
    return Done{};
  } else if (run.handle) {
    run.handle->start(engine.time_s());
    return Done{};
  } else {
    return Done{};
  }
  if (!played) return of_action(played.error(), action);
  run.played = *played;
  return forget(played);
}

namespace {

void aim_constraint(const SceneAction& action,
                    DeedRun& run,
                    const glm::dvec3& p,
                    double step_s) {
  if (const auto* follow = std::get_if<SceneFollow>(&action.deed)) {
    const glm::dvec3 way = p - run.follows_at;
    const double length_m = glm::length(way);
    const double most_m = follow->max_speed_m_s * step_s;
    const bool is_near = run.is_first_step || length_m <= most_m;
    run.follows_at = is_near ? p : run.follows_at + way * (most_m / length_m);
    run.handle->set_target(run.follows_at);
    return;
  }
  const auto& wanted = std::get<SceneConstrain>(action.deed);
  if (wanted.type == SceneConstraintType::kPoint) {
    run.handle->set_target(p);
  } else if (wanted.type != SceneConstraintType::kOriented) {
    run.handle->set_space(p - 0.5 * wanted.size_m, p + 0.5 * wanted.size_m);
  }
}

void aim_steer(const SceneAction& action,
               DeedRun& run,
               const glm::dvec3& p,
               engine::Engine& engine) {
  const bool has_moved = !run.last_target || glm::distance(p, *run.last_target) > 0.0;
  if (!run.has_arrived) {
    if (has_moved) static_cast<void>(engine.aim(character(run), {p.x, p.z}));
    return;
  }
  if (glm::distance(p, *run.last_target) < kGoalMoved_m) return;
  if (const auto again = engine.play(character(run), steer_wish(action, p))) {
    run.played = *again;
    run.has_arrived = false;
  }
}

}  // namespace

void aim_deed(const Scene& scene,
              DeedRun& run,
              const glm::dvec3& target_in_world,
              engine::Engine& engine) {
  const SceneAction& action = scene.script[run.action];
  const glm::dvec3& p = target_in_world;
  if (run.handle) {
    aim_constraint(action, run, p, engine.step_s());
  } else if (const auto* reach = std::get_if<SceneReach>(&action.deed)) {
    glm::dvec3 velocity_m_s(0.0);
    if (run.last_target && glm::distance(p, *run.last_target) < kJump_m) {
      velocity_m_s = (p - *run.last_target) / engine.step_s();
    }
    static_cast<void>(engine.aim(character(run),
                                 static_cast<int>(reach->hand),
                                 reach_target(*reach, p, velocity_m_s)));
  } else if (const auto* thrown = std::get_if<SceneThrow>(&action.deed)) {
    if (!thrown->aim.empty()) {
      static_cast<void>(
          engine.aim_ball(character(run), static_cast<int>(thrown->hand), p));
    }
  } else if (std::holds_alternative<SceneSteer>(action.deed)) {
    aim_steer(action, run, p, engine);
    if (run.has_arrived) return;  // last_target is the goal of the arrival.
  }
  run.last_target = p;
}

void stop_deed(const Scene& scene, DeedRun& run, engine::Engine& engine) {
  if (run.handle) run.handle->stop(engine.time_s());
  if (std::holds_alternative<SceneCarry>(scene.script[run.action].deed)) {
    engine.player(character(run)).carry(carry_load_name(run.action), false);
  }
  if (run.played) static_cast<void>(engine.stop(character(run), *run.played));
}

}  // namespace marey::app
