// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/slot_filter.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace marey::reconstruct {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Of a posture that was just found from nothing. [rad], [m]
constexpr double kFirstSigma = 0.3;

template <int N>
using Square = Eigen::Matrix<double, N, N>;

/// Calls `what` with the size of a slot's unknowns as a constant.
template <class F>
void each_slot(F&& what) {
  for (const Slot slot : kAllSlots) {
    if (tangent_size(slot) == 3) {
      what(slot, std::integral_constant<int, 3>());
    } else {
      what(slot, std::integral_constant<int, 1>());
    }
  }
}

template <int N>
auto both(Matrix6d& covariance) {
  return covariance.topLeftCorner<2 * N, 2 * N>();
}
template <int N>
auto both(const Matrix6d& covariance) {
  return covariance.topLeftCorner<2 * N, 2 * N>();
}

}  // namespace

SlotProcess::SlotProcess(const Lengths& lengths, FrameRate rate, const Temper& temper)
    : lengths_(lengths), temper_(temper) {
  set_rate(rate);
}

void SlotProcess::set_rate(FrameRate rate) {
  rate_ = rate;
  habit_share_ = std::min(1.0, 1.0 / (temper_.habit_memory_s * rate.hz));
  for (const SlotAcceleration& row : kAccelerations) {
    process_[index(row.slot)] = process_of(row, rate);
    process_[index(row.slot)].sigma *= temper_.brisk;
  }
}

void SlotProcess::change_rate(FrameRate rate, PostureBelief& belief) {
  const double longer = rate_.hz / rate.hz;
  belief.step *= longer;
  each_slot([&](Slot slot, auto size) {
    constexpr int kN = decltype(size)::value;
    Matrix6d& covariance = belief.covariance[index(slot)];
    covariance.middleRows<kN>(kN) *= longer;
    covariance.middleCols<kN>(kN) *= longer;
  });
  set_rate(rate);
}

PostureBelief SlotProcess::start(const Posture& posture) const {
  PostureBelief belief;
  belief.posture = posture;
  belief.step.setZero();
  each_slot([&](Slot slot, auto size) {
    constexpr int kN = decltype(size)::value;
    const StepProcess& process = process_[index(slot)];
    Matrix6d& covariance = belief.covariance[index(slot)];
    covariance.setZero();
    const double step_variance =
        process.sigma * process.sigma / (1.0 - process.keeps * process.keeps);
    covariance.topLeftCorner<kN, kN>().diagonal().setConstant(kFirstSigma * kFirstSigma);
    covariance.block<kN, kN>(kN, kN).diagonal().setConstant(step_variance);
  });
  return belief;
}

void SlotProcess::predict(const PostureBelief& now, PostureBelief& next) const {
  each_slot([&](Slot slot, auto size) {
    constexpr int kN = decltype(size)::value;
    const double k = process_[index(slot)].keeps;
    const double q = process_[index(slot)].sigma * process_[index(slot)].sigma;
    const int column = column_of(slot);
    next.step.segment<kN>(column) = k * now.step.segment<kN>(column);
    const Matrix6d& c = now.covariance[index(slot)];
    const Square<kN> xx = c.topLeftCorner<kN, kN>();
    const Square<kN> vx = c.block<kN, kN>(kN, 0);
    const Square<kN> vv = c.block<kN, kN>(kN, kN);
    // x' = x + v', v' = k v + noise.
    const Square<kN> next_vv = k * k * vv + q * Square<kN>::Identity();
    const Square<kN> next_vx = k * vx + next_vv;
    Matrix6d& out = next.covariance[index(slot)];
    out.topLeftCorner<kN, kN>() = xx + k * (vx + vx.transpose()) + next_vv;
    out.block<kN, kN>(kN, 0) = next_vx;
    out.block<kN, kN>(0, kN) = next_vx.transpose();
    out.block<kN, kN>(kN, kN) = next_vv;
  });
  next.posture = now.posture;
  move_bones(next.posture, next.step, lengths_);
}

void SlotProcess::to_prior(const PostureBelief& predicted, PosturePrior& prior) {
  prior.expected = predicted.posture;
  each_slot([&](Slot slot, auto size) {
    constexpr int kN = decltype(size)::value;
    const Square<kN> xx = predicted.covariance[index(slot)].topLeftCorner<kN, kN>();
    prior.information[index(slot)].setZero();
    prior.information[index(slot)].topLeftCorner<kN, kN>() = xx.inverse();
  });
}

/// A limb's upper bone turns with its frame and with its flexion: its covariance from
/// theirs.
void SlotProcess::add_flexion(Slot slot,
                              const Posture& posture,
                              const PostureCovariance& covariance,
                              Matrix3d& found) const {
  for (std::size_t limb = 0; limb < kLimbSlots.size(); ++limb) {
    if (kLimbSlots[limb].frame != slot) continue;
    const int frame = column_of(slot);
    const int flexion = column_of(kLimbSlots[limb].flexion);
    const Eigen::Vector3d by = upper_by_flexion(posture, limb, lengths_);
    const Eigen::Vector3d shared = covariance.full.block<3, 1>(frame, flexion);
    found += shared * by.transpose() + by * shared.transpose() +
             covariance.full(flexion, flexion) * by * by.transpose();
  }
}

