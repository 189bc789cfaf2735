// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/subject_equations.h"

#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/assert.h"

namespace marey::reconstruct {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kFloor = 1e-9;  // Share of the diagonal that is added: unknowns without
                                 // information stay unchanged.

/// Returns the limb of a posture's unknown; 4 for the trunk's.
std::size_t limb_of_column(int column) {
  for (std::size_t limb = 0; limb < 4; ++limb) {
    if (column >= kLimbColumn[limb] && column < kLimbColumn[limb] + kLimbFreedom[limb]) {
      return limb;
    }
  }
  return 4;
}

}  // namespace

void FrameEquations::begin(std::vector<int> columns,
                           std::vector<FrameSlide> slides,
                           int subject_size) {
  columns_ = std::move(columns);
  slides_ = std::move(slides);
  local_.assign(static_cast<std::size_t>(subject_size), -1);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    local_[static_cast<std::size_t>(columns_[i])] = static_cast<int>(i);
  }
  targets_.clear();
  first_target_.clear();
  for (const int column : columns_) {
    first_target_.push_back(targets_.size());
    targets_.push_back({column, 1.0});
    for (const FrameSlide& slide : slides_) {
      const int axis = column - slide.tag_column - 3;
      if (axis < 0 || axis >= 3) continue;
      for (int i = 0; i < kSlideAngles; ++i) {
        targets_.push_back({slide.slide_column + 3 * i + axis,
                            slide.factors[static_cast<std::size_t>(i)]});
      }
    }
  }
  first_target_.push_back(targets_.size());
  const auto count = static_cast<Eigen::Index>(columns_.size());
  posture.clear();
  cross_.setZero(kPostureFreedom, count);
  subject_.setZero(count, count);
  gradient_.setZero(count);
  for (auto& follows : follows_) follows.assign(columns_.size(), false);
  for (Pull& by_root : posture_by_root_) by_root.setZero();
  for (MatrixXd& by_root : subject_by_root_) by_root.setZero(count, 3);
}

void FrameEquations::add(const SightedTag& s, int tag_column, double weight) {
  // All columns of the sighting side by side: the posture's, the shape's, the tag's.
  constexpr int kMax = 2 * SparseDerivative::kMax + 6;
  Eigen::Matrix<double, 8, kMax> all;
  std::array<int, kMax> where{};
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
  const SightedTag::Vector8 pull = weight * s.residual;
  // The first three columns are a shift of the whole body.
  const Eigen::Matrix<double, 8, 3> shift = s.by_posture.leftCols<3>();
  for (int i = 0; i < count; ++i) {
    const int row = where[static_cast<std::size_t>(i)];
    const SightedTag::Vector8 weighted = weight * all.col(i);
    if (limb < 4 && i < own) {
      posture_by_root_[limb].row(row) += weighted.transpose() * shift;
    } else if (limb < 4) {
      subject_by_root_[limb].row(row) += weighted.transpose() * shift;
    }
    if (i < own) {
      posture.gradient[row] += all.col(i).dot(pull);
    } else {
      gradient_[row] += all.col(i).dot(pull);
    }
    for (int j = 0; j <= i; ++j) {
      const int at = where[static_cast<std::size_t>(j)];
      const double product = weighted.dot(all.col(j));
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
  // [trunk | the limb's columns | gradient], lower triangle.
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
  // The trunk's [own | by subject | gradient].
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
    add_to(hessian, gradient);
  } else {
    determined = false;
  }
  // A second elimination may use another damping.
  subject_ = subject;
  gradient_ = pull;
  return determined;
}

/// Adds the frame's part of the subject's equations to them.
void FrameEquations::add_to(MatrixXd& hessian, VectorXd& gradient) const {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (const Target& to : targets_of(i)) {
      gradient[to.column] += to.factor * gradient_[row];
      for (std::size_t j = 0; j < i; ++j) {
        const double value = to.factor * subject_(row, static_cast<Eigen::Index>(j));
        for (const Target& other : targets_of(j)) {
          hessian(std::max(to.column, other.column), std::min(to.column, other.column)) +=
              value * other.factor;
        }
      }
      for (const Target& other : targets_of(i)) {
        if (other.column > to.column) continue;
        hessian(to.column, other.column) += to.factor * other.factor * subject_(row, row);
      }
    }
  }
}

void FrameEquations::step(const VectorXd& subject, PostureVector& out) const {
  VectorXd own(static_cast<Eigen::Index>(columns_.size()));
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    double sum = 0.0;
    for (const Target& to : targets_of(i)) sum += to.factor * subject[to.column];
    own[static_cast<Eigen::Index>(i)] = sum;
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

/// Adds the change of the subject's gradient after the posture has responded to a
/// gradient of its own.
void FrameEquations::add_pull(const Pull& pull, MatrixXd& local) const {
  const auto count = static_cast<Eigen::Index>(columns_.size());
  Eigen::Matrix<double, kTrunkFreedom, 3> trunk =
      pull.middleRows<kTrunkFreedom>(kTrunkColumn);
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const Part& part = limbs_[limb];
    MatrixXd own = pull.middleRows(kLimbColumn[limb], kLimbFreedom[limb]);
    if (own.isZero(0.0)) continue;
    part.own.matrixL().solveInPlace(own);
    trunk -= part.solved.leftCols(kTrunkFreedom).transpose() * own;
    for (std::size_t i = 0; i < part.columns.size(); ++i) {
      local.col(part.columns[i]) -=
          own.transpose() * part.solved.col(kTrunkFreedom + static_cast<Eigen::Index>(i));
    }
  }
  trunk_.own.matrixL().solveInPlace(trunk);
  local -= trunk.transpose() * trunk_.solved.leftCols(count);
}

/// Adds local columns to those of the subject.
void FrameEquations::spread(const MatrixXd& local, MatrixXd& out) const {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    for (const Target& to : targets_of(i)) {
      out.col(to.column) += to.factor * local.col(static_cast<Eigen::Index>(i));
    }
  }
}

void FrameEquations::add_response(const SparseDerivative& by_posture,
                                  const SparseDerivative& by_shape,
                                  MatrixXd& out) const {
  // The point's derivative by the posture, transposed, goes back through the elimination.
  Pull pull = Pull::Zero();
  for (int i = 0; i < by_posture.columns; ++i) {
    pull.row(by_posture.column[static_cast<std::size_t>(i)]) =
        by_posture.value.col(i).transpose();
  }
  MatrixXd local = MatrixXd::Zero(3, static_cast<Eigen::Index>(columns_.size()));
  add_pull(pull, local);
  spread(local, out);
  for (int i = 0; i < by_shape.columns; ++i) {
    out.col(by_shape.column[static_cast<std::size_t>(i)]) += by_shape.value.col(i);
  }
}

void FrameEquations::add_root_shift(std::size_t limb,
                                    const Matrix3d& shifts_in_world,
                                    MatrixXd& out) const {
  MatrixXd local = (subject_by_root_[limb] * shifts_in_world).transpose();
  add_pull(posture_by_root_[limb] * shifts_in_world, local);
  spread(local, out);
}

}  // namespace marey::reconstruct
