// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/posture_derivatives.h"

#include <cmath>

#include "core/base/assert.h"
#include "core/base/cross_matrix.h"

namespace marey::reconstruct {

using B = HumanBone;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

void SparseDerivative::add(int first_column, const Matrix3d& block) {
  MAREY_ASSERT(columns + 3 <= kMax);
  for (int i = 0; i < 3; ++i) {
    column[static_cast<std::size_t>(columns + i)] = first_column + i;
    value.col(columns + i) = block.col(i);
  }
  columns += 3;
}

void SparseDerivative::add(int at_column, const Vector3d& block) {
  MAREY_ASSERT(columns < kMax);
  column[static_cast<std::size_t>(columns)] = at_column;
  value.col(columns) = block;
  columns += 1;
}

Matrix3d inverse_left_jacobian(const Vector3d& r) {
  const double angle2 = r.squaredNorm();
  const Matrix3d k = cross_matrix<Matrix3d>(r);
  // 1/a^2 - (1 + cos a) / (2 a sin a), whose series starts with 1/12 + a^2/720.
  double c = 1.0 / 12.0 + angle2 / 720.0;
  if (angle2 > 1e-4) {
    const double a = std::sqrt(angle2);
    const double sine = std::sin(a);
    // 0 / 0 at half a turn, where it goes to 1 / pi^2.
    c = std::abs(sine) < 1e-6 ? 1.0 / angle2
                              : 1.0 / angle2 - (1.0 + std::cos(a)) / (2.0 * a * sine);
  }
  return Matrix3d::Identity() - 0.5 * k + c * k * k;
}

HalfwayDerivative halfway_derivative(const Quaterniond& lower, const Quaterniond& upper) {
  const Quaterniond half = detail::halfway<double>(lower, upper);
  const Matrix3d h = lower.toRotationMatrix();
  // half = lower s with s s = lower^-1 upper, so that (1 + S) ds = d(lower^-1 upper).
  const Matrix3d s = (lower.conjugate() * half).toRotationMatrix();
  const Matrix3d by_upper = h * (Matrix3d::Identity() + s).inverse() * h.transpose();
  return {Matrix3d::Identity() - by_upper, by_upper};
}

void UnfoldedPosture::unfold(const Posture& posture,
                             const Lengths& lengths,
                             const BodyConstants& body) {
  unfold_trunk(posture, lengths);
  const Bone& hips = bones_[index(B::kHips)];
  const Bone& thorax = bones_[index(B::kUpperChest)];
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const double side = limb % 2 == 0 ? 1.0 : -1.0;
    if (limb >= 2) {
      const Vector3d hip(side * lengths[index(Length::kHalfHipWidth)],
                         -body.hips_above_hip_centres_m,
                         0.0);
      unfold_limb(
          limb, hips.origin + hips.rotation * hip, posture, lengths, body.hinges[limb]);
      continue;
    }
    Bone& shoulder = bones_[index(limb == 0 ? B::kLeftShoulder : B::kRightShoulder)];
    const Vector3d base(side * lengths[index(Length::kShoulderOut)],
                        lengths[index(Length::kShoulderUp)],
                        lengths[index(Length::kShoulderForward)]);
    shoulder.origin = thorax.origin + thorax.rotation * base;
    shoulder.rotation = quaternion(posture,
                                   limb == 0 ? PoseParameter::kLeftShoulder
                                             : PoseParameter::kRightShoulder)
                            .toRotationMatrix();
    const double clavicle =
        lengths[index(limb == 0 ? Length::kLeftShoulder : Length::kRightShoulder)];
    const Vector3d root = shoulder.origin + side * clavicle * shoulder.rotation.col(0);
    unfold_limb(limb, root, posture, lengths, body.hinges[limb]);
  }
}

