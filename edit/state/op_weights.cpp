// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/op_weights.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "edit/state/resample_state.h"
#include "edit/state/resolve_moment.h"

#include "core/base/assert.h"
#include "core/humanoid.h"
#include "core/base/smooth_step.h"

namespace marey::edit {
namespace {

EditGroup group_of_bone(HumanBone bone) {
  switch (bone) {
    case HumanBone::kHips:
      return EditGroup::kRoot;
    case HumanBone::kSpine:
    case HumanBone::kChest:
    case HumanBone::kUpperChest:
      return EditGroup::kTrunk;
    case HumanBone::kNeck:
    case HumanBone::kHead:
      return EditGroup::kHead;
    case HumanBone::kLeftShoulder:
    case HumanBone::kLeftUpperArm:
    case HumanBone::kLeftLowerArm:
    case HumanBone::kLeftHand:
      return EditGroup::kLeftArm;
    case HumanBone::kRightShoulder:
    case HumanBone::kRightUpperArm:
    case HumanBone::kRightLowerArm:
    case HumanBone::kRightHand:
      return EditGroup::kRightArm;
    case HumanBone::kLeftUpperLeg:
    case HumanBone::kLeftLowerLeg:
    case HumanBone::kLeftFoot:
    case HumanBone::kLeftToes:
      return EditGroup::kLeftLeg;
    default:
      return EditGroup::kRightLeg;
  }
}

bool includes(std::span<const EditGroup> groups, EditGroup wanted) {
  return groups.empty() ||
         std::find(groups.begin(), groups.end(), wanted) != groups.end();
}

}  // namespace

std::vector<EditGroup> groups_of_joints(const Skeleton& skeleton) {
  std::vector<EditGroup> out(skeleton.joints.size(), EditGroup::kRoot);
  // A vertebra without a bone between hips and spine is the trunk's.
  std::vector<char> below_hips(skeleton.joints.size(), 0);
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    const std::size_t up = joint.parent ? index(*joint.parent) : j;
    if (joint.bone) {
      out[j] = group_of_bone(*joint.bone);
      below_hips[j] = 1;
    } else if (joint.parent) {
      below_hips[j] = below_hips[up];
      const bool leaves_root = out[up] == EditGroup::kRoot && below_hips[up] != 0;
      out[j] = leaves_root ? EditGroup::kTrunk : out[up];
    }
  }
  return out;
}

Result<OpWeights> op_weights(const Timeline& timeline, const EditOp& op) {
  const auto span = resolve_span(timeline, op.span);
  if (!span) return span.error();
  OpWeights out;
  out.weight.resize(static_cast<std::size_t>(timeline.frame_count));
  out.frames = {0, -1};
  const double fade_frames = op.blend_s * timeline.rate_hz;
  for (int frame = 0; frame < timeline.frame_count; ++frame) {
    const double outside =
        std::max({0.0, span->first - frame, static_cast<double>(frame) - span->last});
    double weight = outside <= 1e-9 ? 1.0 : 0.0;
    if (weight == 0.0 && fade_frames > 0.0) {
      weight = smooth_step(1.0 - outside / fade_frames);
    }
    out.weight[static_cast<std::size_t>(frame)] = weight;
    if (weight <= 0.0) continue;
    if (out.frames.last < out.frames.first) out.frames.first = frame;
    out.frames.last = frame;
  }
  return out;
}

Result<OpWeights> op_weights(const EditState& state, const EditOp& op) {
  return op_weights(timeline_of(state), op);
}

std::vector<JointIndex> joints_of_groups(const EditState& state,
                                         std::span<const EditGroup> groups) {
  const std::vector<EditGroup> group = groups_of_joints(state.motion.skeleton);
  std::vector<JointIndex> out;
  for (std::size_t j = 0; j < group.size(); ++j) {
    if (includes(groups, group[j])) out.push_back(JointIndex{static_cast<int>(j)});
  }
  return out;
}

void mix_motion(const Motion& before,
                const OpWeights& weights,
                const EditState& groups_of,
                std::span<const EditGroup> groups,
                Motion& after) {
  MAREY_ASSERT(before.poses.size() == after.poses.size());
  MAREY_ASSERT(weights.weight.size() == after.poses.size());
  const std::vector<EditGroup> group = groups_of_joints(groups_of.motion.skeleton);
  const bool moves_root = includes(groups, EditGroup::kRoot);
  for (std::size_t frame = 0; frame < after.poses.size(); ++frame) {
    Pose& pose = after.poses[frame];
    const Pose& old = before.poses[frame];
    const double weight = weights.weight[frame];
    if (weight <= 0.0) {
      pose = old;
      continue;
    }
    if (!moves_root) pose.root_in_world = old.root_in_world;
    for (std::size_t j = 0; j < group.size(); ++j) {
      if (!includes(groups, group[j])) {
        pose.parent_from_joint[j] = old.parent_from_joint[j];
      }
    }
    if (weight < 1.0) pose = between_poses(old, pose, weight);
  }
}

}  // namespace marey::edit
