// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/make_calibrated_rig.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Dense>

#include "calib/model/project_point.h"
#include "calib/model/target_views.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

constexpr std::size_t kLens = Intrinsics::kParameterCount;

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// Sums over one camera's sightings of the board or the wand.
struct Gathered {
  std::vector<double> errors_px;
  std::set<int> cells;
  /// Pairs of target and instant, or frame.
  std::set<std::pair<std::size_t, int>> views;
};

void gather(const RigModel& model,
            const Sighting& sighting,
            const std::vector<double>& errors,
            Gathered& out) {
  if (!is_calibration_target(model.targets[sighting.target])) return;
  const Camera camera = camera_of(model.cameras[sighting.camera]);
  std::array<glm::dvec2, 4> seen{};
  for (std::size_t i = 0; i < 4; ++i) seen[i] = sighting.corners[i].pixel_px;
  if (sighting.count == 4) seen = unshrunk(seen, camera.tag_shrinkage);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const int column = static_cast<int>(8.0 * seen[i].x / camera.intrinsics.width_px);
    const int row = static_cast<int>(6.0 * seen[i].y / camera.intrinsics.height_px);
    out.cells.insert(8 * std::clamp(row, 0, 5) + std::clamp(column, 0, 7));
    out.errors_px.push_back(errors[i]);
  }
  // Instants are meaningless for a target that moves smoothly.
  const bool is_smooth = model.targets[sighting.target].knot_spacing_s > 0.0;
  out.views.insert({sighting.target, is_smooth ? sighting.frame : sighting.instant});
}

CameraQuality quality_of(Gathered gathered,
                         const RigUncertainty& uncertainty,
                         std::size_t c) {
  CameraQuality quality;
  quality.views = static_cast<int>(gathered.views.size());
  quality.corners = static_cast<int>(gathered.errors_px.size());
  quality.coverage = static_cast<double>(gathered.cells.size()) / 48.0;
  quality.rms_px = root_mean_square(gathered.errors_px);
  if (!gathered.errors_px.empty()) {
    quality.p95_px = quantile(std::move(gathered.errors_px), 0.95);
  }
  if (uncertainty.covariance.values.empty()) return quality;
  const std::size_t at = RigCovariance::kPerCamera * c;
  const auto variance = [&](std::size_t i) {
    return uncertainty.covariance.at(at + i, at + i);
  };
  quality.focal_sigma_px = std::sqrt(0.5 * (variance(0) + variance(1)));
  quality.centre_sigma_m =
      std::sqrt((variance(kLens + 3) + variance(kLens + 4) + variance(kLens + 5)) / 3.0);
  return quality;
}

}  // namespace

CalibratedRig make_calibrated_rig(std::span<const std::string> names,
                                  const RigModel& model,
                                  const RigUncertainty& uncertainty) {
  CalibratedRig rig;
  std::vector<Gathered> gathered(model.cameras.size());
  std::vector<double> all_px;
  std::vector<double> inliers_px;
  std::map<std::pair<std::size_t, int>, OutlierFrame> frames;
  std::map<std::pair<std::size_t, int>, std::vector<double>> strays_px;
  for (const Sighting& sighting : model.sightings) {
    const std::vector<double> errors = errors_px(model, sighting);
    if (errors.empty()) continue;
    gather(model, sighting, errors, gathered[sighting.camera]);
    all_px.insert(all_px.end(), errors.begin(), errors.end());
    ++rig.sightings;
    const std::pair frame(sighting.camera, sighting.frame);
    ++frames[frame].seen;
    if (sighting.is_outlier) {
      ++rig.outliers;
      ++frames[frame].sightings;
      strays_px[frame].push_back(median(errors));
    } else {
      inliers_px.insert(inliers_px.end(), errors.begin(), errors.end());
    }
  }
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    const RigCamera& camera = model.cameras[c];
    rig.cameras.push_back(camera_of(camera, names[c]));
    rig.quality.push_back(quality_of(std::move(gathered[c]), uncertainty, c));
    SolvedClock clock{camera.offset_s, 0.0, camera.drift, 0.0, camera.line_delay_s, 0.0};
    if (c < uncertainty.clocks.size()) {
      clock.offset_sigma_s = uncertainty.clocks[c].offset_s;
      clock.drift_sigma = uncertainty.clocks[c].drift;
      clock.line_delay_sigma_s = uncertainty.clocks[c].line_delay_s;
    }
    rig.clocks.push_back(clock);
  }
  for (auto& [frame, strays] : strays_px) {
    OutlierFrame out = frames.at(frame);
    out.camera = CameraId{static_cast<int>(frame.first)};
    out.frame = frame.second;
    out.median_error_px = median(std::move(strays));
    rig.outlier_frames.push_back(out);
  }
  std::stable_sort(rig.outlier_frames.begin(),
                   rig.outlier_frames.end(),
                   [](const OutlierFrame& a, const OutlierFrame& b) {
                     return a.median_error_px > b.median_error_px;
                   });
  rig.rms_px = root_mean_square(all_px);
  rig.inlier_rms_px = root_mean_square(inliers_px);
  if (!all_px.empty()) rig.median_px = median(std::move(all_px));
  rig.covariance = uncertainty.covariance;
  rig.sigma_factor = uncertainty.sigma_factor;
  rig.views = target_views(model);
  rig.shared_views = shared_views(model);
  return rig;
}

void turn_covariance(const glm::dquat& new_from_old, RigCovariance& covariance) {
  if (covariance.values.empty()) return;
  // Rotation vectors and centres rotate with the world; lenses do not.
  const auto size = static_cast<Eigen::Index>(covariance.size());
  Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(size, size);
  const Eigen::Matrix3d rotation = to_eigen(new_from_old).toRotationMatrix();
  for (std::size_t c = 0; c < covariance.cameras; ++c) {
    const auto at = static_cast<Eigen::Index>(RigCovariance::kPerCamera * c + kLens);
    turn.block<3, 3>(at, at) = rotation;
    turn.block<3, 3>(at + 3, at + 3) = rotation;
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<RowMajor> values(covariance.values.data(), size, size);
  const Eigen::MatrixXd turned = turn * values * turn.transpose();
  values = turned;
}

void move_model(const RigidTransform& new_from_world,
                RigModel& model,
                RigUncertainty& uncertainty) {
  for (RigCamera& camera : model.cameras) {
    camera.world_from_camera = new_from_world * camera.world_from_camera;
  }
  for (RigidTarget& target : model.targets) {
    for (auto& [instant, pose] : target.world_from_target) pose = new_from_world * pose;
  }
  turn_covariance(new_from_world.rotation, uncertainty.covariance);
}

}  // namespace marey::calib
