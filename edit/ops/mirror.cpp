// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/mirror.h"

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "edit/state/check_op_keys.h"
#include "edit/state/mirror_names.h"
#include <glm/gtc/quaternion.hpp>

#include "core/humanoid.h"
#include "core/pose.h"

namespace marey::edit {
namespace {

glm::dvec3 mirrored(const glm::dvec3& p) {
  return {-p.x, p.y, p.z};
}

glm::dquat mirrored(const glm::dquat& q) {
  return {q.w, q.x, -q.y, -q.z};
}

/// Returns the world rotation of each joint in the T-pose.
std::vector<glm::dquat> t_pose_rotations(const EditState& state) {
  const auto& joints = state.motion.skeleton.joints;
  std::vector<glm::dquat> out(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const retarget::JointDrive& drive = state.map.joints[j];
    if (drive.role != retarget::JointRole::kFree) {
      out[j] = drive.t_pose_from_joint;
      continue;
    }
    const glm::dquat& rest = joints[j].parent_from_joint.rotation;
    out[j] = joints[j].parent ? out[index(*joints[j].parent)] * rest : rest;
  }
  return out;
}

/// Mirrors the poses of one skeleton.
class PoseMirror {
 public:
  explicit PoseMirror(const EditState& state)
      : skeleton_(state.motion.skeleton),
        hips_(index(state.map.hips())),
        counterpart_(mirrored_joints(skeleton_)),
        t_pose_(t_pose_rotations(state)),
        old_(skeleton_.joints.size()),
        new_(skeleton_.joints.size()) {}

  void apply(Pose& pose) {
    world_from_joints(skeleton_, pose, old_);
    for (std::size_t j = 0; j < old_.size(); ++j) {
      const std::size_t from = index(counterpart_[j]);
      new_[j] =
          mirrored(old_[from].rotation * glm::conjugate(t_pose_[from])) * t_pose_[j];
    }
    for (std::size_t j = 0; j < old_.size(); ++j) {
      const auto& parent = skeleton_.joints[j].parent;
      pose.parent_from_joint[j] = glm::normalize(
          parent ? glm::conjugate(new_[index(*parent)]) * new_[j] : new_[j]);
    }
    const glm::dvec3 hips = mirrored(old_[hips_].translation);
    world_from_joints(skeleton_, pose, old_);
    pose.root_in_world += hips - old_[hips_].translation;
  }

  [[nodiscard]] const std::vector<JointIndex>& counterparts() const {
    return counterpart_;
  }

 private:
  const Skeleton& skeleton_;
  std::size_t hips_;
  std::vector<JointIndex> counterpart_;
  std::vector<glm::dquat> t_pose_;
  std::vector<RigidTransform> old_;
  std::vector<glm::dquat> new_;
};

void mirror_box(glm::dvec3& min_in_world, glm::dvec3& max_in_world) {
  const double min_x = -max_in_world.x;
  max_in_world.x = -min_in_world.x;
  min_in_world.x = min_x;
}

void mirror_point(BodyPoint& point) {
  if (const auto bone = human_bone(point.segment)) {
    point.segment = std::string(name(marey::mirrored(*bone)));
  } else {
    point.segment = mirrored_name(point.segment);
  }
  point.offset_in_t_pose = mirrored(point.offset_in_t_pose);
}

struct GoalMirror {
  void operator()(DistanceToPoint& goal) const {
    goal.p_in_world = mirrored(goal.p_in_world);
  }
  void operator()(DistanceToBody& goal) const { mirror_point(goal.other); }
  void operator()(DistanceToConstraint& goal) const {
    goal.other_id = mirrored_name(goal.other_id);
  }
  void operator()(AllowedSpace& goal) const {
    mirror_box(goal.min_in_world, goal.max_in_world);
  }
  void operator()(ForbiddenSpace& goal) const {
    mirror_box(goal.min_in_world, goal.max_in_world);
  }
  void operator()(SegmentOrientation& goal) const {
    goal.world_from_t_pose = mirrored(goal.world_from_t_pose);
  }
  void operator()(Support& goal) const {
    if (goal.footprint_in_world) {
      goal.footprint_in_world = mirrored(*goal.footprint_in_world);
    }
    if (goal.world_from_t_pose) {
      goal.world_from_t_pose = mirrored(*goal.world_from_t_pose);
    }
  }
};

void mirror_annotations(EditState& state) {
  for (Annotation& note : state.annotations.notes) note.text = mirrored_name(note.text);
  for (ValueCurve& curve : state.annotations.curves) {
    curve.name = mirrored_name(curve.name);
  }
  for (ContactEdit& edit : state.contact_edits) edit.side = 1 - edit.side;
  for (Constraint& constraint : state.constraints.constraints) {
    constraint.id = mirrored_name(constraint.id);
    mirror_point(constraint.point);
    std::visit(GoalMirror{}, constraint.goal);
  }
  std::swap(state.contacts.feet[0], state.contacts.feet[1]);
}

}  // namespace

Result<EditState> apply_mirror(const MirrorOp& /*op*/,
                               const OpContext& context,
                               const EditState& state,
                               OpReport& /*report*/) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  EditState out = state;
  PoseMirror mirror(state);
  for (Pose& pose : out.motion.poses) mirror.apply(pose);
  for (std::size_t t = 0; t < out.uncertainty.size(); ++t) {
    for (std::size_t j = 0; j < out.uncertainty[t].size(); ++j) {
      out.uncertainty[t][j] = state.uncertainty[t][index(mirror.counterparts()[j])];
    }
  }
  mirror_annotations(out);
  touch(out.lineage, {0, out.frame_count() - 1}, context.index);
  return out;
}

}  // namespace marey::edit
