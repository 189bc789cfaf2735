// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/target_places.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/base/assert.h"
#include "core/humanoid.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::app {
namespace {

void add_use(const Scene& scene,
             const std::string& target,
             const std::string& users,
             std::vector<TargetUse>& out) {
  const SceneTarget* found = scene.target(target);
  const auto members = members_of(scene, users);
  if (found == nullptr || !members) return;
  const auto place = static_cast<std::size_t>(found - scene.targets.data());
  for (std::size_t k = 0; k < members->count; ++k) {
    const std::size_t user = members->first + k;
    const bool is_known = std::any_of(out.begin(), out.end(), [&](const TargetUse& use) {
      return use.target == place && use.user == user;
    });
    if (!is_known) out.push_back({place, user, k});
  }
}

}  // namespace

std::vector<TargetUse> target_uses(const Scene& scene) {
  std::vector<TargetUse> out;
  for (const SceneAction& action : scene.script) {
    add_use(scene, target_of(action), action.body, out);
  }
  for (const SceneFigure& figure : scene.figures) {
    for (const std::string& body : figure.bodies) {
      add_use(scene, figure.target, body, out);
    }
  }
  return out;
}

std::optional<JointIndex> joint_of_segment(const StageBody& body,
                                           const std::string& segment) {
  if (const auto bone = human_bone(segment)) {
    if (const auto joint = body.map.joint_of[index(*bone)]) return joint;
  }
  const auto& joints = body.character.skeleton.joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == segment) return JointIndex{static_cast<int>(i)};
  }
  return std::nullopt;
}

glm::dvec3 point_in_world(const StageBody& body,
                          JointIndex joint,
                          const glm::dvec3& offset_in_t_pose,
                          std::span<const RigidTransform> world_from_joint) {
  return world_from_joint[index(joint)].translation +
         retarget::rotation_from_t_pose(body.map, world_from_joint, joint) *
             offset_in_t_pose;
}

TargetPlaces::TargetPlaces(const Scene& scene, std::span<const StageBody> bodies)
    : scene_(scene), bodies_(bodies) {}

glm::dvec3 TargetPlaces::on_body(const BodyPointPath& path,
                                 const TargetUse& use,
                                 const engine::Engine& engine) const {
  const auto members = members_of(scene_, path.body);
  MAREY_ASSERT(members.has_value());
  const std::size_t partner = members->partner(use.member);
  MAREY_ASSERT(partner < members->first + members->count);
  const StageBody& body = bodies_[partner];
  const auto joint = joint_of_segment(body, path.point.segment);
  if (!joint) return glm::dvec3(body.start.x_m, 0.0, body.start.z_m);
  const auto id = engine::CharacterId{static_cast<int>(partner)};
  return point_in_world(
      body, *joint, path.point.offset_in_t_pose, engine.player(id).world_from_joint());
}

glm::dvec3 TargetPlaces::in_world(const TargetUse& use,
                                  double time_s,
                                  const engine::Engine& engine) const {
  for (const Held& held : held_) {
    if (held.target != use.target) continue;
    if (!held.user || *held.user == use.user) return held.p_in_world;
  }
  const SceneTarget& target = scene_.targets[use.target];
  if (const auto* path = std::get_if<BodyPointPath>(&target.path)) {
    return on_body(*path, use, engine);
  }
  glm::dvec3 p = *path_at(target.path, time_s);
  if (target.frame == TargetFrame::kWorld) return p;
  const StageBody& body = bodies_[use.user];
  if (target.for_stature_m) p *= body.stature_m / *target.for_stature_m;
  const double c = std::cos(body.start.heading_rad);
  const double s = std::sin(body.start.heading_rad);
  return {body.start.x_m + c * p.x + s * p.z, p.y, body.start.z_m - s * p.x + c * p.z};
}

bool TargetPlaces::hold(std::size_t target,
                        const std::optional<glm::dvec3>& p_in_world,
                        std::optional<std::size_t> user) {
  if (target >= scene_.targets.size() || !scene_.targets[target].drag) return false;
  if (user && *user >= bodies_.size()) return false;
  if (p_in_world && !std::isfinite(p_in_world->x + p_in_world->y + p_in_world->z)) {
    return false;
  }
  std::erase_if(held_, [&](const Held& held) {
    return held.target == target && (!user || held.user == user);
  });
  if (p_in_world) {
    // A place for one user is found before that for all.
    const Held held{target, user, *p_in_world};
    held_.insert(user ? held_.begin() : held_.end(), held);
  }
  return true;
}

}  // namespace marey::app
