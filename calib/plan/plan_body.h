// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/plan/plan_rig.h"
#include "calib/plan/planned_body.h"

namespace marey::calib {

/// Positions and motions of a body for planned cameras. Tag sizes are the body's.
struct PlanBodyOptions {
  PlanOptions tags;  ///< Conditions under which a camera sees a tag.
  double rate_hz = 30.0;
  int headings = 8;  ///< Horizontal directions, evenly spaced, for standing and walking.
  int strides = 5;   ///< Walks through the volume per direction.
  double step_m = 0.5;  ///< Between the standing positions.
};

/// A joint of the body: the proximal end of `bone`.
struct PlannedJoint {
  HumanBone bone{};
  /// Share of frames in which a camera or more sees a tag of the bone.
  double measured_share = 0.0;
  /// Distance from the truth, over all frames in which the body is found.
  MedianAndP95 error_m;
  /// Median of the part that remains with exact corners in the frames themselves: from
  /// the body measurement and the camera calibration.
  double lasting_error_m = 0.0;
};

/// One position of the volume, with the body standing there in all directions.
struct PlannedStand {
  glm::dvec3 p_on_floor{0.0};
  double measured_share = 0.0;    ///< Mean over its joints.
  std::optional<double> error_m;  ///< Median over joints and directions, in one frame.
};

struct BodyPlan {
  /// Shoulders, elbows, wrists, hips, knees and ankles; empty if the body is not found.
  std::vector<PlannedJoint> joints;
  MedianAndP95 error_m;         ///< Errors of all joints.
  double measured_share = 0.0;  ///< Mean over all joints.
  /// Share of frames in which a tag of hips or upper chest is seen.
  double found_share = 0.0;
  double views_share = 0.0;  ///< Share of tags and frames seen by one camera or more.
  double twice_share = 0.0;  ///< The same for two cameras or more.
  std::vector<PlannedStand> stands;  ///< By z, then x.
};

/// Predicts marey's results for a body that walks through the volume. For every walk,
/// computes a least-squares solution over 1.2 s (a little more than a stride) from all
/// corners that cameras see, without tags hidden by the body, with the priors of posture
/// and step of marey's solver. The middle 0.8 s count, as frames at either end have few
/// neighbours. The middle of a walk is in the volume; its ends may be 0.7 m outside, and
/// those of the counted part 0.5 m.
///
/// The uncertainty of the body's lengths and tags is that of a bundle over 90 frames of
/// moving every joint in the middle of the volume, and 5 frames of standing still. That
/// of the cameras is `covariance` (null: exact). The origins of the collar bones are
/// known to 12 mm. All to first order. Errors are quantiles of distances drawn from these
/// covariances, four for each joint and frame; deterministic.
///
/// Not modelled: soft-tissue artefacts, clock offsets, missed detections of visible tags.
/// Cost: some seconds, proportional to the number of frames (1.2 s of headings x strides
/// walks, and headings at every stand). Preconditions: a camera; step_m > 0, rate_hz > 0,
/// headings > 0, strides > 0; those of the grid's columns(), with this step_m; the
/// covariance has the same number of cameras.
[[nodiscard]] BodyPlan plan_body(std::span<const Camera> cameras,
                                 const RigCovariance* covariance,
                                 const PlannedBody& body,
                                 const ErrorMapGrid& grid,
                                 const CornerSigma& corner_sigma,
                                 const PlanBodyOptions& options);

}  // namespace marey::calib
