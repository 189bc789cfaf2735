// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/subject_sight.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/base/assert.h"
#include "core/base/cross_matrix.h"

namespace marey::reconstruct {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Computes directions and gains of a tag's slip from the derivative of the residuals by
/// a shift of the tag.
void set_slip(const Eigen::Matrix<double, 8, 3>& by_shift, SightedTag& out) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> spectrum(by_shift.transpose() * by_shift);
  for (int k = 0; k < 3; ++k) {
    const double gain = std::sqrt(std::max(0.0, spectrum.eigenvalues()[k]));
    out.slip_gains[k] = gain;
    if (gain < 1e-9) {
      out.slip_directions.col(k).setZero();
    } else {
      out.slip_directions.col(k) = by_shift * spectrum.eigenvectors().col(k) / gain;
    }
  }
}

/// Scales the part that a slip explains to unit variance.
template <class Derived>
void whiten(const Eigen::Matrix<double, 8, 3>& directions,
            const Vector3d& shrink,
            Eigen::MatrixBase<Derived>& rows) {
  for (int k = 0; k < 3; ++k) {
    if (shrink[k] == 0.0) continue;
    const Eigen::Matrix<double, 1, Eigen::Dynamic> along =
        shrink[k] * (directions.col(k).transpose() * rows);
    rows.noalias() -= directions.col(k) * along;
  }
}

}  // namespace

SlideAngles slide_angles(HumanBone bone,
                         const Posture& posture,
                         const UnfoldedPosture& unfolded) {
  const auto against = [&](PoseParameter parent, PoseParameter child) {
    return log_of(quaternion(posture, parent).conjugate() * quaternion(posture, child));
  };
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    const LimbParameters& s = kLimbParameters[limb];
    const HumanLimb& bones = human_limbs()[limb];
    const double flexion = *posture.block(s.flexion);
    if (bone == bones.upper) {
      const Vector3d r =
          against(limb < 2 ? PoseParameter::kThorax : PoseParameter::kHips, s.frame);
      return {flexion, r.x(), r.y(), r.z()};
    }
    if (bone == bones.lower) {
      const Eigen::Quaterniond lower(unfolded.rotation(bone));
      const Vector3d r = log_of(lower.conjugate() * quaternion(posture, s.extremity));
      return {flexion, *posture.block(s.lower_twist), r.x(), r.z()};
    }
  }
  if (bone == HumanBone::kHips) {
    return {against(PoseParameter::kHips, PoseParameter::kLeftLeg).x(),
            against(PoseParameter::kHips, PoseParameter::kRightLeg).x(),
            against(PoseParameter::kHips, PoseParameter::kThorax).x(),
            0.0};
  }
  if (bone == HumanBone::kUpperChest) {
    const Vector3d left = against(PoseParameter::kThorax, PoseParameter::kLeftArm);
    const Vector3d right = against(PoseParameter::kThorax, PoseParameter::kRightArm);
    return {left.y(), left.z(), right.y(), right.z()};
  }
  return {};
}

double slide_share(HumanBone bone) {
  using B = HumanBone;
  switch (bone) {
    case B::kLeftUpperLeg:
    case B::kRightUpperLeg:
      return 1.0;
    case B::kHips:
    case B::kSpine:
    case B::kChest:
    case B::kUpperChest:
    case B::kLeftShoulder:
    case B::kRightShoulder:
      return 0.5;
    case B::kLeftUpperArm:
    case B::kRightUpperArm:
    case B::kLeftLowerLeg:
    case B::kRightLowerLeg:
      return 0.4;
    case B::kLeftLowerArm:
    case B::kRightLowerArm:
      return 0.2;
    default:
      return 0.15;
  }
}

SlideGroup slide_group(HumanBone bone) {
  const InLimb where = in_limb(bone);
  if (where.limb == 4) return SlideGroup::kTrunk;
  return where.limb < 2 ? SlideGroup::kArms : SlideGroup::kLegs;
}

