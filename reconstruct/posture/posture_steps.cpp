// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/posture_steps.h"

#include <cmath>

namespace marey::reconstruct {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond turn_by(const Vector3d& v) {
  const double angle = v.norm();
  if (angle < 1e-12) return Quaterniond(1.0, 0.5 * v.x(), 0.5 * v.y(), 0.5 * v.z());
  return Quaterniond(Eigen::AngleAxisd(angle, v / angle));
}

Vector3d log_of(Quaterniond q) {
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const double sine = q.vec().norm();
  if (sine < 1e-12) return 2.0 * q.vec();
  return q.vec() * (2.0 * std::atan2(sine, q.w()) / sine);
}

void move(Posture& posture, const PostureVector& step) {
  for (const PoseParameter parameter : kAllPoseParameters) {
    const int column = column_of(parameter);
    double* block = posture.block(parameter);
    if (!is_rotation(parameter)) {
      for (int i = 0; i < block_size(parameter); ++i) block[i] += step[column + i];
      continue;
    }
    const Quaterniond q =
        (turn_by(step.segment<3>(column)) * quaternion(posture, parameter)).normalized();
    Eigen::Map<Eigen::Vector4d>(block, 4) = q.coeffs();
  }
}

PostureVector step_between(const Posture& from, const Posture& to) {
  PostureVector step;
  for (const PoseParameter parameter : kAllPoseParameters) {
    const int column = column_of(parameter);
    if (is_rotation(parameter)) {
      step.segment<3>(column) =
          log_of(quaternion(to, parameter) * quaternion(from, parameter).conjugate());
      continue;
    }
    for (int i = 0; i < block_size(parameter); ++i) {
      step[column + i] = to.block(parameter)[i] - from.block(parameter)[i];
    }
  }
  return step;
}

LimbLean lean_of(std::size_t limb, double flexion, const Lengths& lengths) {
  const double l1 = lengths[index(kLimbParameters[limb].upper)];
  const double l2 = lengths[index(kLimbParameters[limb].lower)];
  const double cosine = std::cos(flexion);
  const double reach2 = l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * cosine;
  LimbLean lean;
  lean.rad = std::atan2(l2 * std::sin(flexion), l1 + l2 * cosine);
  // A fully folded limb of two equal bones has no direction.
  if (reach2 > 1e-12) lean.rate = l2 * (l2 + l1 * cosine) / reach2;
  return lean;
}

namespace {

Quaterniond upper_of(const Posture& posture, std::size_t limb, const Lengths& lengths) {
  const double flexion = *posture.block(kLimbParameters[limb].flexion);
  return quaternion(posture, kLimbParameters[limb].frame) *
         detail::about_axis(human_limbs()[limb].hinge_axis,
                            -lean_of(limb, flexion, lengths).rad);
}

}  // namespace

void move_bones(Posture& posture, const PostureVector& step, const Lengths& lengths) {
  std::array<Quaterniond, 4> upper;
  for (std::size_t limb = 0; limb < 4; ++limb) {
    upper[limb] = upper_of(posture, limb, lengths);
  }
  move(posture, step);
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const LimbParameters& s = kLimbParameters[limb];
    const double flexion = *posture.block(s.flexion);
    const Quaterniond frame =
        (turn_by(step.segment<3>(column_of(s.frame))) * upper[limb] *
         detail::about_axis(human_limbs()[limb].hinge_axis,
                            lean_of(limb, flexion, lengths).rad))
            .normalized();
    Eigen::Map<Eigen::Vector4d>(posture.block(s.frame), 4) = frame.coeffs();
  }
}

PostureVector bone_step_between(const Posture& from,
                                const Posture& to,
                                const Lengths& lengths) {
  PostureVector step = step_between(from, to);
  for (std::size_t limb = 0; limb < 4; ++limb) {
    step.segment<3>(column_of(kLimbParameters[limb].frame)) =
        log_of(upper_of(to, limb, lengths) * upper_of(from, limb, lengths).conjugate());
  }
  return step;
}

Vector3d upper_by_flexion(const Posture& posture,
                          std::size_t limb,
                          const Lengths& lengths) {
  const LimbParameters& s = kLimbParameters[limb];
  const double rate = lean_of(limb, *posture.block(s.flexion), lengths).rate;
  return -rate * (quaternion(posture, s.frame) * eigen(human_limbs()[limb].hinge_axis));
}

}  // namespace marey::reconstruct
