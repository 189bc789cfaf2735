// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: what cameras tell of a planned body in one frame.

#include <span>
#include <vector>

#include <Eigen/Dense>

#include "calib/body_freedom.h"
#include "calib/plan_rig.h"

namespace marey::calib {

/// A tag of the body in one camera.
struct BodyView {
  std::size_t tag = 0;
  std::size_t camera = 0;
  double side_px = 0.0;
};

/// All of them: what is not turned away, outside, too small, or behind the body.
[[nodiscard]] std::vector<BodyView> views_of(std::span<const Camera> cameras,
                                             const PlannedBody& body,
                                             const BodyPlace& place,
                                             const PlanOptions& options);

/// Columns of what all frames share: lengths, where tags sit (rotation vector about the
/// tag's centre, then place, in the segment's frame), cameras as in RigCovariance, and
/// where the collar bones start.
struct SharedColumns {
  int tags = 0;
  int cameras = 0;

  [[nodiscard]] int tag(std::size_t i) const {
    return kLengthColumns + 6 * static_cast<int>(i);
  }
  [[nodiscard]] int body() const { return kLengthColumns + 6 * tags; }
  [[nodiscard]] int camera(std::size_t c) const {
    return body() + static_cast<int>(RigCovariance::kPerCamera * c);
  }
  [[nodiscard]] int base() const { return camera(static_cast<std::size_t>(cameras)); }
  [[nodiscard]] int count() const { return base() + kBaseColumns; }
};

/// The normal equations of one frame.
struct FrameInformation {
  PostureMatrix posture = PostureMatrix::Zero();
  Eigen::MatrixXd coupling;  ///< Posture by shared.
};

/// Adds up the views' corners, in sigmas. With `shared` (count by count), also what they
/// tell of the shared columns.
[[nodiscard]] FrameInformation information_of(std::span<const Camera> cameras,
                                              const PlannedBody& body,
                                              const BodyPlace& place,
                                              const BodyMotion& motion,
                                              std::span<const BodyView> views,
                                              const CornerSigma& corner_sigma,
                                              const SharedColumns& columns,
                                              Eigen::MatrixXd* shared = nullptr);

/// Adds what habits say.
void add_habits(const HabitRows& habits, FrameInformation& information);

}  // namespace marey::calib
