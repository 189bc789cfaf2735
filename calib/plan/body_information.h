// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: information of camera views on a planned body in one frame.

#include <span>
#include <vector>

#include <Eigen/Dense>

#include "calib/plan/plan_rig.h"
#include "calib/plan/posture_jacobian.h"

namespace marey::calib {

/// A tag of the body seen by one camera.
struct BodyView {
  std::size_t tag = 0;
  std::size_t camera = 0;
  double side_px = 0.0;
};

/// Returns all visible tags: facing the camera, inside the image, large enough, and not
/// hidden by the body.
[[nodiscard]] std::vector<BodyView> views_of(std::span<const Camera> cameras,
                                             const PlannedBody& body,
                                             const BodyPlace& place,
                                             const PlanOptions& options);

/// Columns shared by all frames: lengths, tag poses (rotation vector about the tag's
/// centre, then position, in the segment's frame), cameras as in RigCovariance, and the
/// origins of the collar bones.
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

/// Adds up the information of the views' corners, in sigmas. With `shared` (columns by
/// group), also the information on the shared columns.
[[nodiscard]] FrameInformation information_of(std::span<const Camera> cameras,
                                              const PlannedBody& body,
                                              const BodyPlace& place,
                                              const PostureJacobian& jacobian,
                                              std::span<const BodyView> views,
                                              const CornerSigma& corner_sigma,
                                              const SharedColumns& columns,
                                              Eigen::MatrixXd* shared = nullptr);

/// Adds the information of the posture prior.
void add_posture_prior(const PosturePriorRows& prior, FrameInformation& information);

}  // namespace marey::calib
