// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/splice_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "edit/state/op_weights.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "core/transform.h"
#include "core/base/smooth_step.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/contacts/support_frame.h"

namespace marey::edit {
namespace {

// Time in which a foot's share in the anchor of the root rises and falls: half of the
// usual overlap. Shorter, a change of the bearing foot moves the root within a frame. [s]
constexpr double kAnchorRamp_s = 0.15;

// Places of both ankles of a pose.
std::array<glm::dvec3, 2> ankles_of(const EditState& body, const Pose& pose) {
  const auto world = world_from_joints(body.motion.skeleton, pose);
  return {world[index(body.map.leg(0).end)].translation,
          world[index(body.map.leg(1).end)].translation};
}

// Places between ankle and toe joint, where the foot bears.
std::array<glm::dvec3, 2> soles_of(const EditState& body, const Pose& pose) {
  const auto world = world_from_joints(body.motion.skeleton, pose);
  std::array<glm::dvec3, 2> out{};
  for (std::size_t side = 0; side < 2; ++side) {
    out[side] = world[index(body.map.leg(static_cast<int>(side)).end)].translation;
    const auto toes =
        body.map
            .joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
    if (toes) out[side] = 0.5 * (out[side] + world[index(*toes)].translation);
  }
  return out;
}

std::vector<char> stance_marks(const EditState& state, std::size_t side) {
  return retarget::frame_marks(state.contacts.feet[side].stance,
                               static_cast<std::size_t>(state.frame_count()));
}

// The inverse of the right Jacobian of rotation vectors: the rate of `d` for which
// Exp(d) turns with `turn_rate`, in its own axes.
glm::dvec3 rate_of_vector(const glm::dvec3& d, const glm::dvec3& turn_rate) {
  const double angle = glm::length(d);
  constexpr double kSmall = 1e-4;
  const double factor = angle < kSmall
                            ? 1.0 / 12.0
                            : 1.0 / (angle * angle) - (1.0 + std::cos(angle)) /
                                                          (2.0 * angle * std::sin(angle));
  const glm::dvec3 once = glm::cross(d, turn_rate);
  return turn_rate + 0.5 * once + factor * glm::cross(d, once);
}

// Time over which the velocity gap of a displacement fades. Longer, the noise of
// velocities leads far away. [s]
constexpr double kVelocityFade_s = 0.15;

// A displacement that starts with a value and a rate, and decays to rest over a time,
// with continuous acceleration and none at the start.
struct Decay {
  glm::dvec3 value{0.0};
  glm::dvec3 rate{0.0};  // Per frame.

