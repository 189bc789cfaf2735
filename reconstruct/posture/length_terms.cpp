// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/length_terms.h"

#include "core/human/posture_priors.h"

namespace marey::reconstruct {
namespace {

struct LengthDifference {
  Length a;
  Length b;
  double sigma_m;

  template <class T>
  bool operator()(const T* lengths, T* residual) const {
    residual[0] = (lengths[index(a)] - lengths[index(b)]) / sigma_m;
    return true;
  }
};

struct UsualLengths {
  Lengths usual;
  Lengths sigma_m;

  template <class T>
  bool operator()(const T* lengths, T* residual) const {
    for (std::size_t i = 0; i < usual.size(); ++i) {
      residual[i] = (lengths[i] - usual[i]) / sigma_m[i];
    }
    return true;
  }
};

}  // namespace

Lengths usual_length_sigmas_m(const Lengths& usual) {
  Lengths sigmas_m{};
  for (std::size_t i = 0; i < usual.size(); ++i) {
    sigmas_m[i] = length_sigma_m(usual[i]);
  }
  constexpr double kHeld_m = 1e-4;
  for (const Length length : {Length::kShoulderOut,
                              Length::kShoulderUp,
                              Length::kShoulderForward,
                              Length::kNeckForward}) {
    sigmas_m[index(length)] = kHeld_m;
  }
  return sigmas_m;
}

void add_length_priors(const Lengths& usual,
                       const Lengths& sigma_m,
                       Lengths& lengths,
                       ceres::Problem& problem) {
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<UsualLengths, kLengthCount, kLengthCount>(
          new UsualLengths{usual, sigma_m}),
      nullptr,
      lengths.data());
  for (int left = static_cast<int>(Length::kLeftShoulder); left < kLengthCount;
       left += 2) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<LengthDifference, 1, kLengthCount>(
            new LengthDifference{Length{left}, Length{left + 1}, kSidesDifferSigma_m}),
        nullptr,
        lengths.data());
  }
}

}  // namespace marey::reconstruct
