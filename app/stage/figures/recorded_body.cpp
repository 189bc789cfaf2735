// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/recorded_body.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "retarget/feet/floor_at.h"

namespace marey::app {
namespace {

/// Place of a path's point for a user whose start is the path's frame.
glm::dvec3 in_world_of(const SceneTarget& target,
                       const StageBody& user,
                       const glm::dvec3& position_m) {
  if (target.frame == TargetFrame::kWorld) return position_m;
  const double scale =
      target.for_stature_m ? user.stature_m / *target.for_stature_m : 1.0;
  const double c = std::cos(user.start.heading_rad);
  const double s = std::sin(user.start.heading_rad);
  const glm::dvec3 p = scale * position_m;
  return {user.start.x_m + c * p.x + s * p.z, p.y, user.start.z_m - s * p.x + c * p.z};
}

std::vector<glm::dvec3> body_target(const StageRecord& record,
                                    const BodyPointPath& path,
                                    std::size_t member) {
  const std::optional<SceneMembers> members = members_of(record.scene, path.body);
  if (!members) return {};
  const RecordedBody partner(record, members->partner(member));
  const std::optional<FigurePoint> point = find_point(partner.view(), path.point);
  if (!point) return {};
  return point_path(partner.view(), *point);
}

/// Name of the clip that an action plays; empty: none.
std::string clip_of(const SceneDeed& deed) {
  return std::visit(
      [](const auto& wish) -> std::string {
        if constexpr (requires { wish.clip; }) return wish.clip;
        return {};
      },
      deed);
}

const MotionClip* find_clip(const engine::MotionBase& base, const std::string& name) {
  const std::optional<std::size_t> found = base.find(name);
  return found ? &base.clip(*found) : nullptr;
}

/// The clip under all actions: the body's, else the base's clip "idle", else the first
/// one with the tag "idle".
const MotionClip* idle_clip(const StageRecord& record, std::size_t body) {
  const std::string& own = scene_bodies(record.scene)[body].idle;
  if (const MotionClip* clip = find_clip(*record.base, own.empty() ? "idle" : own)) {
    return clip;
  }
  for (const MotionClip& clip : record.base->clips()) {
    if (std::find(clip.tags.begin(), clip.tags.end(), "idle") != clip.tags.end()) {
      return &clip;
    }
  }
  return nullptr;
}

}  // namespace

RecordedBody::RecordedBody(const StageRecord& record, std::size_t body) {
  const StageTrack& track = record.tracks[body];
  const StageBody& played = record.bodies[body];
  const std::size_t steps = track.poses.size();
  times_s_.reserve(steps);
  for (std::size_t step = 0; step < steps; ++step) {
    times_s_.push_back(record.time_s(step));
  }
  view_ = {played.id, &played.character, &played.map, times_s_, track.poses, {}, {}, {}};
  if (track.references.size() == steps) view_.references = track.references;
  if (track.stands.size() == steps) view_.stands = track.stands;
  if (track.floor_moved_m.size() == steps) add_floor(record, body);
}

void RecordedBody::add_floor(const StageRecord& record, std::size_t body) {
  FigureFrames frames(view_);
  for (std::size_t step = 0; step < view_.poses.size(); ++step) {
    std::array<FigureFloor, 2> under;
    for (std::size_t side = 0; side < 2; ++side) {
      under[side].moved_m = record.tracks[body].floor_moved_m[step][side];
    }
    if (!record.floor.parts.empty()) {
      const auto joints = frames.joints(view_.poses[step]);
      for (int side = 0; side < 2; ++side) {
        const glm::dvec3 ankle = joints[index(view_.map->leg(side).end)].translation;
        under[static_cast<std::size_t>(side)].normal_in_world =
            retarget::floor_at(record.floor, {ankle.x, ankle.z}, times_s_[step])
                .normal_in_world;
      }
    }
    floor_.push_back(under);
  }
  view_.floor = floor_;
}

std::vector<glm::dvec3> recorded_target(const StageRecord& record,
                                        const std::string& target,
                                        std::size_t user,
                                        std::size_t member) {
  const SceneTarget* found = record.scene.target(target);
  if (found == nullptr) return {};
  const auto number = static_cast<std::size_t>(found - record.scene.targets.data());
  for (const StageTargetTrack& track : record.targets) {
    if (track.target == number && track.body == user &&
        track.p_in_world.size() == record.step_count()) {
      return track.p_in_world;
    }
  }
  if (const auto* path = std::get_if<BodyPointPath>(&found->path)) {
    return body_target(record, *path, member);
  }
  std::vector<glm::dvec3> places;
  for (std::size_t step = 0; step < record.step_count(); ++step) {
    places.push_back(in_world_of(
        *found, record.bodies[user], *path_at(found->path, record.time_s(step))));
  }
  return places;
}

std::vector<PlayedClip> played_clips(const StageRecord& record, std::size_t body) {
  const double end_s =
      record.step_count() == 0 ? 0.0 : record.time_s(record.step_count() - 1);
  std::vector<PlayedClip> clips;
  double rest_s = end_s;
  for (const StageActionRun& run : record.actions) {
    if (run.body != body) continue;
    const std::string name = clip_of(record.scene.script[run.action].deed);
    const MotionClip* clip = find_clip(*record.base, name);
    const double played_s = std::min(run.end_s, end_s) - run.start_s;
    if (clip == nullptr || played_s <= 0.0) continue;
    clips.push_back({clip, played_s});
    rest_s -= played_s;
  }
  const MotionClip* idle = idle_clip(record, body);
  if (idle != nullptr && rest_s > 0.0) clips.push_back({idle, rest_s});
  return clips;
}

}  // namespace marey::app