  [[nodiscard]] glm::dvec3 at(int frame, int length, double rate_length) const {
    const double x = std::min(1.0, frame / rate_length);
    const double x3 = x * x * x;
    const double go = x - 6.0 * x3 + 8.0 * x3 * x - 3.0 * x3 * x * x;
    const double share = 1.0 - smooth_step(static_cast<double>(frame) / length);
    return share * value + go * rate_length * rate;
  }
};

// Displacements of one side of the join, from the join on.
struct SideDecay {
  int length = 0;  // Frames.
  double rate_length = 0.0;
  Decay root;
  std::vector<Decay> joints;  // Rotation vectors in the joint's own axes.
};

// Rotation of a joint per frame, in its own axes, towards the frame `to`.
glm::dvec3 turn_to(const Pose& from, const Pose& to, std::size_t joint) {
  return rotation_vector(glm::conjugate(from.parent_from_joint[joint]) *
                         to.parent_from_joint[joint]);
}

glm::dquat turned_by(const glm::dquat& q, const glm::dvec3& vector) {
  return glm::normalize(q * rotation_from_vector(vector));
}

// The poses at the join and their velocities per frame, forward in time.
struct JoinPoses {
  const Pose& a;
  const Pose& before_a;
  const Pose& b;
  const Pose& after_b;
  double hz = 0.0;
  double share_a = 0.5;  // Part of the gap that the first side takes.
};

SideDecay decay_of(const JoinPoses& join, bool is_first, int length) {
  SideDecay out;
  out.length = length;
  out.rate_length =
      std::min(1.0 * length, std::max({1.0, kVelocityFade_s * join.hz, 0.5 * length}));
  const double share = is_first ? join.share_a : join.share_a - 1.0;
  // Time runs away from the join: backwards on the first side.
  const double sense = is_first ? -1.0 : 1.0;
  const Pose& own = is_first ? join.a : join.b;
  const glm::dvec3 root_a = join.a.root_in_world - join.before_a.root_in_world;
  const glm::dvec3 root_b = join.after_b.root_in_world - join.b.root_in_world;
  out.root = {share * (join.b.root_in_world - join.a.root_in_world),
              sense * share * (root_b - root_a)};
  for (std::size_t j = 0; j < own.parent_from_joint.size(); ++j) {
    const glm::dvec3 gap = turn_to(join.a, join.b, j);
    const glm::dvec3 turn_a = turn_to(join.before_a, join.a, j);
    const glm::dvec3 turn_b = turn_to(join.b, join.after_b, j);
    const glm::dvec3 value = share * gap;
    // Both velocities in the axes of the pose at the join.
    const glm::dquat a_from_join = rotation_from_vector(join.share_a * gap);
    const glm::dquat b_from_join = rotation_from_vector((join.share_a - 1.0) * gap);
    const glm::dvec3 at_join_a = glm::conjugate(a_from_join) * turn_a;
    const glm::dvec3 at_join_b = glm::conjugate(b_from_join) * turn_b;
    const glm::dvec3 wanted = glm::mix(at_join_a, at_join_b, join.share_a);
    const glm::dvec3 rate =
        rate_of_vector(value, wanted - (is_first ? at_join_a : at_join_b));
    out.joints.push_back({value, sense * rate});
  }
  return out;
}

// The pose of a side, `frame` frames from the join.
void displace(const SideDecay& decay, int frame, Pose& pose) {
  pose.root_in_world += decay.root.at(frame, decay.length, decay.rate_length);
  for (std::size_t j = 0; j < decay.joints.size(); ++j) {
    glm::dquat& q = pose.parent_from_joint[j];
    q = turned_by(q, decay.joints[j].at(frame, decay.length, decay.rate_length));
  }
}

const Pose& pose_at(const EditState& state, int frame) {
  return state.motion
      .poses[static_cast<std::size_t>(std::clamp(frame, 0, state.frame_count() - 1))];
}

// Rotations of the second motion's joints against the first one's over the overlap, each
// with the sign that follows the frame before. Two rotations nearly half a turn apart
// would otherwise be mixed the one way round in a frame and the other way in the next.
std::vector<std::vector<glm::dquat>> overlap_turns(const EditState& first,
                                                   const EditState& second,
                                                   const JoinFrames& frames) {
  std::vector<std::vector<glm::dquat>> out(frames.weight.size());
  const auto turn = [&](std::size_t k, std::size_t joint) {
    const Pose& a = first.motion.poses[static_cast<std::size_t>(frames.start) + k];
    return glm::conjugate(a.parent_from_joint[joint]) *
           second.motion.poses[k].parent_from_joint[joint];
  };
  const auto join = static_cast<std::size_t>(frames.join - frames.start);
  for (std::size_t j = 0; j < first.motion.skeleton.joints.size(); ++j) {
    // The shorter way at the join.
    glm::dquat at_join = turn(join, j);
    if (at_join.w < 0.0) at_join = -at_join;
    glm::dquat last = at_join;
    for (std::size_t k = join; k < out.size(); ++k) {
      const glm::dquat next = turn(k, j);
      last = glm::dot(next, last) < 0.0 ? -next : next;
      out[k].push_back(last);
    }
    last = at_join;
    for (std::size_t k = join; k-- > 0;) {
      const glm::dquat next = turn(k, j);
      last = glm::dot(next, last) < 0.0 ? -next : next;
      out[k].push_back(last);
    }
  }
  return out;
}

// Part of a rotation by up to a whole turn.
glm::dquat part_of_turn(const glm::dquat& turn, double share) {
  const glm::dvec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  constexpr double kSmall = 1e-12;
  if (sine < kSmall) return {1.0, 0.0, 0.0, 0.0};
  const double half = share * std::atan2(sine, turn.w);
  const glm::dvec3 part = (std::sin(half) / sine) * axis;
  return {std::cos(half), part.x, part.y, part.z};
}

// Weights of the second motion in one frame.
struct PoseShares {
  double body = 0.0;   // Root and legs.
  double upper = 0.0;  // Trunk, head and arms.
};

// Marks the joints of trunk, head and arms.
std::vector<char> upper_joints(const Skeleton& skeleton) {
  std::vector<char> out;
  for (const EditGroup group : groups_of_joints(skeleton)) {
    const bool is_body = group == EditGroup::kRoot || group == EditGroup::kLeftLeg ||
                         group == EditGroup::kRightLeg;
    out.push_back(is_body ? 0 : 1);
  }
  return out;
}

Pose mixed_pose(const Pose& a,
                const Pose& b,
                const std::vector<glm::dquat>& turns,
                const std::vector<char>& is_upper,
                const PoseShares& shares) {
  Pose out = a;
  if (shares.body >= 1.0) {
    out.root_in_world = b.root_in_world;
  } else if (shares.body > 0.0) {
    out.root_in_world = glm::mix(a.root_in_world, b.root_in_world, shares.body);
  }
  for (std::size_t j = 0; j < out.parent_from_joint.size(); ++j) {
    const double share = is_upper[j] != 0 ? shares.upper : shares.body;
    if (share <= 0.0 || a.parent_from_joint[j] == b.parent_from_joint[j]) continue;
    out.parent_from_joint[j] =
        share >= 1.0
            ? b.parent_from_joint[j]
            : glm::normalize(a.parent_from_joint[j] * part_of_turn(turns[j], share));
  }
  return out;
}

}  // namespace

glm::dvec3 footprint_gap(const EditState& first,
                         const EditState& second,
                         const JoinFrames& frames) {
  glm::dvec3 sum(0.0);
  double count = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto a = stance_marks(first, side);
    const auto b = stance_marks(second, side);
    const auto last = static_cast<std::size_t>(frames.body.last);
    for (auto k = static_cast<std::size_t>(frames.body.first); k <= last; ++k) {
      const std::size_t t = static_cast<std::size_t>(frames.start) + k;
      if (a[t] == 0 || b[k] == 0) continue;
      sum += soles_of(first, first.motion.poses[t])[side] -
             soles_of(second, second.motion.poses[k])[side];
      count += 1.0;
    }
  }
  if (count == 0.0) return sum;
  return {sum.x / count, 0.0, sum.z / count};
}