void UnfoldedPosture::unfold_trunk(const Posture& posture, const Lengths& lengths) {
  const auto length = [&](Length which) { return lengths[index(which)]; };
  const auto set = [&](B bone, const Matrix3d& rotation, const Vector3d& origin) {
    bones_[index(bone)] = {rotation, origin};
  };
  const Quaterniond q_hips = quaternion(posture, PoseParameter::kHips);
  const Quaterniond q_abdomen = quaternion(posture, PoseParameter::kAbdomenEnd);
  const Matrix3d hips = q_hips.toRotationMatrix();
  const Matrix3d spine = detail::halfway<double>(q_hips, q_abdomen).toRotationMatrix();
  const Matrix3d chest = q_abdomen.toRotationMatrix();
  const Matrix3d thorax = quaternion(posture, PoseParameter::kThorax).toRotationMatrix();
  const Matrix3d neck = quaternion(posture, PoseParameter::kNeck).toRotationMatrix();
  const Vector3d p_hips =
      Eigen::Map<const Vector3d>(posture.block(PoseParameter::kHipsPosition));
  const Vector3d to_spine = length(Length::kSpine) * hips.col(1);
  const Vector3d to_chest = length(Length::kChest) * spine.col(1);
  const Vector3d to_thorax = length(Length::kUpperChest) * chest.col(1);
  set(B::kHips, hips, p_hips);
  set(B::kSpine, spine, p_hips + to_spine);
  set(B::kChest, chest, p_hips + to_spine + to_chest);
  const Vector3d p_thorax = p_hips + to_spine + to_chest + to_thorax;
  set(B::kUpperChest, thorax, p_thorax);
  const Vector3d p_neck = p_thorax + length(Length::kNeck) * thorax.col(1) +
                          length(Length::kNeckForward) * thorax.col(2);
  set(B::kNeck, neck, p_neck);
  set(B::kHead,
      quaternion(posture, PoseParameter::kHead).toRotationMatrix(),
      p_neck + length(Length::kHead) * neck.col(1));

  const HalfwayDerivative half = halfway_derivative(q_hips, q_abdomen);
  spine_by_hips_ = half.by_lower;
  spine_by_abdomen_ = half.by_upper;
  chest_by_hips_ = -cross_matrix<Matrix3d>(to_spine) -
                   cross_matrix<Matrix3d>(to_chest) * half.by_lower;
  chest_by_abdomen_ = -cross_matrix<Matrix3d>(to_chest) * half.by_upper;
  thorax_by_hips_ = chest_by_hips_;
  thorax_by_abdomen_ = chest_by_abdomen_ - cross_matrix<Matrix3d>(to_thorax);
}

void UnfoldedPosture::unfold_limb(std::size_t limb,
                                  const Vector3d& root,
                                  const Posture& posture,
                                  const Lengths& lengths,
                                  const HingeShape& shape) {
  const LimbParameters& s = kLimbParameters[limb];
  const HumanLimb& bones = human_limbs()[limb];
  const glm::dvec3 along = limb_axis(limb);
  const double flexion = *posture.block(s.flexion);
  const double l1 = lengths[index(s.upper)];
  const double l2 = lengths[index(s.lower)];
  const auto [alpha, lean_rate] = lean_of(limb, flexion, lengths);
  const Quaterniond frame = quaternion(posture, s.frame);
  const glm::dvec3 tilted = tilt_axis(limb);
  const Quaterniond q_upper = frame * detail::about_axis(bones.hinge_axis, -alpha);
  const Quaterniond q_hinge = q_upper * detail::about_axis(tilted, shape.upper_rad);
  const Quaterniond q_bent = q_hinge * detail::about_axis(bones.hinge_axis, flexion);
  const Matrix3d upper = q_upper.toRotationMatrix();
  const Matrix3d lower =
      (q_bent * detail::about_axis(tilted, shape.lower_rad)).toRotationMatrix();
  Limb& own = limbs_[limb];
  own.lean_axis_in_world = frame * eigen(bones.hinge_axis);
  own.hinge_in_world = q_hinge * eigen(bones.hinge_axis);
  own.upper_tilt_in_world = q_upper * eigen(tilted);
  own.lower_tilt_in_world = q_bent * eigen(tilted);
  own.upper_axis_in_world = upper * eigen(along);
  own.lower_axis_in_world = lower * eigen(along);
  own.lean_rate = lean_rate;
  const double reach2 = l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * std::cos(flexion);
  // A fully folded limb of two equal bones has no direction.
  const double by_sine = reach2 > 1e-12 ? std::sin(flexion) / reach2 : 0.0;
  own.lean_by_upper = -l2 * by_sine;
  own.lean_by_lower = l1 * by_sine;
  own.back_in_world = -upper.col(2);
  own.rolled = 1.0 - std::cos(flexion);
  own.rolled_rate = std::sin(flexion);
  own.rollback_m = shape.rollback_m;
  const Vector3d p_mid = root + l1 * own.upper_axis_in_world +
                         shape.rollback_m * own.rolled * own.back_in_world;
  const auto twist = [&](PoseParameter parameter) {
    return detail::about_axis(along, *posture.block(parameter)).toRotationMatrix();
  };
  bones_[index(bones.upper)] = {upper * twist(s.upper_twist), root};
  bones_[index(bones.lower)] = {lower * twist(s.lower_twist), p_mid};
  bones_[index(bones.end)] = {quaternion(posture, s.extremity).toRotationMatrix(),
                              p_mid + l2 * own.lower_axis_in_world};
  if (bones.end == B::kLeftFoot || bones.end == B::kRightFoot) {
    // Toes move with their foot.
    bones_[index(bones.end == B::kLeftFoot ? B::kLeftToes : B::kRightToes)] =
        bones_[index(bones.end)];
  }
}

