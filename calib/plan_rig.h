// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "calib/expected_error.h"
#include "core/camera.h"
#include "core/ids.h"
#include "core/transform.h"

namespace marey::calib {

/// Standard deviation [px] of a coordinate of a corner of a tag whose sides are
/// `side_px` long on average: what the detector achieves. More than 0.
using CornerSigma = std::function<double(double side_px)>;

/// Which tags a camera sees, and what is asked of them.
struct PlanOptions {
  double tag_size_m = 0.08;   ///< Edge of the black square.
  double widest_rad = 1.134;  ///< Between a tag's normal and the sight: 65 degrees.
  /// Of each edge: half of the tags are read that are so small (docs/measurements.md).
  double least_side_px = 15.0;
  double lever_m = 0.15;  ///< From a tag to the joint that it carries.
  int directions = 36;    ///< Level ones, all around, that tags face.
};

/// A tag at one place, as a rig would see it.
struct ExpectedTag {
  std::vector<CameraId> seen_by;
  double side_px = 0.0;  ///< Mean over these cameras and the tag's four sides.
  /// The root of the expected squared distance from the truth: of the tag's centre, and
  /// of a point of its segment `lever_m` away, averaged over where that may be.
  std::optional<double> centre_error_m;
  std::optional<double> joint_error_m;
};

/// What cameras would see of a tag, and how well they would know its place: all its
/// corners are fused to one rigid pose. A camera sees a tag when all four corners lie in
/// its image, it faces the camera, and it is large enough there. Nothing stands in the
/// way of a sight: bodies hide some of their own tags. `covariance` as in
/// point_covariance(). The errors are nullopt when fewer than two cameras see it: one
/// gives a pose, but an ambiguous one (calib/planar_pose.h). Cost: some 10 us per camera.
/// Preconditions: tag_size_m > 0; the covariance is of as many cameras.
[[nodiscard]] ExpectedTag expect_tag(std::span<const Camera> cameras,
                                     const RigCovariance* covariance,
                                     const RigidTransform& world_from_tag,
                                     const CornerSigma& corner_sigma,
                                     const PlanOptions& options);

/// One place of the volume, over tags that face all directions.
struct PlannedPlace {
  glm::dvec3 p_in_world{0.0};
  double seen_share = 0.0;      ///< Of the directions: by one camera or more.
  double measured_share = 0.0;  ///< By two or more.
  double side_px = 0.0;         ///< Mean over tags that are seen; 0 when none is.
  /// Root mean square over the directions seen by two; nullopt when none is.
  std::optional<double> centre_error_m;
  std::optional<double> joint_error_m;
};

struct MedianAndP95 {
  double median = 0.0;
  double p95 = 0.0;
};

/// All places of one height together, every direction of every place counting alike.
struct PlannedHeight {
  double height_m = 0.0;
  double seen_share = 0.0;  ///< As in PlannedPlace.
  double measured_share = 0.0;
  std::optional<double> side_px;  ///< Median over tags that are seen.
  std::optional<MedianAndP95> centre_error_m;
  std::optional<MedianAndP95> joint_error_m;
};

struct RigPlan {
  std::vector<PlannedPlace> places;    ///< By height, then z, then x.
  std::vector<PlannedHeight> heights;  ///< As the grid's.
};

/// expect_tag() for upright tags at every place of a grid, facing all level directions,
/// as those of a standing body do. Preconditions: directions > 0; those of the grid's
/// columns() and of expect_tag().
[[nodiscard]] RigPlan plan_rig(std::span<const Camera> cameras,
                               const RigCovariance* covariance,
                               const ErrorMapGrid& grid,
                               const CornerSigma& corner_sigma,
                               const PlanOptions& options);

/// A square of 4 m by 4 m around where the cameras look: the place that is nearest to
/// all their axes, or below the cameras when these are parallel. Precondition: a camera.
[[nodiscard]] ErrorMapGrid grid_before(std::span<const Camera> cameras);

}  // namespace marey::calib
