// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/pose_parameter_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "reconstruct/posture/pose_parameter_sizes.h"

namespace marey::reconstruct {
namespace {

using Eigen::Matrix3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Initial uncertainty of a posture that was found without a prior. [rad], [m]
constexpr double kFirstSigma = 0.3;

}  // namespace

PoseParameterProcess::PoseParameterProcess(const Lengths& lengths,
                                           FrameRate rate,
                                           const ProcessNoiseOptions& noise)
    : lengths_(lengths), noise_(noise) {
  set_rate(rate);
}

void PoseParameterProcess::set_rate(FrameRate rate) {
  rate_ = rate;
  prior_share_ = std::min(1.0, 1.0 / (noise_.prior_memory_s * rate.hz));
  for (const PoseParameter parameter : kAllPoseParameters) {
    process_[index(parameter)] = process_of(parameter, rate);
    process_[index(parameter)].sigma *= noise_.acceleration_scale;
  }
}

void PoseParameterProcess::change_rate(FrameRate rate, PostureEstimate& estimate) {
  const double longer = rate_.hz / rate.hz;
  estimate.step *= longer;
  each_parameter([&](PoseParameter parameter, auto size) {
    constexpr int kN = decltype(size)::value;
    Matrix6d& covariance = estimate.covariance[index(parameter)];
    covariance.middleRows<kN>(kN) *= longer;
    covariance.middleCols<kN>(kN) *= longer;
  });
  set_rate(rate);
}

PostureEstimate PoseParameterProcess::start(const Posture& posture) const {
  PostureEstimate estimate;
  estimate.posture = posture;
  estimate.step.setZero();
  each_parameter([&](PoseParameter parameter, auto size) {
    constexpr int kN = decltype(size)::value;
    const StepProcess& process = process_[index(parameter)];
    Matrix6d& covariance = estimate.covariance[index(parameter)];
    covariance.setZero();
    const double step_variance =
        process.sigma * process.sigma / (1.0 - process.correlation * process.correlation);
    covariance.topLeftCorner<kN, kN>().diagonal().setConstant(kFirstSigma * kFirstSigma);
    covariance.block<kN, kN>(kN, kN).diagonal().setConstant(step_variance);
  });
  return estimate;
}

void PoseParameterProcess::predict(const PostureEstimate& now,
                                   PostureEstimate& next) const {
  each_parameter([&](PoseParameter parameter, auto size) {
    constexpr int kN = decltype(size)::value;
    const double k = process_[index(parameter)].correlation;
    const double q = process_[index(parameter)].sigma * process_[index(parameter)].sigma;
    const int column = column_of(parameter);
    next.step.segment<kN>(column) = k * now.step.segment<kN>(column);
    const Matrix6d& c = now.covariance[index(parameter)];
    const Square<kN> xx = c.topLeftCorner<kN, kN>();
    const Square<kN> vx = c.block<kN, kN>(kN, 0);
    const Square<kN> vv = c.block<kN, kN>(kN, kN);
    // x' = x + v', v' = k v + noise.
    const Square<kN> next_vv = k * k * vv + q * Square<kN>::Identity();
    const Square<kN> next_vx = k * vx + next_vv;
    Matrix6d& out = next.covariance[index(parameter)];
    out.topLeftCorner<kN, kN>() = xx + k * (vx + vx.transpose()) + next_vv;
    out.block<kN, kN>(kN, 0) = next_vx;
    out.block<kN, kN>(0, kN) = next_vx.transpose();
    out.block<kN, kN>(kN, kN) = next_vv;
  });
  next.posture = now.posture;
  move_bones(next.posture, next.step, lengths_);
}

void PoseParameterProcess::to_prior(const PostureEstimate& predicted,
                                    PosturePrior& prior) {
  prior.expected = predicted.posture;
  each_parameter([&](PoseParameter parameter, auto size) {
    constexpr int kN = decltype(size)::value;
    const Square<kN> xx = predicted.covariance[index(parameter)].topLeftCorner<kN, kN>();
    prior.information[index(parameter)].setZero();
    prior.information[index(parameter)].topLeftCorner<kN, kN>() = xx.inverse();
  });
}

/// Computes the covariance of a limb's upper bone from those of its frame and its
/// flexion, since it turns with both.
void PoseParameterProcess::add_flexion(PoseParameter parameter,
                                       const Posture& posture,
                                       const PostureCovariance& covariance,
                                       Matrix3d& found) const {
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    if (kLimbParameters[limb].frame != parameter) continue;
    const int frame = column_of(parameter);
    const int flexion = column_of(kLimbParameters[limb].flexion);
    const Eigen::Vector3d by = upper_by_flexion(posture, limb, lengths_);
    const Eigen::Vector3d shared = covariance.full.block<3, 1>(frame, flexion);
    found += shared * by.transpose() + by * shared.transpose() +
             covariance.full(flexion, flexion) * by * by.transpose();
  }
}

void PoseParameterProcess::update(const PostureEstimate& predicted,
                                  const Posture& solved,
                                  const PostureCovariance& covariance,
                                  PostureEstimate& updated) const {
  const PostureVector moved = bone_step_between(predicted.posture, solved, lengths_);
  updated.posture = solved;
  each_parameter([&](PoseParameter parameter, auto size) {
    constexpr int kN = decltype(size)::value;
    const int column = column_of(parameter);
    const Matrix6d& c = predicted.covariance[index(parameter)];
    const Square<kN> xx = c.topLeftCorner<kN, kN>();
    Square<kN> found = covariance.full.block<kN, kN>(column, column);
    if constexpr (kN == 3) add_flexion(parameter, solved, covariance, found);
    // Updates the step by its covariance with the value.
    const Square<kN> gain = c.block<kN, kN>(kN, 0) * xx.inverse();
    updated.step.segment<kN>(column) =
        predicted.step.segment<kN>(column) + gain * moved.segment<kN>(column);
    Matrix6d& out = updated.covariance[index(parameter)];
    const Square<kN> vx = gain * found;
    out.topLeftCorner<kN, kN>() = found;
    out.block<kN, kN>(kN, 0) = vx;
    out.block<kN, kN>(0, kN) = vx.transpose();
    out.block<kN, kN>(kN, kN) =
        c.block<kN, kN>(kN, kN) - gain * (xx - found) * gain.transpose();
  });
}

}  // namespace marey::reconstruct
