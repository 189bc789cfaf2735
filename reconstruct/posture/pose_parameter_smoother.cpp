// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "reconstruct/posture/pose_parameter_filter.h"
#include "reconstruct/posture/pose_parameter_sizes.h"

namespace marey::reconstruct {
namespace {

using SmoothedCovariance = Eigen::Matrix<double, 6, 6>;

template <int N>
auto both(SmoothedCovariance& covariance) {
  return covariance.topLeftCorner<2 * N, 2 * N>();
}
template <int N>
auto both(const SmoothedCovariance& covariance) {
  return covariance.topLeftCorner<2 * N, 2 * N>();
}

}  // namespace

void PoseParameterProcess::smooth(const PostureEstimate& filtered,
                                  const PostureEstimate& predicted,
                                  const PostureEstimate& later,
                                  PostureEstimate& smoothed) const {
  const PostureVector moved =
      bone_step_between(predicted.posture, later.posture, lengths_);
  PostureVector back;
  each_parameter([&](PoseParameter parameter, auto size) {
    constexpr int kN = decltype(size)::value;
    using Both = Square<2 * kN>;
    const double k = process_[index(parameter)].correlation;
    const int column = column_of(parameter);
    Both forward = Both::Identity();
    forward.template block<kN, kN>(0, kN).diagonal().setConstant(k);
    forward.template block<kN, kN>(kN, kN).diagonal().setConstant(k);
    const Both c = both<kN>(filtered.covariance[index(parameter)]);
    const Both p = both<kN>(predicted.covariance[index(parameter)]);
    const Both ahead = both<kN>(later.covariance[index(parameter)]);
    const Both gain = p.ldlt().solve(forward * c).transpose();
    Eigen::Matrix<double, 2 * kN, 1> off;
    off << moved.segment<kN>(column),
        later.step.segment<kN>(column) - predicted.step.segment<kN>(column);
    const Eigen::Matrix<double, 2 * kN, 1> by = gain * off;
    back.segment<kN>(column) = by.template head<kN>();
    smoothed.step.segment<kN>(column) =
        filtered.step.segment<kN>(column) + by.template tail<kN>();
    const Both sum = c + gain * (ahead - p) * gain.transpose();
    both<kN>(smoothed.covariance[index(parameter)]) = 0.5 * (sum + sum.transpose());
  });
  smoothed.posture = filtered.posture;
  move_bones(smoothed.posture, back, lengths_);
}

void PoseParameterProcess::from_others(const PostureEstimate& predicted,
                                       const PostureEstimate& filtered,
                                       const PostureEstimate& smoothed,
                                       PosturePrior& prior) const {
  // Information adds up: all = others + own, and own = filtered - predicted.
  const PostureVector to_smoothed =
      bone_step_between(filtered.posture, smoothed.posture, lengths_);
  const PostureVector to_predicted =
      bone_step_between(filtered.posture, predicted.posture, lengths_);
  PostureVector expected;
  each_parameter([&](PoseParameter parameter, auto size) {
    constexpr int kN = decltype(size)::value;
    const int column = column_of(parameter);
    const auto information = [&](const PostureEstimate& estimate) -> Square<kN> {
      return estimate.covariance[index(parameter)].topLeftCorner<kN, kN>().inverse();
    };
    const Square<kN> before = information(predicted);
    const Square<kN> all = information(smoothed);
    Square<kN> others = all - information(filtered) + before;
    others = (0.5 * (others + others.transpose())).eval();
    Eigen::Matrix<double, kN, 1> mean = to_predicted.segment<kN>(column);
    const Eigen::LLT<Square<kN>> factor(others);
    // Only by rounding can the other frames carry less information than the past frames.
    if (factor.info() == Eigen::Success) {
      mean = factor.solve(all * to_smoothed.segment<kN>(column) + before * mean);
    } else {
      others = before;
    }
    expected.segment<kN>(column) = mean;
    prior.information[index(parameter)].setZero();
    prior.information[index(parameter)].topLeftCorner<kN, kN>() = others;
  });
  prior.expected = filtered.posture;
  move_bones(prior.expected, expected, lengths_);
}

}  // namespace marey::reconstruct
