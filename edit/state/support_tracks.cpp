// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/support_tracks.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include <glm/gtc/quaternion.hpp>

#include "core/pose.h"
#include "retarget/constraints/activation.h"
#include "retarget/constraints/measure_constraint.h"

namespace marey::edit {
namespace {

/// A support with this start time is started by retarget::adapt_motion().
constexpr double kStartedByCaller_s = 1e9;

/// Returns the frames in which a constraint is fully active, if there are any.
std::optional<FrameRange> full_frames(const Constraint& constraint,
                                      const EditState& state) {
  std::optional<FrameRange> out;
  for (int frame = 0; frame < state.frame_count(); ++frame) {
    const double time_s = frame / state.motion.rate.hz;
    if (retarget::activation(constraint.activation, time_s) < 1.0) continue;
    if (!out) out = FrameRange{frame, frame};
    out->last = frame;
  }
  return out;
}

/// Place of the constrained point and rotation of its segment from the T-pose.
struct FootPath {
  std::vector<glm::dvec3> p_in_world;
  std::vector<glm::dquat> world_from_t_pose;
};

FootPath path_of(const retarget::CarriedPoint& point, const Motion& motion) {
  FootPath out;
  std::vector<RigidTransform> joints(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, joints);
    out.p_in_world.push_back(point.in_world(joints));
    out.world_from_t_pose.push_back(glm::normalize(
        joints[index(point.joint)].rotation * glm::conjugate(point.t_pose_from_joint)));
  }
  return out;
}

retarget::SupportTrack track_of(const Constraint& constraint,
                                const FrameRange& bears,
                                FootPath path) {
  retarget::SupportTrack out;
  out.constraint = constraint;
  out.constraint.activation.start_s = kStartedByCaller_s;
  out.constraint.activation.stop_s.reset();
  out.bears = {bears};
  const auto& support = std::get<Support>(constraint.goal);
  const glm::dvec3 print = *support.footprint_in_world;
  const FootPath own = path;
  for (int frame = 0; frame < static_cast<int>(path.p_in_world.size()); ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    const auto edge =
        static_cast<std::size_t>(std::clamp(frame, bears.first, bears.last));
    path.p_in_world[t] =
        edge == t ? print : own.p_in_world[t] + (print - own.p_in_world[edge]);
    if (!support.world_from_t_pose) continue;
    path.world_from_t_pose[t] =
        edge == t ? *support.world_from_t_pose
                  : glm::normalize(*support.world_from_t_pose *
                                   glm::conjugate(own.world_from_t_pose[edge]) *
                                   own.world_from_t_pose[t]);
  }
  out.p_in_world = std::move(path.p_in_world);
  out.world_from_t_pose = std::move(path.world_from_t_pose);
  // adapt_motion() places it in each frame.
  auto& placed = std::get<Support>(out.constraint.goal);
  placed.footprint_in_world = glm::dvec3(0.0);
  placed.world_from_t_pose.reset();
  return out;
}

}  // namespace

SplitConstraints split_supports(const EditState& state, const Character& character) {
  SplitConstraints out;
  out.others.unknown_xml = state.constraints.unknown_xml;
  for (const Constraint& constraint : state.constraints.constraints) {
    const auto* support = std::get_if<Support>(&constraint.goal);
    const auto bears = support != nullptr && support->footprint_in_world
                           ? full_frames(constraint, state)
                           : std::nullopt;
    if (!bears) {
      out.others.constraints.push_back(constraint);
      continue;
    }
    const auto point = retarget::carried_point(character, constraint.point);
    out.supports.push_back(track_of(constraint, *bears, path_of(point, state.motion)));
  }
  // The first of several supports of one foot is met exactly, and those on heel or ball
  // hold while the flat foot fades next to them (retarget::plan_supports()).
  std::stable_partition(out.supports.begin(), out.supports.end(), [](const auto& track) {
    return std::get<Support>(track.constraint.goal).turns;
  });
  return out;
}

}  // namespace marey::edit
