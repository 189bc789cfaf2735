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

/// What an identity rotation means to the receiver.
enum class VmcRest {
  /// The T-pose: rest rotations were normalised, as in VRM 0.x and most receivers.
  kVrm0,
  /// The avatar's own nodes, as its file has them: VRM 1.0.
  kRaw,
};

struct VmcBodyOptions {
  VmcRest rest = VmcRest::kVrm0;
  /// World rotation of each joint's frame in the T-pose facing +Z, as
  /// Character::t_pose_from_joint; empty when the rest pose is one. Read by make() alone.
  std::span<const glm::dquat> t_pose_from_joint = {};
  /// Rest, in the file's world, of the node above the skeleton's first joint, when there
  /// is one: that joint is local to it in the receiver's copy of the avatar.
  RigidTransform file_from_root_parent = {};
  /// The file is a VRM 0.x: its body faces -Z, and the skeleton was turned half about Y.
  bool file_faces_back = false;
};

/// Tells an avatar's poses as VMC wants them, and VMC's as poses of the avatar.
///
/// A receiver has the same avatar. It sets local transforms of humanoid bones; nodes
/// between them it leaves at rest. So a bone is told in its own parent node P at rest,
/// and what joints between it and its humanoid parent A do is folded into it:
///
///   a_from_b = product of the pose's transforms from below A down to b (A: the world,
///              for the hips)
///   kRaw:    told = inverse(a_from_p at rest) * a_from_b
///   kVrm0:   frames are those of the normalised avatar, parallel to the world in the
///            T-pose. With T_j = t_pose_from_joint (identity for the world):
///            rotation = T_A * rotation(a_from_b) * inverse(T_b)
///            position = T_A * position(a_from_b) - (p of P - p of A in the T-pose)
///
/// and then everything is mirrored into Unity's axes (live/vmc/vmc_pose.h); kRaw of a file
/// that faces back is turned half about Y before, there and back, so that it is Z that is
/// mirrored, as importers do. The root stays at the world's origin; the hips move.
/// Offsets are the avatar's own, so that receivers that apply positions keep its shape.
/// Nodes are taken to be unscaled.
class VmcBody {
 public:
  /// Errors (kBadInput): one of the 15 bones that VRM requires is not marked, or the
  /// hips do not carry all others.
  /// Precondition: the first joint is the only root; t_pose_from_joint is empty or has
  /// one rotation per joint.
  [[nodiscard]] static Result<VmcBody> make(const Skeleton& skeleton,
                                            const VmcBodyOptions& options = {});

  /// The bones that it tells, parents before children.
  [[nodiscard]] std::span<const UnityBone> bones() const { return bones_; }

  /// Every bone of bones(), and none else. Allocates nothing; linear in joints.
  /// Precondition: a finite pose of the skeleton.
  void to_vmc(const Pose& pose, VmcPose& out) const;

  /// The pose that a receiver with this avatar shows. Bones that are not told are at rest
  /// (kVrm0: as in the T-pose), and so are joints that are no bones. kVrm0: what told
  /// bones turn that this body lacks, such as an upper chest, the bones below them have.
  /// Positions count for the root and the hips alone. Unless the hips are told, they are
  /// at their rest place over the root. Allocates nothing once `out` has a rotation per
  /// joint. Inverse of tell() of poses whose other joints are at rest.
  /// Precondition: finite, unit rotations.
  void from_vmc(const VmcPose& received, Pose& out) const;

 private:
  struct Bone {
    JointIndex joint{};
    UnityBone unity{};
    std::optional<JointIndex> above;  ///< Its humanoid parent's joint.
    /// told = before * a_from_b * after + moved, of rotation and position alike.
    glm::dquat before{1.0, 0.0, 0.0, 0.0};
    glm::dquat after{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 moved{0.0};
    /// Bones that this body lacks between it and `above`, top first.
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
  std::vector<Bone> list_;  ///< Parents first: the hips are the first.
  std::vector<UnityBone> bones_;
  /// Rotations of what identity means: the T-pose, or the rest pose. One per joint.
  std::vector<glm::dquat> world_from_joint_at_zero_;
  glm::dvec3 hips_at_zero_in_world_{0.0};
};

}  // namespace marey::live