void SlotProcess::update(const PostureBelief& predicted,
                         const Posture& solved,
                         const PostureCovariance& covariance,
                         PostureBelief& updated) const {
  const PostureVector moved = bone_step_between(predicted.posture, solved, lengths_);
  updated.posture = solved;
  each_slot([&](Slot slot, auto size) {
    constexpr int kN = decltype(size)::value;
    const int column = column_of(slot);
    const Matrix6d& c = predicted.covariance[index(slot)];
    const Square<kN> xx = c.topLeftCorner<kN, kN>();
    Square<kN> found = covariance.full.block<kN, kN>(column, column);
    if constexpr (kN == 3) add_flexion(slot, solved, covariance, found);
    // What the value's change says of the step.
    const Square<kN> gain = c.block<kN, kN>(kN, 0) * xx.inverse();
    updated.step.segment<kN>(column) =
        predicted.step.segment<kN>(column) + gain * moved.segment<kN>(column);
    Matrix6d& out = updated.covariance[index(slot)];
    const Square<kN> vx = gain * found;
    out.topLeftCorner<kN, kN>() = found;
    out.block<kN, kN>(kN, 0) = vx;
    out.block<kN, kN>(0, kN) = vx.transpose();
    out.block<kN, kN>(kN, kN) =
        c.block<kN, kN>(kN, kN) - gain * (xx - found) * gain.transpose();
  });
}

void SlotProcess::smooth(const PostureBelief& filtered,
                         const PostureBelief& predicted,
                         const PostureBelief& later,
                         PostureBelief& smoothed) const {
  const PostureVector moved =
      bone_step_between(predicted.posture, later.posture, lengths_);
  PostureVector back;
  each_slot([&](Slot slot, auto size) {
    constexpr int kN = decltype(size)::value;
    using Both = Square<2 * kN>;
    const double k = process_[index(slot)].keeps;
    const int column = column_of(slot);
    Both forward = Both::Identity();
    forward.template block<kN, kN>(0, kN).diagonal().setConstant(k);
    forward.template block<kN, kN>(kN, kN).diagonal().setConstant(k);
    const Both c = both<kN>(filtered.covariance[index(slot)]);
    const Both p = both<kN>(predicted.covariance[index(slot)]);
    const Both ahead = both<kN>(later.covariance[index(slot)]);
    const Both gain = p.ldlt().solve(forward * c).transpose();
    Eigen::Matrix<double, 2 * kN, 1> off;
    off << moved.segment<kN>(column),
        later.step.segment<kN>(column) - predicted.step.segment<kN>(column);
    const Eigen::Matrix<double, 2 * kN, 1> by = gain * off;
    back.segment<kN>(column) = by.template head<kN>();
    smoothed.step.segment<kN>(column) =
        filtered.step.segment<kN>(column) + by.template tail<kN>();
    const Both sum = c + gain * (ahead - p) * gain.transpose();
    both<kN>(smoothed.covariance[index(slot)]) = 0.5 * (sum + sum.transpose());
  });
  smoothed.posture = filtered.posture;
  move_bones(smoothed.posture, back, lengths_);
}

void SlotProcess::from_others(const PostureBelief& predicted,
                              const PostureBelief& filtered,
                              const PostureBelief& smoothed,
                              PosturePrior& prior) const {
  // Information adds up: all = others + own, and own = filtered - predicted.
  const PostureVector to_smoothed =
      bone_step_between(filtered.posture, smoothed.posture, lengths_);
  const PostureVector to_predicted =
      bone_step_between(filtered.posture, predicted.posture, lengths_);
  PostureVector expected;
  each_slot([&](Slot slot, auto size) {
    constexpr int kN = decltype(size)::value;
    const int column = column_of(slot);
    const auto information = [&](const PostureBelief& belief) -> Square<kN> {
      return belief.covariance[index(slot)].topLeftCorner<kN, kN>().inverse();
    };
    const Square<kN> before = information(predicted);
    const Square<kN> all = information(smoothed);
    Square<kN> others = all - information(filtered) + before;
    others = (0.5 * (others + others.transpose())).eval();
    Eigen::Matrix<double, kN, 1> mean = to_predicted.segment<kN>(column);
    const Eigen::LLT<Square<kN>> factor(others);
    // By rounding alone can others know less than the past.
    if (factor.info() == Eigen::Success) {
      mean = factor.solve(all * to_smoothed.segment<kN>(column) + before * mean);
    } else {
      others = before;
    }
    expected.segment<kN>(column) = mean;
    prior.information[index(slot)].setZero();
    prior.information[index(slot)].topLeftCorner<kN, kN>() = others;
  });
  prior.expected = filtered.posture;
  move_bones(prior.expected, expected, lengths_);
}

}  // namespace marey::reconstruct