void UnfoldedPosture::thorax_base(SparseDerivative& out) const {
  out.add(column_of(PoseParameter::kHipsPosition), Matrix3d(Matrix3d::Identity()));
  out.add(column_of(PoseParameter::kHips), thorax_by_hips_);
  out.add(column_of(PoseParameter::kAbdomenEnd), thorax_by_abdomen_);
}

void UnfoldedPosture::limb_derivative(std::size_t limb,
                                      int place,
                                      const Vector3d& p,
                                      SparseDerivative& out) const {
  const LimbParameters& s = kLimbParameters[limb];
  const HumanLimb& bones = human_limbs()[limb];
  const Limb& own = limbs_[limb];
  const Vector3d& root = origin(bones.upper);
  const Vector3d& mid = origin(bones.lower);
  const Vector3d& end = origin(bones.end);
  // The part that turns with the limb's frame, and the part of it that its lower bone
  // carries.
  const Vector3d carried = place == 2 ? end : p;
  out.add(column_of(s.frame), Matrix3d(-cross_matrix<Matrix3d>(carried - root)));
  const Vector3d by_upper = place == 0 ? Vector3d(p - root) : Vector3d(mid - root);
  const Vector3d by_lower = place == 0 ? Vector3d::Zero() : Vector3d(carried - mid);
  Vector3d by_flexion = own.hinge_in_world.cross(by_lower) -
                        own.lean_rate * own.lean_axis_in_world.cross(by_upper + by_lower);
  if (place > 0) by_flexion += own.rollback_m * own.rolled_rate * own.back_in_world;
  out.add(column_of(s.flexion), by_flexion);
  if (place == 0) {
    out.add(column_of(s.upper_twist), Vector3d(own.upper_axis_in_world.cross(p - root)));
  } else if (place == 1) {
    out.add(column_of(s.lower_twist), Vector3d(own.lower_axis_in_world.cross(p - mid)));
  } else {
    out.add(column_of(s.extremity), Matrix3d(-cross_matrix<Matrix3d>(p - end)));
  }
}