SubjectColumns::SubjectColumns(const BodyModel& model, bool slides)
    : of_tag_(model.tags.size()), of_slide_(model.tags.size()) {
  for (const auto& [tag, pose] : model.segment_from_tag) {
    of_tag_[tag] = size_;
    size_ += 6;
  }
  without_slides_ = size_;
  if (!slides) return;
  for (const auto& [tag, pose] : model.segment_from_tag) {
    of_slide_[tag] = size_;
    size_ += kSlideColumns;
  }
}

SubjectSight::SubjectSight(std::span<const Camera> cameras) {
  for (const Camera& camera : cameras) sights_.emplace_back(camera);
}

bool SubjectSight::look(const BodyModel& model,
                        const UnfoldedPosture& unfolded,
                        const TagSighting& sighting,
                        const SightingNoise& noise,
                        bool derivatives,
                        SightedTag& out) const {
  const RigidTransform* segment_from_tag = model.place(sighting.tag);
  MAREY_ASSERT(segment_from_tag);
  const HumanBone bone = model.bone(sighting.tag);
  const TagSight& sight = sights_[index(sighting.camera)];
  const double scale = 1.0 / (noise.scale * sighting.detection->sigma_px);
  const double size_m = model.tags[sighting.tag].size_m;
  const Matrix3d& world_from_bone = unfolded.rotation(bone);
  const Vector3d place = eigen(segment_from_tag->translation) + noise.slide_m;
  Eigen::Matrix<double, 8, 3> by_shift;
  SparseDerivative point;
  SparseDerivative shape;
  for (int c = 0; c < 4; ++c) {
    const Vector3d p_in_bone =
        eigen(*segment_from_tag * corner_in_tag(c, size_m)) + noise.slide_m;
    const Vector3d p_in_world = unfolded.point(bone, p_in_bone);
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> px_by_world;
    if (!sight.project(p_in_world, pixel, px_by_world)) return false;
    const glm::dvec2& seen = sighting.detection->corners_px[static_cast<std::size_t>(c)];
    const Eigen::Index row = 2 * c;
    out.residual.segment<2>(row) = scale * (pixel - Eigen::Vector2d(seen.x, seen.y));
    by_shift.middleRows<2>(row) = scale * px_by_world;
    if (!derivatives) continue;
    const auto by_world = by_shift.middleRows<2>(row);
    unfolded.derivative(bone, p_in_world, point);
    out.by_posture.middleRows<2>(row).leftCols(point.columns).noalias() =
        by_world.lazyProduct(point.value.leftCols(point.columns));
    unfolded.shape_derivative(bone, p_in_world, shape);
    out.by_shape.middleRows<2>(row).leftCols(shape.columns).noalias() =
        by_world.lazyProduct(shape.value.leftCols(shape.columns));
    const Eigen::Matrix<double, 2, 3> by_bone = by_world * world_from_bone;
    out.by_tag.block<2, 3>(row, 0) = -by_bone * cross_matrix<Matrix3d>(p_in_bone - place);
    out.by_tag.block<2, 3>(row, 3) = by_bone;
  }
  out.posture_columns = derivatives ? point.columns : 0;
  out.posture_column = point.column;
  out.shape_columns = derivatives ? shape.columns : 0;
  out.shape_column = shape.column;
  set_slip(by_shift, out);
  if (noise.slip_m <= 0.0) return true;
  const Eigen::Array3d stretch =
      (1.0 + (noise.slip_m * out.slip_gains.array()).square()).sqrt();
  const Vector3d shrink = 1.0 - stretch.inverse();
  whiten(out.slip_directions, shrink, out.residual);
  if (!derivatives) return true;
  auto by_posture = out.by_posture.leftCols(out.posture_columns);
  whiten(out.slip_directions, shrink, by_posture);
  auto by_shape = out.by_shape.leftCols(out.shape_columns);
  whiten(out.slip_directions, shrink, by_shape);
  whiten(out.slip_directions, shrink, out.by_tag);
  return true;
}

}  // namespace marey::reconstruct
