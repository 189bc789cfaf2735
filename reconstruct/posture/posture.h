// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the normalized skeleton as parameters of a solver.
// A posture is not a list of joint angles but Kulpa's normalized skeleton (2005, 1.1.2):
// limbs are a frame (Z along root to end, P towards the elbow or knee: here one rotation)
// and a length, given by the flexion of the triangle; the trunk is two splines, abdomen
// and torso, driven by the rotations at their ends; all other bones are rotations. All
// rotations are of the bone in the world, identity in the T-pose. The derivative of every
// point is therefore a sum of rotated vectors.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/body.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "reconstruct/posture/pose_parameters.h"

namespace marey::reconstruct {

/// One posture: numbers in contiguous storage that solver blocks point into.
struct Posture {
  std::array<double, kPostureStorage> values{};

  Posture();
  [[nodiscard]] double* block(PoseParameter parameter) {
    return &values[offset(parameter)];
  }
  [[nodiscard]] const double* block(PoseParameter parameter) const {
    return &values[offset(parameter)];
  }

  [[nodiscard]] glm::dquat rotation(PoseParameter parameter) const;
  void set_rotation(PoseParameter parameter, const glm::dquat& world_from_bone);

 private:
  static constexpr std::size_t offset(PoseParameter parameter) {
    return static_cast<std::size_t>(storage_offset(parameter));
  }
};

/// Constants of a body that do not depend on the posture, in addition to lengths: the
/// height of the hips' own joint above the hip centres, which is a definition, and the
/// tilt of each limb's hinge.
struct BodyConstants {
  double hips_above_hip_centres_m = 0.0;
  std::array<HingeShape, 4> hinges{};  ///< In the order of human_limbs().
};

/// Converts lengths to rest offsets and back. `like` provides the offsets that lengths do
/// not determine: toes, tips.
[[nodiscard]] Proportions to_proportions(const Lengths& lengths,
                                         const BodyConstants& body,
                                         const Proportions& like);
[[nodiscard]] Lengths lengths_of(const Proportions& proportions);
/// Returns the length that is the distance of a bone's joint from its parent's; nullopt
/// for the hips, and for distances that the fit does not estimate.
[[nodiscard]] std::optional<Length> length_of(HumanBone bone);
[[nodiscard]] BodyConstants body_constants(const Proportions& proportions);
/// Returns the constants with the body's hinges; those of proportions alone are straight.
[[nodiscard]] BodyConstants body_constants(const Body& body);

/// A bone's frame in the world, for the solver's scalar type.
template <class T>
struct BoneFrame {
  Eigen::Quaternion<T> rotation;
  Eigen::Matrix<T, 3, 1> origin;
};

namespace detail {

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;

template <class T>
Eigen::Quaternion<T> about_axis(const glm::dvec3& axis, const T& angle_rad) {
  using std::cos;
  using std::sin;
  const T half = T(0.5) * angle_rad;
  const T s = sin(half);
  return Eigen::Quaternion<T>(cos(half), s * T(axis.x), s * T(axis.y), s * T(axis.z));
}

/// Returns the rotation half way between two, by the shorter way. Differentiable if they
/// are less than a full turn apart, which holds for vertebrae.
template <class T>
Eigen::Quaternion<T> halfway(const Eigen::Quaternion<T>& a,
                             const Eigen::Quaternion<T>& b) {
  Eigen::Matrix<T, 4, 1> sum;
  if (a.coeffs().dot(b.coeffs()) < T(0)) {
    sum = a.coeffs() - b.coeffs();
  } else {
    sum = a.coeffs() + b.coeffs();
  }
  return Eigen::Quaternion<T>(sum / sum.norm());
}

template <class T>
Vec3<T> vec(const glm::dvec3& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

/// Computes the frame of a limb's upper bone (`place` 0), lower bone (1) or extremity (2)
/// from root, triangle and extremity.
template <class T, class L>
BoneFrame<T> limb_bone(std::size_t limb,
                       int place,
                       const Vec3<T>& root,
                       std::span<const T* const, kPoseParameterCount> blocks,
                       const L* lengths,
                       const HingeShape& shape) {
  using Quaternion = Eigen::Quaternion<T>;
  using std::atan2;
  using std::cos;
  using std::sin;
  const LimbParameters& s = kLimbParameters[limb];
  const glm::dvec3 hinge = human_limbs()[limb].hinge_axis;
  const glm::dvec3 along = limb_axis(limb);
  const auto rotation = [&](PoseParameter parameter) {
    return Quaternion(Eigen::Map<const Quaternion>(blocks[index(parameter)]));
  };
  const T flexion = *blocks[index(s.flexion)];
  const T l1 = T(lengths[index(s.upper)]);
  const T l2 = T(lengths[index(s.lower)]);
  // The upper bone leans back by alpha and the lower forward by the rest of the flexion,
  // so that the end of a limb with a straight hinge stays on the frame's axis.
  const T alpha = atan2(l2 * sin(flexion), l1 + l2 * cos(flexion));
  const Quaternion frame = rotation(s.frame);
  const Quaternion upper = frame * about_axis(hinge, T(-alpha));
  if (place == 0) {
    return {upper * about_axis(along, *blocks[index(s.upper_twist)]), root};
  }
  const Vec3<T> back(T(0), T(0), T(-shape.rollback_m) * (T(1) - cos(flexion)));
  const Vec3<T> p_mid = root + upper * (vec<T>(along) * l1 + back);
  const glm::dvec3 tilted = tilt_axis(limb);
  const Quaternion lower = upper * about_axis(tilted, T(shape.upper_rad)) *
                           about_axis(hinge, flexion) *
                           about_axis(tilted, T(shape.lower_rad));
  if (place == 1) {
    return {lower * about_axis(along, *blocks[index(s.lower_twist)]), p_mid};
  }
  const Vec3<T> p_end = p_mid + lower * (vec<T>(along) * l2);
  return {rotation(s.extremity), p_end};
}

}  // namespace detail

/// Computes the forward kinematics of one bone.
/// `blocks[index(parameter)]` points at the posture's numbers; only those of
/// parameters_of(bone) are read. `lengths` points at kLengthCount numbers. T and L are
/// double or ceres::Jet.
template <class T, class L>
BoneFrame<T> bone_frame(HumanBone bone,
                        std::span<const T* const, kPoseParameterCount> blocks,
                        const L* lengths,
                        const BodyConstants& body) {
  using B = HumanBone;
  using Quaternion = Eigen::Quaternion<T>;
  using detail::Vec3;
  const auto rotation = [&](PoseParameter parameter) {
    return Quaternion(Eigen::Map<const Quaternion>(blocks[index(parameter)]));
  };
  const auto length = [&](Length which) { return T(lengths[index(which)]); };
  const auto up = [&](Length which) { return Vec3<T>(T(0), length(which), T(0)); };

  const Quaternion hips = rotation(PoseParameter::kHips);
  const Vec3<T> p_hips =
      Eigen::Map<const Vec3<T>>(blocks[index(PoseParameter::kHipsPosition)]);
  if (bone == B::kHips) return {hips, p_hips};

  const auto limb_bone = [&](std::size_t limb, const Vec3<T>& root, int place) {
    return detail::limb_bone<T, L>(limb, place, root, blocks, lengths, body.hinges[limb]);
  };
  const InLimb at = in_limb(bone);
  const bool left = at.limb == 0 || at.limb == 2 || bone == B::kLeftShoulder;
  const double side = left ? 1.0 : -1.0;
  if (at.limb == 2 || at.limb == 3) {
    const Vec3<T> hip(
        T(side) * length(Length::kHalfHipWidth), T(-body.hips_above_hip_centres_m), T(0));
    return limb_bone(at.limb, p_hips + hips * hip, at.place);
  }

  // Trunk: the abdomen's spline carries two bones, the torso's one.
  const Vec3<T> p_spine = p_hips + hips * up(Length::kSpine);
  const Quaternion chest = rotation(PoseParameter::kAbdomenEnd);
  const Quaternion spine = detail::halfway(hips, chest);
  if (bone == B::kSpine) return {spine, p_spine};
  const Vec3<T> p_chest = p_spine + spine * up(Length::kChest);
  if (bone == B::kChest) return {chest, p_chest};
  const Vec3<T> p_thorax = p_chest + chest * up(Length::kUpperChest);
  const Quaternion thorax = rotation(PoseParameter::kThorax);
  if (bone == B::kUpperChest) return {thorax, p_thorax};
  if (bone == B::kNeck || bone == B::kHead) {
    const Vec3<T> p_neck =
        p_thorax +
        thorax * Vec3<T>(T(0), length(Length::kNeck), length(Length::kNeckForward));
    const Quaternion neck = rotation(PoseParameter::kNeck);
    if (bone == B::kNeck) return {neck, p_neck};
    return {rotation(PoseParameter::kHead), p_neck + neck * up(Length::kHead)};
  }

  const Vec3<T> base(T(side) * length(Length::kShoulderOut),
                     length(Length::kShoulderUp),
                     length(Length::kShoulderForward));
  const Vec3<T> p_shoulder = p_thorax + thorax * base;
  const Quaternion shoulder =
      rotation(left ? PoseParameter::kLeftShoulder : PoseParameter::kRightShoulder);
  if (bone == B::kLeftShoulder || bone == B::kRightShoulder) {
    return {shoulder, p_shoulder};
  }
  const Length clavicle = left ? Length::kLeftShoulder : Length::kRightShoulder;
  const Vec3<T> root =
      p_shoulder + shoulder * Vec3<T>(T(side) * length(clavicle), T(0), T(0));
  return limb_bone(at.limb, root, at.place);
}

/// Computes bone_frame() of a whole posture, in double. Toes move with their foot.
[[nodiscard]] RigidTransform world_from_bone(HumanBone bone,
                                             const Posture& posture,
                                             const Lengths& lengths,
                                             const BodyConstants& body);

/// Copies the parameters of a limb, in the order of human_limbs().
void copy_limb(std::size_t limb, const Posture& from, Posture& to);

/// Converts the posture to a Pose of make_humanoid(proportions).
[[nodiscard]] Pose to_pose(const Posture& posture,
                           const Skeleton& skeleton,
                           const Lengths& lengths,
                           const BodyConstants& body);

}  // namespace marey::reconstruct
