// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/humanoid.h"
#include "core/skeleton.h"

namespace marey::retarget {

/// Maximum number of vertebrae in one section of the spine.
inline constexpr int kMaxVertebrae = 15;

/// One complete limb of a body. The T-pose is the canonical one: arms along +-X, legs
/// along -Y, whatever the skeleton's own rest pose.
struct LimbMap {
  JointIndex upper{};
  JointIndex lower{};
  JointIndex end{};
  double upper_length_m = 0.0;
  double lower_length_m = 0.0;
  glm::dvec3 along_in_t_pose{0.0};  ///< Unit, from the limb's root to its end.
  glm::dvec3 hinge_in_t_pose{0.0};  ///< Unit; see HumanLimb::hinge_axis.

  /// Sum of the segment lengths: the divisor in eq. 1.3.
  [[nodiscard]] double length_m() const { return upper_length_m + lower_length_m; }
};

/// A run of vertebrae, from low to high.
struct SpineSection {
  int count = 0;
  std::array<JointIndex, kMaxVertebrae> joints{};
  /// Normalized arc length at the far end of each vertebra; the last one's is 1.
  std::array<double, kMaxVertebrae> at{};
  /// From each joint to the next one up, in the T-pose. [m]
  std::array<glm::dvec3, kMaxVertebrae> bone_in_t_pose{};
};

/// Start of abdomen and torso on the path from the hips to the neck, as shares of that
/// path's length at rest.
struct SpineShares {
  double abdomen = 0.0;
  double torso = 0.0;
};

/// The path from the hips to the end of the spine: the neck (without one, the head).
struct SpineLine {
  glm::dvec3 hips_bone_in_t_pose{0.0};  ///< To the first vertebra. [m]
  SpineShares shares;
  double length_m = 0.0;  ///< Along the bones.
  /// Mean position of the points that the last vertebra carries (the spine's end and the
  /// collar bones or upper arms below it), from its joint, in the T-pose. [m]
  glm::dvec3 girdle_in_t_pose{0.0};
  double girdle_radius_m = 0.0;  ///< RMS distance of these points from their mean.
};

/// A foot as it stands in the T-pose, sole on the floor, pointing to +Z.
struct FootMap {
  double ankle_height_m = 0.0;  ///< Ankle above the sole.
  double ball_height_m = 0.0;   ///< Toe joint above the sole.
  /// From the ankle to the toe joint; an estimate when the body has no toes.
  glm::dvec3 ball_from_ankle_in_t_pose{0.0};
  bool has_toes = false;
  /// The sole's rear end, over which a foot rolls that lands heel first. An estimate.
  glm::dvec3 heel_from_ankle_in_t_pose{0.0};
  /// The sole's front end, below the tip of the toes; an estimate when no tip is given.
  glm::dvec3 tip_from_ball_in_t_pose{0.0};
};

/// Source of a joint's rotation when a normalized posture is expanded.
enum class JointRole : unsigned char {
  kFree,      ///< No mark: stays as at rest in its parent.
  kSegment,   ///< Its own orientation is transferred.
  kVertebra,  ///< Sampled from a spine curve.
  kNeck,      ///< Above the marked neck joint: sampled from the neck's curve.
  kLimbBone,  ///< Solved with its limb.
};

struct JointDrive {
  JointRole role = JointRole::kFree;
  HumanBone bone{};  ///< For a kSegment.
  int limb = 0;      ///< For a kLimbBone, as in human_limbs().
  /// Rotation of the joint's frame in the canonical T-pose (not kFree). A joint's
  /// T-pose-relative world rotation is world_from_joint * inverse(this).
  glm::dquat t_pose_from_joint{1.0, 0.0, 0.0, 0.0};
};

/// Properties of a skeleton that normalize() and expand() need, computed once.
struct BodyMap {
  std::array<std::optional<JointIndex>, kHumanBoneCount> joint_of{};
  std::vector<JointDrive> joints;  ///< One per joint of the skeleton.
  /// As in human_limbs(). Both legs are always present.
  std::array<std::optional<LimbMap>, 4> limbs{};
  SpineSection abdomen;            ///< From the hips to the start of the torso.
  SpineSection torso;              ///< From there to the base of the neck.
  std::optional<SpineLine> spine;  ///< If it has vertebrae, and a neck or a head.
  SpineSection neck;               ///< From the neck to the head. Empty without either.
  std::array<FootMap, 2> feet{};   ///< Left, right.
  double leg_length_m = 0.0;       ///< Hip to knee to ankle, mean of both sides.
  double arm_length_m = 0.0;       ///< Shoulder to elbow to wrist; 0 without arms.
  double hip_drop_m = 0.0;         ///< Height of the hips joint above the hip centres.

  [[nodiscard]] JointIndex hips() const { return *joint_of[index(HumanBone::kHips)]; }
  /// Side 0 is left, 1 is right.
  [[nodiscard]] const LimbMap& leg(int side) const {
    return *limbs[2 + static_cast<std::size_t>(side)];
  }
};

/// Computes the map of a skeleton from its marks (Joint::bone).
///
/// Accepts any skeleton that faces +Z at rest: other joints between the marked ones,
/// arbitrary rest rotations, A- or T-pose. The bones of complete limbs are aligned, root
/// first, onto their canonical T-pose directions by the smallest rotation; hands follow
/// their forearm; feet keep their sole flat and turn about the vertical until they point
/// forward; all other joints keep their rest rotation. Joints between hips and neck
/// (head, when there is no neck) are vertebrae, marked or not; the torso begins at the
/// chest, or halfway. Joints between neck and head are the neck's, up to kMaxVertebrae
/// with it. A limb that is not complete is treated bone by bone.
///
/// The sole is the floor Y = 0 of the rest pose if the lowest foot joint or toe tip is
/// near above it. Otherwise it is below that joint by the height of an average foot of
/// that leg length.
///
/// Errors (bad input): hips or a leg bone is not marked, a limb bone has no length, or a
/// section of the spine has more than kMaxVertebrae vertebrae.
[[nodiscard]] Result<BodyMap> map_body(const Skeleton& skeleton);

}  // namespace marey::retarget
