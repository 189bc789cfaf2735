// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/stage_targets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

/// Returns the bodies of all actions that use the target, ascending.
std::vector<std::size_t> users_of(const Scene& scene, const SceneTarget& target) {
  std::vector<std::size_t> users;
  for (const SceneAction& action : scene.script) {
    if (target_of(action) != target.id) continue;
    const auto members = members_of(scene, action.body);
    for (std::size_t k = 0; members && k < members->count; ++k) {
      users.push_back(members->first + k);
    }
  }
  std::sort(users.begin(), users.end());
  users.erase(std::unique(users.begin(), users.end()), users.end());
  return users;
}

/// Returns the vector turned about the vertical: a heading of 0 becomes `angle_rad`.
glm::dvec3 turn(const glm::dvec3& v, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

Status refused_point(const std::string& id) {
  return bad_input("message from the page",
                   "the target " + in_quotes(id) + " cannot be there",
                   "reload the page");
}

}  // namespace

StageTargets::StageTargets(const SceneRun& run) {
  const Scene& scene = run.scene();
  for (std::size_t t = 0; t < scene.targets.size(); ++t) {
    const SceneTarget& target = scene.targets[t];
    if (std::holds_alternative<BodyPointPath>(target.path)) continue;
    Target one;
    one.target = t;
    one.in_body = target.frame == TargetFrame::kBody;
    one.scales = target.for_stature_m.has_value();
    one.users = users_of(scene, target);
    if (one.in_body && one.users.empty()) continue;
    handles_.push_back({target.id, target.drag});
    targets_.push_back(std::move(one));
  }
}

glm::dvec3 StageTargets::place(const Target& target, const SceneRun& run) const {
  if (target.held_in_world) return *target.held_in_world;
  return run.target_in_world(target.target,
                             target.users.empty() ? 0 : target.users.front());
}

std::vector<live::PageTarget> StageTargets::places(const SceneRun& run) const {
  std::vector<live::PageTarget> out;
  out.reserve(targets_.size());
  for (const Target& target : targets_) {
    out.push_back({place(target, run), target.held_in_world.has_value()});
  }
  return out;
}

Status StageTargets::move(std::size_t handle,
                          const glm::dvec3& p_in_world,
                          SceneRun& run) {
  Target& target = targets_[handle];
  if (!target.in_body) {
    if (!run.set_target(target.target, p_in_world)) {
      return refused_point(handles_[handle].id);
    }
    target.held_in_world = p_in_world;
    return Done{};
  }
  // The displacement since the last step, in the frame of the first user.
  const StageBody& first = run.body(target.users.front());
  const glm::dvec3 moved =
      turn(p_in_world - run.target_in_world(target.target, target.users.front()),
           -first.start.heading_rad);
  for (const std::size_t user : target.users) {
    const StageBody& body = run.body(user);
    const double scale = target.scales ? body.stature_m / first.stature_m : 1.0;
    const glm::dvec3 p = run.target_in_world(target.target, user) +
                         scale * turn(moved, body.start.heading_rad);
    if (!run.set_target(target.target, p, user)) {
      return refused_point(handles_[handle].id);
    }
  }
  target.held_in_world = p_in_world;
  return Done{};
}

Status StageTargets::hold(std::size_t handle, SceneRun& run) {
  return move(handle, place(targets_[handle], run), run);
}

void StageTargets::release(std::size_t handle, SceneRun& run) {
  Target& target = targets_[handle];
  target.held_in_world.reset();
  (void)run.set_target(target.target, std::nullopt);
  if (!target.in_body) return;
  for (const std::size_t user : target.users) {
    (void)run.set_target(target.target, std::nullopt, user);
  }
}

void StageTargets::reset() {
  for (Target& target : targets_) target.held_in_world.reset();
}

}  // namespace marey::app
