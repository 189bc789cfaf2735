// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject_equations.h"

#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>

#include "core/assert.h"

namespace marey::reconstruct {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kFloor = 1e-9;  // Of a diagonal: what nothing determines stays put.

/// Which of the four limbs a posture's unknown belongs to; 4 of the trunk's.
std::size_t limb_of_column(int column) {
  for (std::size_t limb = 0; limb < 4; ++limb) {
    if (column >= kLimbColumn[limb] && column < kLimbColumn[limb] + kLimbFreedom[limb]) {
      return limb;
    }
  }
  return 4;
}

/// Directions and gains of a tag's slip from how the residuals follow a shift of it.
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

/// Scales what a slip explains to unit variance.
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
  const auto against = [&](Slot parent, Slot child) {
    return log_of(quaternion(posture, parent).conjugate() * quaternion(posture, child));
  };
  for (std::size_t limb = 0; limb < kLimbSlots.size(); ++limb) {
    const LimbSlots& s = kLimbSlots[limb];
    const HumanLimb& bones = human_limbs()[limb];
    const double flexion = *posture.block(s.flexion);
    if (bone == bones.upper) {
      const Vector3d r = against(limb < 2 ? Slot::kThorax : Slot::kHips, s.frame);
      return {flexion, r.x(), r.y(), r.z()};
    }
    if (bone == bones.lower) {
      const Eigen::Quaterniond lower(unfolded.rotation(bone));
      const Vector3d r = log_of(lower.conjugate() * quaternion(posture, s.extremity));
      return {flexion, *posture.block(s.lower_twist), r.x(), r.z()};
    }
  }
  if (bone == HumanBone::kHips) {
    return {against(Slot::kHips, Slot::kLeftLeg).x(),
            against(Slot::kHips, Slot::kRightLeg).x(),
            against(Slot::kHips, Slot::kThorax).x(),
            0.0};
  }
  if (bone == HumanBone::kUpperChest) {
    const Vector3d left = against(Slot::kThorax, Slot::kLeftArm);
    const Vector3d right = against(Slot::kThorax, Slot::kRightArm);
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

SubjectColumns::SubjectColumns(const BodyModel& model, bool slides)
    : of_tag_(model.tags.size(), -1), of_slide_(model.tags.size(), -1) {
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
    out.by_tag.block<2, 3>(row, 0) = -by_bone * cross_matrix(p_in_bone - place);
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

void FrameEquations::begin(std::vector<int> columns, int subject_size) {
  columns_ = std::move(columns);
  local_.assign(static_cast<std::size_t>(subject_size), -1);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    local_[static_cast<std::size_t>(columns_[i])] = static_cast<int>(i);
  }
  const auto count = static_cast<Eigen::Index>(columns_.size());
  posture.clear();
  cross_.setZero(kPostureFreedom, count);
  subject_.setZero(count, count);
  gradient_.setZero(count);
  for (auto& follows : follows_) follows.assign(columns_.size(), false);
}

void FrameEquations::add(const SightedTag& s,
                         int tag_column,
                         double weight,
                         int slide_column,
                         const SlideAngles* slides) {
  // All columns of the sighting side by side: the posture's, the shape's, the tag's.
  constexpr int kMost = 2 * SparseDerivative::kMost + 6 + kSlideColumns;
  Eigen::Matrix<double, 8, kMost> all;
  std::array<int, kMost> where{};
  const int own = s.posture_columns;
  int count = own;
  all.leftCols(own) = s.by_posture.leftCols(own);
  const auto subject = [&](int column) {
    return local_[static_cast<std::size_t>(column)];
  };
  std::size_t limb = 4;
  for (int i = 0; i < own; ++i) {
    where[static_cast<std::size_t>(i)] = s.posture_column[static_cast<std::size_t>(i)];
    limb = std::min(limb, limb_of_column(where[static_cast<std::size_t>(i)]));
  }
  const auto append = [&](const SightedTag::Vector8& column, int at) {
    all.col(count) = column;
    where[static_cast<std::size_t>(count++)] = at;
    if (limb < 4) follows_[limb][static_cast<std::size_t>(at)] = true;
  };
  for (int i = 0; i < s.shape_columns; ++i) {
    append(s.by_shape.col(i), subject(s.shape_column[static_cast<std::size_t>(i)]));
  }
  for (int i = 0; i < 6; ++i) append(s.by_tag.col(i), subject(tag_column + i));
  for (int i = 0; slides && i < kSlideColumns; ++i) {
    const double angle = (*slides)[static_cast<std::size_t>(i / 3)];
    append(angle * s.by_tag.col(3 + i % 3), subject(slide_column + i));
  }
  const SightedTag::Vector8 pull = weight * s.residual;
  for (int i = 0; i < count; ++i) {
    const int row = where[static_cast<std::size_t>(i)];
    const SightedTag::Vector8 weighed = weight * all.col(i);
    if (i < own) {
      posture.gradient[row] += all.col(i).dot(pull);
    } else {
      gradient_[row] += all.col(i).dot(pull);
    }
    for (int j = 0; j <= i; ++j) {
      const int at = where[static_cast<std::size_t>(j)];
      const double product = weighed.dot(all.col(j));
      if (i < own) {
        posture.hessian(std::max(row, at), std::min(row, at)) += product;
      } else if (j < own) {
        cross_(at, row) += product;
      } else {
        subject_(std::max(row, at), std::min(row, at)) += product;
      }
    }
  }
}

void FrameEquations::hold(std::span<const int> posture_columns) {
  for (const int column : posture_columns) {
    posture.hessian.row(column).setZero();
    posture.hessian.col(column).setZero();
    posture.hessian(column, column) = 1.0;
    posture.gradient[column] = 0.0;
    cross_.row(column).setZero();
  }
}

bool FrameEquations::eliminate_limb(std::size_t limb, double damping, MatrixXd& trunk) {
  Part& part = limbs_[limb];
  const int size = kLimbFreedom[limb];
  const int at = kLimbColumn[limb];
  part.columns.clear();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (follows_[limb][i]) part.columns.push_back(static_cast<int>(i));
  }
  const auto count = static_cast<Eigen::Index>(part.columns.size());
  MatrixXd own = posture.hessian.block(at, at, size, size);
  own.diagonal() *= 1.0 + damping;
  own.diagonal().array() += kFloor;
  part.own.compute(own);
  if (part.own.info() != Eigen::Success) return false;
  MatrixXd& all = part.solved;
  all.resize(size, kTrunkFreedom + count + 1);
  all.leftCols(kTrunkFreedom) =
      posture.hessian.block(kTrunkColumn, at, kTrunkFreedom, size).transpose();
  for (Eigen::Index i = 0; i < count; ++i) {
    all.col(kTrunkFreedom + i) =
        cross_.col(part.columns[static_cast<std::size_t>(i)]).segment(at, size);
  }
  all.rightCols(1) = posture.gradient.segment(at, size);
  part.own.matrixL().solveInPlace(all);
  // Of [trunk | the limb's columns | gradient], lower triangle.
  const MatrixXd explained = all.transpose() * all;
  trunk.topLeftCorner(kTrunkFreedom, kTrunkFreedom) -=
      explained.topLeftCorner(kTrunkFreedom, kTrunkFreedom);
  const auto last = kTrunkFreedom + count;
  trunk.rightCols(1) -= explained.col(last).head(kTrunkFreedom);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int column = part.columns[static_cast<std::size_t>(i)];
    trunk.col(kTrunkFreedom + column) -=
        explained.col(kTrunkFreedom + i).head(kTrunkFreedom);
    gradient_[column] -= explained(kTrunkFreedom + i, last);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const int other = part.columns[static_cast<std::size_t>(j)];
      subject_(std::max(column, other), std::min(column, other)) -=
          explained(kTrunkFreedom + i, kTrunkFreedom + j);
    }
  }
  return true;
}

