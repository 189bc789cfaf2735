// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: prior distributions of the parameters.

#include <algorithm>

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "calib/model/project_point.h"
#include "calib/model/sighting_cost.h"
#include "core/camera.h"

namespace marey::calib {

/// Prior of a camera's lens: square pixels, a centre near the middle, modest distortion.
struct LensPrior {
  LensModel lens;
  double width_px;
  double height_px;

  static constexpr int kCount = 3 + 8;

  template <class T>
  bool operator()(const T* k, T* residual) const {
    residual[0] = (k[0] - k[1]) / (T(0.002) * (k[0] + k[1]));
    residual[1] = (k[2] - T(0.5 * (width_px - 1))) / T(0.04 * width_px);
    residual[2] = (k[3] - T(0.5 * (height_px - 1))) / T(0.04 * width_px);
    // Terms that the lens does not have are last: only this prior constrains them.
    constexpr double kBrown[] = {0.5, 0.3, 0.005, 0.005, 0.05, 0.1, 0.1, 0.1};
    constexpr double kRational[] = {0.5, 0.3, 0.005, 0.005, 0.1, 0.5, 0.3, 0.1};
    constexpr double kFisheye[] = {0.1, 0.1, 0.1, 0.05, 0.1, 0.1, 0.1, 0.1};
    const double* sigma = lens == LensModel::kFisheye    ? kFisheye
                          : lens == LensModel::kRational ? kRational
                                                         : kBrown;
    for (int i = 0; i < 8; ++i) residual[3 + i] = k[4 + i] / T(sigma[i]);
    return true;
  }
};

/// A tag shrinks by less than a pixel and by a few percent.
struct ShrinkagePrior {
  template <class T>
  bool operator()(const T* shrinkage, T* residual) const {
    residual[0] = shrinkage[0] / 0.5;
    residual[1] = shrinkage[1] / 0.02;
    return true;
  }
};

/// A board bends by some millimetres.
struct WarpPrior {
  template <class T>
  bool operator()(const T* warp_m, T* residual) const {
    for (int i = 0; i < 3; ++i) residual[i] = warp_m[i] / 0.003;
    return true;
  }
};

/// Prior of a tag of unknown size: within a factor of about e of the start value. It
/// keeps a tag that only one camera sees at a finite distance.
/// Derivatives as for PoseManifold.
class SizePrior final : public ceres::SizedCostFunction<1, 8> {
 public:
  explicit SizePrior(double log_size) : log_size_(log_size) {}

  bool Evaluate(const double* const* blocks,
                double* residuals,
                double** jacobians) const override {
    residuals[0] = blocks[0][7] - log_size_;
    if (!jacobians || !jacobians[0]) return true;
    std::fill_n(jacobians[0], 8, 0.0);
    jacobians[0][6] = 1.0;
    return true;
  }

 private:
  double log_size_;
};

/// Clocks drift by one or two parts in ten thousand, and the rows of webcams are up to
/// about fifty microseconds apart.
struct ClockPrior {
  template <class T>
  bool operator()(const T* clock, T* residual) const {
    residual[0] = clock[0] / 10.0;
    residual[1] = clock[1] / 3e-4;
    residual[2] = clock[2] / 5e-5;
    return true;
  }
};

/// Prior of the acceleration of a hand or limb: three consecutive knots.
/// Derivatives as for PoseManifold; those of the rotation to first order.
class MotionPrior final : public ceres::SizedCostFunction<6, 7, 7, 7> {
 public:
  MotionPrior(double sigma_m, double sigma_rad)
      : sigma_m_(sigma_m), sigma_rad_(sigma_rad) {}

  bool Evaluate(const double* const* blocks,
                double* residuals,
                double** jacobians) const override;

 private:
  double sigma_m_;
  double sigma_rad_;
};

}  // namespace marey::calib
