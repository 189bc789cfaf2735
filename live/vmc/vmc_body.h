// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "live/vmc/vmc_pose.h"

namespace marey::live {

/// Meaning of an identity rotation for the receiver.
enum class VmcRest {
  /// The T-pose: rest rotations are normalised, as in VRM 0.x and most receivers.
  kVrm0,
  /// The node axes of the avatar's file: VRM 1.0.
  kRaw,
};

struct VmcBodyOptions {
  VmcRest rest = VmcRest::kVrm0;
  /// World rotation of each joint's frame in the T-pose facing +Z, as
  /// Character::t_pose_from_joint; empty if the rest pose is a T-pose. Read only by
  /// make().
  std::span<const glm::dquat> t_pose_from_joint = {};
  /// Rest transform, in the file's world, of the node above the skeleton's first joint,
  /// if there is one. In the receiver's copy of the avatar that joint is local to this
  /// node.
  RigidTransform file_from_root_parent = {};
  /// True for a VRM 0.x file: its body faces -Z, and the skeleton was rotated by half a
  /// turn about Y.
  bool file_faces_back = false;
};

/// Converts an avatar's poses to VMC and back.
///
/// A receiver has the same avatar. It sets local transforms of humanoid bones and leaves
/// the nodes between them at rest. A bone is therefore sent relative to its own parent
/// node P at rest. The rotations of joints between it and its humanoid parent A are
/// included:
///
///   a_from_b = product of the pose's transforms from below A down to b (A: the world,
///              for the hips)
///   kRaw:    sent = inverse(a_from_p at rest) * a_from_b
///   kVrm0:   frames are those of the normalised avatar, parallel to the world in the
///            T-pose. With T_j = t_pose_from_joint (identity for the world):
///            rotation = T_A * rotation(a_from_b) * inverse(T_b)
///            position = T_A * position(a_from_b) - (p of P - p of A in the T-pose)
///
/// The result is mirrored into Unity's axes (live/vmc/vmc_pose.h). For kRaw and a file
/// that faces back, the transform is first conjugated by half a turn about Y, so that Z
/// is mirrored, as importers do. The root stays at the world's origin; the hips move.
/// Offsets are the avatar's own, so receivers that apply positions keep its shape.
/// Nodes are assumed to be unscaled.
class VmcBody {
 public:
  /// Prepares the conversion for a skeleton.
  /// Errors (kBadInput): one of the 15 bones that VRM requires is not marked, or the
  /// hips are not an ancestor of all other bones.
  /// Precondition: the first joint is the only root; t_pose_from_joint is empty or has
  /// one rotation per joint.
  [[nodiscard]] static Result<VmcBody> make(const Skeleton& skeleton,
                                            const VmcBodyOptions& options = {});

  /// Returns the bones that are sent, parents before children.
  [[nodiscard]] std::span<const UnityBone> bones() const { return bones_; }

  /// Writes exactly the bones of bones(). Allocates nothing; linear in joints.
  /// Precondition: a finite pose of the skeleton.
  void to_vmc(const Pose& pose, VmcPose& out) const;

  /// Computes the pose that a receiver with this avatar shows. Bones that were not
  /// received and joints that are not bones are at rest (kVrm0: as in the T-pose). kVrm0:
  /// the rotation of a received bone that this body lacks, such as an upper chest, is
  /// applied to the bones below it. Positions are used for the root and the hips only. If
  /// the hips were not received, they are at their rest place over the root. Allocates
  /// nothing once `out` has a rotation per joint. Inverse of to_vmc() for poses whose
  /// other joints are at rest.
  /// Precondition: finite, unit rotations.
  void from_vmc(const VmcPose& received, Pose& out) const;

 private:
  struct Bone {
    JointIndex joint{};
    UnityBone unity{};
    std::optional<JointIndex> above;  ///< Joint of the humanoid parent.
    /// sent = before * a_from_b * after + moved, for rotation and position.
    glm::dquat before{1.0, 0.0, 0.0, 0.0};
    glm::dquat after{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 moved{0.0};
    /// Bones that this body lacks between this bone and `above`, top first.
    std::array<std::optional<UnityBone>, 3> missing{};
  };

  VmcBody() = default;
  void find_bones();
  void find_frames(const RigidTransform& file_from_root_parent);
  void find_missing();
  [[nodiscard]] RigidTransform above_from_bone(const Pose& pose, const Bone& bone) const;
  [[nodiscard]] glm::dquat turn_of(const VmcPose& received, const Bone& bone) const;
  void turn_joints(const VmcPose& received, Pose& out) const;
  void place_root(const VmcPose& received, Pose& out) const;

  Skeleton skeleton_;
  VmcRest rest_ = VmcRest::kVrm0;
  glm::dquat world_from_file_{1.0, 0.0, 0.0, 0.0};
  std::vector<Bone> list_;  ///< Parents before children; the hips are the first.
  std::vector<UnityBone> bones_;
  /// Joint rotations in the pose of identity (VmcRest): T-pose or rest. One per joint.
  std::vector<glm::dquat> world_from_joint_at_zero_;
  glm::dvec3 hips_at_zero_in_world_{0.0};
};

}  // namespace marey::live