bool FrameEquations::eliminate(double damping, MatrixXd& hessian, VectorXd& gradient) {
  const auto count = static_cast<Eigen::Index>(columns_.size());
  // [own | by subject | gradient] of the trunk.
  MatrixXd trunk(kTrunkFreedom, kTrunkFreedom + count + 1);
  trunk.leftCols(kTrunkFreedom) =
      posture.hessian.block<kTrunkFreedom, kTrunkFreedom>(kTrunkColumn, kTrunkColumn);
  trunk.middleCols(kTrunkFreedom, count) = cross_.middleRows(kTrunkColumn, kTrunkFreedom);
  trunk.rightCols(1) = posture.gradient.segment<kTrunkFreedom>(kTrunkColumn);
  const MatrixXd subject = subject_;
  const VectorXd pull = gradient_;
  trunk.leftCols(kTrunkFreedom).diagonal() *= 1.0 + damping;
  bool determined = true;
  for (std::size_t limb = 0; limb < 4 && determined; ++limb) {
    determined = eliminate_limb(limb, damping, trunk);
  }
  MatrixXd own = trunk.leftCols(kTrunkFreedom).triangularView<Eigen::Lower>();
  own.diagonal().array() += kFloor;
  if (determined) trunk_.own.compute(own);
  if (determined && trunk_.own.info() == Eigen::Success) {
    trunk_.solved = trunk.rightCols(count + 1);
    trunk_.own.matrixL().solveInPlace(trunk_.solved);
    const auto by_subject = trunk_.solved.leftCols(count);
    subject_.selfadjointView<Eigen::Lower>().rankUpdate(by_subject.transpose(), -1.0);
    gradient_ -= by_subject.transpose() * trunk_.solved.rightCols(1);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int row = columns_[static_cast<std::size_t>(i)];
      gradient[row] += gradient_[i];
      for (Eigen::Index j = 0; j <= i; ++j) {
        const int column = columns_[static_cast<std::size_t>(j)];
        hessian(std::max(row, column), std::min(row, column)) += subject_(i, j);
      }
    }
  } else {
    determined = false;
  }
  // Eliminated again with another damping.
  subject_ = subject;
  gradient_ = pull;
  return determined;
}

void FrameEquations::step(const VectorXd& subject, PostureVector& out) const {
  VectorXd own(static_cast<Eigen::Index>(columns_.size()));
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    own[static_cast<Eigen::Index>(i)] = subject[columns_[i]];
  }
  const auto count = own.size();
  Eigen::Matrix<double, kTrunkFreedom, 1> trunk =
      -(trunk_.solved.rightCols(1) + trunk_.solved.leftCols(count) * own);
  trunk_.own.matrixU().solveInPlace(trunk);
  out.segment<kTrunkFreedom>(kTrunkColumn) = trunk;
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const Part& part = limbs_[limb];
    VectorXd right =
        part.solved.rightCols(1) + part.solved.leftCols(kTrunkFreedom) * trunk;
    for (std::size_t i = 0; i < part.columns.size(); ++i) {
      right += part.solved.col(kTrunkFreedom + static_cast<Eigen::Index>(i)) *
               own[part.columns[i]];
    }
    right = -right;
    part.own.matrixU().solveInPlace(right);
    out.segment(kLimbColumn[limb], kLimbFreedom[limb]) = right;
  }
}

}  // namespace marey::reconstruct