void mix_overlap(const EditState& first,
                 const EditState& second,
                 const JoinFrames& frames,
                 EditState& out) {
  const auto shares =
      retarget::support_shares(out.contacts, out.motion.rate, kAnchorRamp_s);
  const auto turns = overlap_turns(first, second, frames);
  const auto is_upper = upper_joints(out.motion.skeleton);
  for (std::size_t k = 0; k < frames.weight.size(); ++k) {
    const double weight = frames.weight[k];
    const std::size_t t = static_cast<std::size_t>(frames.start) + k;
    const Pose& a = first.motion.poses[t];
    const Pose& b = second.motion.poses[k];
    Pose mixed = mixed_pose(a, b, turns[k], is_upper, {weight, frames.upper_weight[k]});
    if (weight > 0.0 && weight < 1.0) {
      const auto feet_a = ankles_of(first, a);
      const auto feet_b = ankles_of(second, b);
      const auto feet = ankles_of(out, mixed);
      for (std::size_t side = 0; side < 2; ++side) {
        const glm::dvec3 off = glm::mix(feet_a[side], feet_b[side], weight) - feet[side];
        mixed.root_in_world += shares[t].present * shares[t].foot[side] * off;
      }
    }
    out.motion.poses[t] = std::move(mixed);
  }
}

FrameRange displace_join(const EditState& first,
                         const EditState& second,
                         const JoinFrames& frames,
                         int blend_frames,
                         EditState& out) {
  MAREY_ASSERT(frames.weight.size() == 1 && frames.start == frames.join);
  const int join = frames.join;
  const int length_a = std::min(blend_frames, join);
  const int length_b = std::min(blend_frames, second.frame_count() - 1);
  if (length_a == 0 && length_b == 0) return {0, -1};
  const double share_a = length_a == 0 ? 0.0 : length_b == 0 ? 1.0 : 0.5;
  const JoinPoses poses{pose_at(first, join),
                        pose_at(first, join - 1),
                        pose_at(second, 0),
                        pose_at(second, 1),
                        first.motion.rate.hz,
                        share_a};
  const SideDecay before = decay_of(poses, true, std::max(1, length_a));
  const SideDecay after = decay_of(poses, false, std::max(1, length_b));
  for (int k = 0; k < std::max(1, length_a); ++k) {
    displace(before, k, out.motion.poses[static_cast<std::size_t>(join - k)]);
  }
  for (int k = 1; k < length_b; ++k) {
    displace(after, k, out.motion.poses[static_cast<std::size_t>(join + k)]);
  }
  return {join - std::max(0, length_a - 1), join + std::max(0, length_b - 1)};
}

}  // namespace marey::edit
