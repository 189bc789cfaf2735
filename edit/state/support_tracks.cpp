// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/support_tracks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include <glm/gtc/quaternion.hpp>

#include "core/pose.h"
#include "core/transform.h"
#include "core/base/smooth_step.h"
#include "retarget/constraints/activation.h"
#include "retarget/constraints/measure_constraint.h"

namespace marey::edit {
namespace {

/// A support with this start time is started by retarget::adapt_motion().
constexpr double kStartedByCaller_s = 1e9;
/// A rotation that a flat support adds fades in this time before and after it.
constexpr double kTurnFade_s = 0.15;

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

/// A support, the frames in which it is fully active, and its foot's own path.
struct PlacedSupport {
  Constraint constraint;
  JointIndex joint{};
  FrameRange bears;
  FootPath path;

  [[nodiscard]] const Support& goal() const { return std::get<Support>(constraint.goal); }
  /// Rotation from the foot's own rotation to the required one. [rad]
  [[nodiscard]] glm::dvec3 turn_at(int frame) const {
    return rotation_vector(
        *goal().world_from_t_pose *
        glm::conjugate(path.world_from_t_pose[static_cast<std::size_t>(frame)]));
  }
};

/// Returns the rotation that is added to a foot in each frame: the rotation of a flat
/// support while it bears, with C2 fades before and after it, also while the foot stands
/// on its heel or ball only.
std::vector<glm::dquat> added_turns(const std::vector<PlacedSupport>& supports,
                                    JointIndex joint,
                                    std::size_t frame_count,
                                    FrameRate rate) {
  std::vector<glm::dquat> out(frame_count, glm::dquat(1, 0, 0, 0));
  const double fade_frames = kTurnFade_s * rate.hz;
  for (int frame = 0; frame < static_cast<int>(frame_count); ++frame) {
    glm::dquat& turn = out[static_cast<std::size_t>(frame)];
    for (const PlacedSupport& support : supports) {
      if (support.joint != joint || !support.goal().world_from_t_pose) continue;
      const int edge = std::clamp(frame, support.bears.first, support.bears.last);
      if (edge == frame) {
        turn = rotation_from_vector(support.turn_at(frame));
        break;
      }
      const double share =
          smooth_step(1.0 - std::abs(frame - edge) / fade_frames);
      if (share > 0.0) turn = rotation_from_vector(share * support.turn_at(edge)) * turn;
    }
  }
  return out;
}

retarget::SupportTrack track_of(const PlacedSupport& support,
                                const std::vector<glm::dquat>& turns) {
  retarget::SupportTrack out;
  out.constraint = support.constraint;
  out.constraint.activation.start_s = kStartedByCaller_s;
  out.constraint.activation.stop_s.reset();
  const FrameRange& bears = support.bears;
  out.bears = {bears};
  const glm::dvec3 print = *support.goal().footprint_in_world;
  const std::vector<glm::dvec3>& own = support.path.p_in_world;
  for (int frame = 0; frame < static_cast<int>(own.size()); ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    const int edge = std::clamp(frame, bears.first, bears.last);
    out.p_in_world.push_back(
        edge == frame ? print : own[t] + (print - own[static_cast<std::size_t>(edge)]));
    out.world_from_t_pose.push_back(
        glm::normalize(turns[t] * support.path.world_from_t_pose[t]));
  }
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
  std::vector<PlacedSupport> placed;
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
    placed.push_back({constraint, point.joint, *bears, path_of(point, state.motion)});
  }
  std::map<JointIndex, std::vector<glm::dquat>> turns;
  for (const PlacedSupport& support : placed) {
    auto [own, is_new] = turns.try_emplace(support.joint);
    if (is_new) {
      own->second = added_turns(
          placed, support.joint, state.motion.poses.size(), state.motion.rate);
    }
    out.supports.push_back(track_of(support, own->second));
  }
  // The first of several supports of one foot is met exactly, and those on heel or ball
  // hold while the flat foot fades next to them (retarget::plan_supports()).
  std::stable_partition(out.supports.begin(), out.supports.end(), [](const auto& track) {
    return std::get<Support>(track.constraint.goal).turns;
  });
  return out;
}

}  // namespace marey::edit
