// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/posture_chain.h"

#include "core/base/assert.h"

namespace marey::calib {
namespace {

constexpr int kN = kPostureColumns;
using Dense = Eigen::MatrixXd;

/// The steps' information: diagonals of the blocks of a frame with itself, with the next
/// frame and with the one after.
struct Bands {
  std::vector<PostureVector> own;
  std::vector<PostureVector> next;
  std::vector<PostureVector> after;
};

Bands bands_of(std::size_t frames, const StepPrior& steps) {
  Bands out;
  for (auto* band : {&out.own, &out.next, &out.after}) {
    band->assign(frames, PostureVector::Zero());
  }
  const PostureVector weight = steps.sigma.array().square().inverse();
  const PostureVector keeps = steps.correlation;
  // The first step has the stationary distribution of steps.
  const PostureVector first = weight.array() * (1.0 - keeps.array().square());
  out.own[0] += first;
  out.own[1] += first;
  out.next[0] -= first;
  for (std::size_t f = 2; f < frames; ++f) {
    const PostureVector back =
        1.0 + keeps.array();  // x - back * before + keeps * earlier
    out.own[f] += weight;
    out.own[f - 1] += weight.cwiseProduct(back).cwiseProduct(back);
    out.own[f - 2] += weight.cwiseProduct(keeps).cwiseProduct(keeps);
    out.next[f - 1] -= weight.cwiseProduct(back);
    out.next[f - 2] -= weight.cwiseProduct(back).cwiseProduct(keeps);
    out.after[f - 2] += weight.cwiseProduct(keeps);
  }
  return out;
}

/// Multiplies by the block between a pair of frames (columns) and the pair after it
/// (rows).
Dense onward(const Bands& bands, std::size_t pair, const Dense& of) {
  const std::size_t f = 2 * pair;
  Dense out(2 * kN, of.cols());
  out.topRows(kN) = bands.after[f].asDiagonal() * of.topRows(kN);
  out.topRows(kN) += bands.next[f + 1].asDiagonal() * of.bottomRows(kN);
  out.bottomRows(kN) = bands.after[f + 1].asDiagonal() * of.bottomRows(kN);
  return out;
}

/// Multiplies by the transposed block.
Dense backward(const Bands& bands, std::size_t pair, const Dense& of) {
  const std::size_t f = 2 * pair;
  Dense out(2 * kN, of.cols());
  out.topRows(kN) = bands.after[f].asDiagonal() * of.topRows(kN);
  out.bottomRows(kN) = bands.next[f + 1].asDiagonal() * of.topRows(kN);
  out.bottomRows(kN) += bands.after[f + 1].asDiagonal() * of.bottomRows(kN);
  return out;
}

}  // namespace

std::vector<PostureUncertainty> solve_chain(std::span<const FrameInformation> frames,
                                            const StepPrior& steps) {
  MAREY_ASSERT(frames.size() >= 2 && frames.size() % 2 == 0);
  const Bands bands = bands_of(frames.size(), steps);
  const std::size_t pairs = frames.size() / 2;
  const Eigen::Index shared = frames[0].coupling.cols();
  std::vector<Dense> inverse(pairs);
  std::vector<Dense> right(pairs);
  for (std::size_t i = 0; i < pairs; ++i) {
    const std::size_t f = 2 * i;
    Dense pivot = Dense::Zero(2 * kN, 2 * kN);
    pivot.topLeftCorner(kN, kN) = frames[f].posture;
    pivot.bottomRightCorner(kN, kN) = frames[f + 1].posture;
    pivot.diagonal().head(kN) += bands.own[f];
    pivot.diagonal().tail(kN) += bands.own[f + 1];
    pivot.topRightCorner(kN, kN).diagonal() += bands.next[f];
    pivot.bottomLeftCorner(kN, kN).diagonal() += bands.next[f];
    right[i].resize(2 * kN, shared);
    right[i] << frames[f].coupling, frames[f + 1].coupling;
    if (i > 0) {
      const Dense along = onward(bands, i - 1, inverse[i - 1]);
      pivot -= onward(bands, i - 1, Dense(along.transpose()));
      right[i].noalias() -= along * right[i - 1];
    }
    inverse[i] = pivot.llt().solve(Dense::Identity(2 * kN, 2 * kN));
  }
  std::vector<PostureUncertainty> out(frames.size());
  Dense covariance;
  Dense follows;
  for (std::size_t i = pairs; i-- > 0;) {
    if (i + 1 == pairs) {
      covariance = inverse[i];
      follows = inverse[i] * right[i];
    } else {
      follows = inverse[i] * (right[i] - backward(bands, i, follows));
      const Dense along = onward(bands, i, inverse[i]);
      covariance = inverse[i] + along.transpose() * (covariance * along);
    }
    out[2 * i] = {covariance.topLeftCorner(kN, kN), -follows.topRows(kN)};
    out[2 * i + 1] = {covariance.bottomRightCorner(kN, kN), -follows.bottomRows(kN)};
  }
  return out;
}

}  // namespace marey::calib
