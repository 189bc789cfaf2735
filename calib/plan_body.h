// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/plan_rig.h"
#include "calib/planned_body.h"

namespace marey::calib {

/// How a body is put before planned cameras. Tag sizes are the body's.
struct PlanBodyOptions {
  PlanOptions tags;  ///< When a camera sees one.
  double rate_hz = 30.0;
  int headings = 8;     ///< Level ones, all around, that it stands and walks in.
  int strides = 5;      ///< Ways through the volume in each of them.
  double step_m = 0.5;  ///< Between the places where it stands.
};

/// A joint of the body: the near end of `bone`.
struct PlannedJoint {
  HumanBone bone{};
  /// Of the frames: a tag of the bone is seen by one camera or more.
  double measured_share = 0.0;
  MedianAndP95 error_m;  ///< Distance from the truth, in all frames that find the body.
  /// Median of its part that exact corners in the frames themselves would
  /// leave: from how the body was measured and the cameras were calibrated.
  double lasting_error_m = 0.0;
};

/// One place of the volume, the body standing there in all headings.
struct PlannedStand {
  glm::dvec3 p_on_floor{0.0};
  double measured_share = 0.0;    ///< Of its joints.
  std::optional<double> error_m;  ///< Median over joints and headings, in one frame.
};

struct BodyPlan {
  /// Shoulders, elbows, wrists, hips, knees and ankles; empty when the body is not found.
  std::vector<PlannedJoint> joints;
  MedianAndP95 error_m;              ///< Of all joints.
  double measured_share = 0.0;       ///< Likewise.
  double found_share = 0.0;          ///< Of frames: a tag of hips or upper chest is seen.
  double views_share = 0.0;          ///< Of tags and frames: one camera or more sees it.
  double twice_share = 0.0;          ///< Likewise two or more.
  std::vector<PlannedStand> stands;  ///< By z, then x.
};

/// What marey would make of a body that walks through the volume: for every way a
/// least-squares solution over 1.2 s, a stride and a little more, of all corners that
/// cameras see, tags behind the body's own flesh left out, with the habits and steps that
/// marey's solver knows. The 0.8 s in its middle count: frames at either end have few
/// neighbours. The middle of a way lies in the volume; its ends may lie 0.7 m outside,
/// and those of the part that counts 0.5 m.
///
/// The body's lengths and tags are known as well as a bundle over 90 frames of moving
/// every joint in the middle of the volume, and 5 of standing still, would tell; cameras
/// as `covariance` says (null: exactly); where the collar bones start is known to 12 mm.
/// All to first order. Errors are quantiles of distances drawn from these covariances,
/// four for each joint and frame; the same every time.
///
/// Not in it: skin that moves on the bone, clocks that are apart, tags that are missed
/// though they should be seen. Cost: some seconds, with the number of frames (1.2 s of
/// headings x strides ways, and headings at every stand). Preconditions: a camera; step_m
/// > 0, rate_hz > 0, headings > 0, strides > 0; those of the grid's columns(), with this
/// step_m; the covariance is of as many cameras.
[[nodiscard]] BodyPlan plan_body(std::span<const Camera> cameras,
                                 const RigCovariance* covariance,
                                 const PlannedBody& body,
                                 const ErrorMapGrid& grid,
                                 const CornerSigma& corner_sigma,
                                 const PlanBodyOptions& options);

}  // namespace marey::calib