void UnfoldedPosture::limb_shape_derivative(std::size_t limb,
                                            int place,
                                            const Vector3d& p,
                                            SparseDerivative& out) const {
  const LimbParameters& s = kLimbParameters[limb];
  const HumanLimb& bones = human_limbs()[limb];
  const Limb& own = limbs_[limb];
  // Both bones lean back about the hinge; the extremity's own rotation stays.
  const Vector3d carried = place == 2 ? origin(bones.end) : p;
  const Vector3d by_lean = -own.lean_axis_in_world.cross(carried - origin(bones.upper));
  Vector3d by_upper = own.lean_by_upper * by_lean;
  Vector3d by_lower = own.lean_by_lower * by_lean;
  if (place >= 1) by_upper += own.upper_axis_in_world;
  if (place == 2) by_lower += own.lower_axis_in_world;
  out.add(static_cast<int>(s.upper), by_upper);
  out.add(static_cast<int>(s.lower), by_lower);
  if (place == 0) return;
  const Vector3d from_mid = carried - origin(bones.lower);
  out.add(hinge_column(limb), Vector3d(own.upper_tilt_in_world.cross(from_mid)));
  out.add(hinge_column(limb) + 1, Vector3d(own.lower_tilt_in_world.cross(from_mid)));
  out.add(hinge_column(limb) + 2, Vector3d(own.rolled * own.back_in_world));
}

void UnfoldedPosture::shape_derivative(HumanBone bone,
                                       const Vector3d& p,
                                       SparseDerivative& out) const {
  out.clear();
  const auto add = [&](Length length, const Vector3d& direction) {
    out.add(static_cast<int>(length), direction);
  };
  const InLimb where = in_limb(bone);
  const double side = where.limb % 2 == 0 ? 1.0 : -1.0;
  if (where.limb == 2 || where.limb == 3) {
    add(Length::kHalfHipWidth, side * rotation(B::kHips).col(0));
    return limb_shape_derivative(where.limb, where.place, p, out);
  }
  if (bone == B::kHips) return;
  add(Length::kSpine, rotation(B::kHips).col(1));
  if (bone == B::kSpine) return;
  add(Length::kChest, rotation(B::kSpine).col(1));
  if (bone == B::kChest) return;
  add(Length::kUpperChest, rotation(B::kChest).col(1));
  if (bone == B::kUpperChest) return;
  const Matrix3d& thorax = rotation(B::kUpperChest);
  if (bone == B::kNeck || bone == B::kHead) {
    add(Length::kNeck, thorax.col(1));
    add(Length::kNeckForward, thorax.col(2));
    if (bone == B::kHead) add(Length::kHead, rotation(B::kNeck).col(1));
    return;
  }
  const bool left = bone == B::kLeftShoulder || where.limb == 0;
  const double outward = left ? 1.0 : -1.0;
  add(Length::kShoulderOut, outward * thorax.col(0));
  add(Length::kShoulderUp, thorax.col(1));
  add(Length::kShoulderForward, thorax.col(2));
  if (where.limb == 4) return;
  const B shoulder = left ? B::kLeftShoulder : B::kRightShoulder;
  add(left ? Length::kLeftShoulder : Length::kRightShoulder,
      outward * rotation(shoulder).col(0));
  limb_shape_derivative(where.limb, where.place, p, out);
}

