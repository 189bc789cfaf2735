// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/follow_player.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/smooth_step.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::engine {
namespace {

constexpr double kFollowCarry_s = 0.03;

bool is_finite_target(const glm::dvec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

Error follow_error(const FollowWish& wish, std::string cause, std::string next) {
  return bad_input(
      "follow \"" + wish.constraint + "\"", std::move(cause), std::move(next));
}

}  // namespace

glm::dvec3 posed_point(std::span<const RigidTransform> world_from_joint,
                       const retarget::BodyMap& map,
                       const FollowPoint& point) {
  const glm::dquat turn =
      retarget::rotation_from_t_pose(map, world_from_joint, point.joint);
  return world_from_joint[index(point.joint)].translation + turn * point.offset_in_t_pose;
}

double follow_time_s(double distance_m, const FollowSettings& settings) {
  // Maxima of the quintic from rest to rest, times the powers of its duration.
  constexpr double kSpeed = 1.875;
  constexpr double kAcceleration = 5.7735;
  constexpr double kJerk = 60.0;
  return std::max({settings.shortest_s,
                   kSpeed * distance_m / settings.max_speed_m_s,
                   std::sqrt(kAcceleration * distance_m / settings.max_acceleration_m_s2),
                   std::cbrt(kJerk * distance_m / settings.max_jerk_m_s3)});
}

FollowPlayer::FollowPlayer(ActionId id,
                           const FollowWish& wish,
                           const FollowPoint& point,
                           const Skeleton& skeleton,
                           const retarget::BodyMap& map,
                           retarget::Adapter::Handle handle)
    : id_(id),
      wish_(wish),
      point_(point),
      map_(&map),
      handle_(handle),
      rehearsal_(skeleton, map) {}

Result<FollowPlayer> FollowPlayer::make(ActionId id,
                                        const FollowWish& wish,
                                        const FollowPoint& point,
                                        const Skeleton& skeleton,
                                        const retarget::BodyMap& map,
                                        retarget::Adapter::Handle handle) {
  if (!is_finite_target(wish.target_in_world)) {
    return follow_error(wish, "the target is not finite", "give a point in metres");
  }
  if (!std::isfinite(wish.fade_out_s) || wish.fade_out_s < 0.0 ||
      wish.fade_out_s > 100.0) {
    return follow_error(wish, "the fade is not in [0, 100] s", "give 0.4 s, for example");
  }
  FollowCourse trial;
  if (const Status good = trial.start({}, {}, wish.settings); !good) return good.error();
  return FollowPlayer(id, wish, point, skeleton, map, handle);
}

Status FollowPlayer::aim(const glm::dvec3& target_in_world) {
  if (!is_finite_target(target_in_world)) {
    return follow_error(wish_, "the target is not finite", "give a point in metres");
  }
  wish_.target_in_world = target_in_world;
  return Done{};
}

void FollowPlayer::drop(double time_s) {
  if (has_started_) handle_.stop(time_s);
  has_started_ = false;
}

void FollowPlayer::begin(double time_s,
                         double step_s,
                         const BlendPlayer& blend,
                         std::span<const RigidTransform> reference,
                         std::span<const RigidTransform> posed) {
  glm::dvec3 velocity(0.0);
  if (rehearsal_.predict(time_s, time_s - step_s, blend)) {
    velocity = (posed_point(reference, *map_, point_) -
                posed_point(rehearsal_.joints(), *map_, point_)) /
               step_s;
  }
  (void)course_.start(posed_point(posed, *map_, point_), velocity, wish_.settings);
  handle_.start(time_s - step_s);
  has_started_ = true;
}

bool FollowPlayer::step(double time_s,
                        double step_s,
                        const BlendPlayer& blend,
                        std::span<const RigidTransform> reference,
                        std::span<const RigidTransform> posed,
                        const BodyShift& shift) {
  if (!has_started_) {
    if (stops_) return false;
    begin(time_s, step_s, blend, reference, posed);
    carries_m_ = shift.hips_m;
  }
  const FollowState& state = course_.step(wish_.target_in_world, step_s);
  glm::dvec3 place = state.p_in_world;
  if (stops_) {
    if (stopped_s_ < 0.0) stopped_s_ = time_s - step_s;
    carries_m_ += std::min(1.0, step_s / kFollowCarry_s) * (shift.hips_m - carries_m_);
    const double share =
        wish_.fade_out_s > 0.0 ? (time_s - stopped_s_) / wish_.fade_out_s : 1.0;
    if (share >= 1.0) {
      drop(time_s);
      return false;
    }
    place = glm::mix(
        place, posed_point(reference, *map_, point_) + carries_m_, smooth_step(share));
  }
  handle_.set_target(place);
  return true;
}

}  // namespace marey::engine
