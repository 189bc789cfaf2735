// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/model/expected_error.h"
#include "calib/plan/plan_options.h"
#include "core/base/ids.h"
#include "core/camera.h"
#include "core/transform.h"

namespace marey::calib {

/// Expected observation of a tag at one pose.
struct ExpectedTag {
  std::vector<CameraId> seen_by;
  double side_px = 0.0;  ///< Mean over these cameras and the tag's four sides.
  /// Root of the expected squared distance from the truth: for the tag's centre, and for
  /// a point of its segment at a distance of `lever_m`, averaged over its directions.
  std::optional<double> centre_error_m;
  std::optional<double> joint_error_m;
};

/// Computes which cameras see a tag, and the uncertainty of its position with all corners
/// fused to one rigid pose. A camera sees a tag if all four corners are in its image, the
/// tag faces the camera, and its image is large enough. Occlusion is not modelled,
/// although bodies hide some of their own tags. `covariance` as in point_covariance().
/// The errors are nullopt if fewer than two cameras see the tag: one gives an ambiguous
/// pose (calib/model/planar_pose.h). Cost: some 10 us per camera. Preconditions:
/// tag_size_m > 0; the covariance has the same number of cameras.
[[nodiscard]] ExpectedTag expect_tag(std::span<const Camera> cameras,
                                     const RigCovariance* covariance,
                                     const RigidTransform& world_from_tag,
                                     const CornerSigma& corner_sigma,
                                     const PlanOptions& options);

/// One position of the volume, over tags that face all directions.
struct PlannedPlace {
  glm::dvec3 p_in_world{0.0};
  double seen_share = 0.0;      ///< Share of directions seen by one camera or more.
  double measured_share = 0.0;  ///< Share of directions seen by two or more.
  double side_px = 0.0;         ///< Mean over tags that are seen; 0 if none is.
  /// Root mean square over the directions seen by two; nullopt if there are none.
  std::optional<double> centre_error_m;
  std::optional<double> joint_error_m;
};

struct MedianAndP95 {
  double median = 0.0;
  double p95 = 0.0;
};

/// All positions of one height, with equal weight of every direction of every position.
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

/// Calls expect_tag() for upright tags at every position of a grid, facing all horizontal
/// directions, like those of a standing body. Preconditions: directions > 0; those of the
/// grid's columns() and of expect_tag().
[[nodiscard]] RigPlan plan_rig(std::span<const Camera> cameras,
                               const RigCovariance* covariance,
                               const ErrorMapGrid& grid,
                               const CornerSigma& corner_sigma,
                               const PlanOptions& options);

/// Returns a square of 4 m by 4 m around the point at which the cameras look: the point
/// nearest to all their axes, or below the cameras if these are parallel. Precondition: a
/// camera.
[[nodiscard]] ErrorMapGrid grid_before(std::span<const Camera> cameras);

}  // namespace marey::calib