void UnfoldedPosture::derivative(HumanBone bone,
                                 const Vector3d& p,
                                 SparseDerivative& out) const {
  out.clear();
  const Matrix3d identity = Matrix3d::Identity();
  const Vector3d& p_hips = origin(B::kHips);
  const InLimb where = in_limb(bone);
  if (where.limb == 2 || where.limb == 3) {
    const Vector3d& root = origin(human_limbs()[where.limb].upper);
    out.add(column_of(PoseParameter::kHipsPosition), identity);
    out.add(column_of(PoseParameter::kHips),
            Matrix3d(-cross_matrix<Matrix3d>(root - p_hips)));
    limb_derivative(where.limb, where.place, p, out);
    return;
  }
  if (bone == B::kHips) {
    out.add(column_of(PoseParameter::kHipsPosition), identity);
    out.add(column_of(PoseParameter::kHips),
            Matrix3d(-cross_matrix<Matrix3d>(p - p_hips)));
    return;
  }
  if (bone == B::kSpine) {
    const Matrix3d turned = cross_matrix<Matrix3d>(p - origin(bone));
    out.add(column_of(PoseParameter::kHipsPosition), identity);
    out.add(column_of(PoseParameter::kHips),
            Matrix3d(-cross_matrix<Matrix3d>(origin(bone) - p_hips) -
                     turned * spine_by_hips_));
    out.add(column_of(PoseParameter::kAbdomenEnd), Matrix3d(-turned * spine_by_abdomen_));
    return;
  }
  if (bone == B::kChest) {
    out.add(column_of(PoseParameter::kHipsPosition), identity);
    out.add(column_of(PoseParameter::kHips), chest_by_hips_);
    out.add(column_of(PoseParameter::kAbdomenEnd),
            Matrix3d(chest_by_abdomen_ - cross_matrix<Matrix3d>(p - origin(bone))));
    return;
  }
  thorax_base(out);
  const Vector3d& p_thorax = origin(B::kUpperChest);
  const auto carried_by_thorax = [&](const Vector3d& what) {
    out.add(column_of(PoseParameter::kThorax),
            Matrix3d(-cross_matrix<Matrix3d>(what - p_thorax)));
  };
  if (bone == B::kUpperChest) return carried_by_thorax(p);
  if (bone == B::kNeck || bone == B::kHead) {
    const Vector3d& p_neck = origin(B::kNeck);
    carried_by_thorax(p_neck);
    const Vector3d& by_neck = bone == B::kNeck ? p : origin(B::kHead);
    out.add(column_of(PoseParameter::kNeck),
            Matrix3d(-cross_matrix<Matrix3d>(by_neck - p_neck)));
    if (bone == B::kHead) {
      out.add(column_of(PoseParameter::kHead),
              Matrix3d(-cross_matrix<Matrix3d>(p - origin(B::kHead))));
    }
    return;
  }
  const bool left = bone == B::kLeftShoulder || where.limb == 0;
  const Vector3d& p_shoulder = origin(left ? B::kLeftShoulder : B::kRightShoulder);
  carried_by_thorax(p_shoulder);
  const Vector3d& by_shoulder =
      where.limb == 4 ? p : origin(human_limbs()[where.limb].upper);
  out.add(column_of(left ? PoseParameter::kLeftShoulder : PoseParameter::kRightShoulder),
          Matrix3d(-cross_matrix<Matrix3d>(by_shoulder - p_shoulder)));
  if (where.limb < 2) limb_derivative(where.limb, where.place, p, out);
}

void UnfoldedPosture::turn_derivative(HumanBone bone, SparseDerivative& out) const {
  out.clear();
  const Matrix3d identity = Matrix3d::Identity();
  const InLimb where = in_limb(bone);
  if (where.limb < 4) {
    const LimbParameters& s = kLimbParameters[where.limb];
    if (where.place == 2) return out.add(column_of(s.extremity), identity);
    const Limb& own = limbs_[where.limb];
    const bool upper = where.place == 0;
    out.add(column_of(s.frame), identity);
    Vector3d by_flexion = -own.lean_rate * own.lean_axis_in_world;
    if (!upper) by_flexion += own.hinge_in_world;
    out.add(column_of(s.flexion), by_flexion);
    out.add(column_of(upper ? s.upper_twist : s.lower_twist),
            upper ? own.upper_axis_in_world : own.lower_axis_in_world);
    return;
  }
  switch (bone) {
    case B::kHips:
      return out.add(column_of(PoseParameter::kHips), identity);
    case B::kSpine:
      out.add(column_of(PoseParameter::kHips), spine_by_hips_);
      return out.add(column_of(PoseParameter::kAbdomenEnd), spine_by_abdomen_);
    case B::kChest:
      return out.add(column_of(PoseParameter::kAbdomenEnd), identity);
    case B::kUpperChest:
      return out.add(column_of(PoseParameter::kThorax), identity);
    case B::kNeck:
      return out.add(column_of(PoseParameter::kNeck), identity);
    case B::kHead:
      return out.add(column_of(PoseParameter::kHead), identity);
    case B::kLeftShoulder:
      return out.add(column_of(PoseParameter::kLeftShoulder), identity);
    default:
      return out.add(column_of(PoseParameter::kRightShoulder), identity);
  }
}

}  // namespace marey::reconstruct
