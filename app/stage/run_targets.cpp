// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run_targets.h"

#include <cmath>
#include <string>
#include <variant>

#include <glm/gtc/quaternion.hpp>

#include "core/engine/scene_order.h"

namespace marey::app {
namespace {

engine::CharacterId character(std::size_t body) {
  return engine::CharacterId{static_cast<int>(body)};
}

std::optional<std::size_t> target_at(const Scene& scene, const std::string& id) {
  for (std::size_t i = 0; i < scene.targets.size(); ++i) {
    if (scene.targets[i].id == id) return i;
  }
  return std::nullopt;
}

}  // namespace

glm::dvec3 path_for(const SceneTarget& target, const StageBody& user, double time_s) {
  const glm::dvec3 p = path_at(target.path, time_s).value_or(glm::dvec3(0.0));
  if (target.frame == TargetFrame::kWorld) return p;
  const double scale =
      target.for_stature_m ? user.stature_m / *target.for_stature_m : 1.0;
  const double sine = std::sin(user.start.heading_rad);
  const double cosine = std::cos(user.start.heading_rad);
  return {user.start.x_m + scale * (cosine * p.x + sine * p.z),
          scale * p.y,
          user.start.z_m + scale * (cosine * p.z - sine * p.x)};
}

Result<TargetUse> RunTargets::make_use(const Scene& scene,
                                       std::span<const StageBody> bodies,
                                       std::size_t target,
                                       std::size_t body,
                                       std::size_t member) {
  TargetUse use;
  use.target = target;
  use.body = body;
  const SceneTarget& wanted = scene.targets[target];
  const auto* of_body = std::get_if<BodyPointPath>(&wanted.path);
  if (of_body == nullptr) {
    use.p_in_world = path_for(wanted, bodies[body], 0.0);
    return use;
  }
  const auto partners = members_of(scene, of_body->body);
  if (!partners) {
    return bad_input("target \"" + wanted.id + "\"",
                     "there is no body \"" + of_body->body + "\"",
                     "name a body of the scene");
  }
  use.partner = partners->partner(member);
  use.last_step = of_body->last_step;
  const StageBody& partner = bodies[*use.partner];
  const auto point =
      point_of_body(partner.character.skeleton, partner.map, of_body->point);
  if (!point) {
    return bad_input("target \"" + wanted.id + "\"",
                     "the body \"" + partner.id + "\" has no segment \"" +
                         of_body->point.segment + "\"",
                     "see its joints with marey inspect");
  }
  use.point = *point;
  Pose rest = rest_pose(partner.character.skeleton);
  const glm::dquat turn =
      glm::angleAxis(partner.start.heading_rad, glm::dvec3(0.0, 1.0, 0.0));
  rest.root_in_world =
      turn * rest.root_in_world + glm::dvec3(partner.start.x_m, 0.0, partner.start.z_m);
  rest.parent_from_joint[0] = turn * rest.parent_from_joint[0];
  use.p_in_world =
      use.point.in_world(world_from_joints(partner.character.skeleton, rest));
  return use;
}

Status RunTargets::add(const Scene& scene,
                       std::span<const StageBody> bodies,
                       const std::string& target,
                       const std::string& body,
                       bool by_action) {
  const auto position = target_at(scene, target);
  const auto members = members_of(scene, body);
  if (target.empty() || !position || !members) return Done{};
  for (std::size_t k = 0; k < members->count; ++k) {
    const std::pair key{*position, members->first + k};
    auto known = by_pair_.find(key);
    if (known == by_pair_.end()) {
      // A member that is named alone has its partner by its number in the group.
      auto use = make_use(scene, bodies, key.first, key.second, k);
      if (!use) return use.error();
      known = by_pair_.emplace(key, uses_.size()).first;
      uses_of_body_[key.second].push_back(uses_.size());
      uses_.push_back(*std::move(use));
    }
    TargetUse& use = uses_[known->second];
    use.by_action = use.by_action || by_action;
  }
  return Done{};
}

Result<RunTargets> RunTargets::make(const Scene& scene,
                                    std::span<const StageBody> bodies) {
  RunTargets out;
  out.uses_of_body_.resize(bodies.size());
  for (const SceneAction& action : scene.script) {
    const Status ok = out.add(scene, bodies, target_of(action), action.body, true);
    if (!ok) return ok.error();
  }
  for (const SceneFigure& figure : scene.figures) {
    for (const std::string& body : figure.bodies) {
      const Status ok = out.add(scene, bodies, figure.target, body, false);
      if (!ok) return ok.error();
    }
  }
  out.held_.resize(out.uses_.size());
  return out;
}

std::optional<std::size_t> RunTargets::find(std::size_t target, std::size_t body) const {
  const auto found = by_pair_.find({target, body});
  if (found == by_pair_.end()) return std::nullopt;
  return found->second;
}

void RunTargets::begin_step(const Scene& scene,
                            std::span<const StageBody> bodies,
                            const engine::Engine& engine,
                            double time_s) {
  const bool is_first = time_s < 1.5 * engine.step_s();
  for (std::size_t i = 0; i < uses_.size(); ++i) {
    TargetUse& use = uses_[i];
    if (held_[i]) {
      use.p_in_world = *held_[i];
    } else if (!use.partner) {
      use.p_in_world = path_for(scene.targets[use.target], bodies[use.body], time_s);
    } else if (use.last_step && !is_first) {
      use.p_in_world =
          use.point.in_world(engine.player(character(*use.partner)).world_from_joint());
    }
  }
}

void RunTargets::solve_before(std::size_t body, const engine::Engine& engine) {
  for (const std::size_t i : uses_of_body_[body]) {
    TargetUse& use = uses_[i];
    if (held_[i] || !use.partner || use.last_step || !use.by_action) continue;
    use.p_in_world =
        use.point.in_world(engine.player(character(*use.partner)).world_from_joint());
  }
}

void RunTargets::end_step(const engine::Engine& engine) {
  for (std::size_t i = 0; i < uses_.size(); ++i) {
    TargetUse& use = uses_[i];
    if (held_[i] || !use.partner || use.last_step) continue;
    use.p_in_world =
        use.point.in_world(engine.player(character(*use.partner)).world_from_joint());
  }
}

void RunTargets::hold(std::size_t target,
                      const std::optional<glm::dvec3>& p_in_world,
                      std::optional<std::size_t> user) {
  for (std::size_t i = 0; i < uses_.size(); ++i) {
    if (uses_[i].target == target && (!user || uses_[i].body == *user)) {
      held_[i] = p_in_world;
    }
  }
}

}  // namespace marey::app
