// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/apparent_clocks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "calib/model/project_point.h"
#include "calib/model/target_velocity.h"
#include "core/base/assert.h"
#include "core/base/cross_matrix.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

/// The normal equations of one instant: the target's pose, then the cameras' clocks.
struct Normal {
  Eigen::Matrix<double, 6, 6> place = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::MatrixXd mixed;  ///< Six rows, a column per camera.
  Eigen::Matrix<double, 6, 1> place_right = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::VectorXd clock;  ///< The clocks' block is diagonal.
  Eigen::VectorXd clock_right;
};

/// Residual of a corner, and its derivatives by pose and time.
struct Row {
  Eigen::Vector2d error_px;
  Eigen::Matrix<double, 2, 6> by_place;
  Eigen::Vector2d by_time;
};

std::optional<Row> row_of(const RigModel& model,
                          const Sighting& sighting,
                          int corner,
                          const RigidTransform& world_from_target,
                          const Velocity& velocity) {
  const RigCamera& camera = model.cameras[sighting.camera];
  const glm::dvec3 p_in_target =
      corner_in_target(model.targets[sighting.target], sighting, corner);
  const Eigen::Vector3d arm =
      to_eigen(world_from_target.rotation) * to_eigen(p_in_target);
  const RigidTransform camera_from_world = inverse(camera.world_from_camera);
  const glm::dvec3 p_in_camera = camera_from_world * (world_from_target * p_in_target);
  Eigen::Matrix<double, 2, 3> by_point;
  constexpr double kStep_m = 1e-5;
  const auto project_at = [&](const glm::dvec3& p) -> std::optional<glm::dvec2> {
    glm::dvec2 pixel(0.0);
    if (!project(camera.intrinsics, &p.x, &pixel.x)) return std::nullopt;
    return pixel;
  };
  const auto pixel = project_at(p_in_camera);
  if (!pixel) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 step(0.0);
    step[i] = kStep_m;
    const auto ahead = project_at(p_in_camera + step);
    if (!ahead) return std::nullopt;
    const glm::dvec2 slope = (*ahead - *pixel) / kStep_m;
    by_point.col(i) << slope.x, slope.y;
  }
  const Eigen::Matrix<double, 2, 3> by_world =
      by_point * to_eigen(camera_from_world.rotation).toRotationMatrix();
  Row row;
  std::array<glm::dvec2, 4> seen{};
  for (std::size_t i = 0; i < 4; ++i) seen[i] = sighting.corners[i].pixel_px;
  if (sighting.count == 4) seen = unshrunk(seen, camera.shrinkage);
  const glm::dvec2 error = seen[static_cast<std::size_t>(corner)] - *pixel;
  row.error_px << error.x, error.y;
  row.by_place.leftCols<3>() = -by_world * cross_matrix<Eigen::Matrix3d>(arm);
  row.by_place.rightCols<3>() = by_world;
  row.by_time = by_world * (velocity.turn_rad_s.cross(arm) + velocity.move_m_s);
  return row;
}

/// Sightings by target and instant.
using Instants = std::map<std::pair<std::size_t, int>, std::vector<const Sighting*>>;

Instants instants_of(const RigModel& model) {
  Instants instants;
  for (const Sighting& sighting : model.sightings) {
    const RigidTarget& target = model.targets[sighting.target];
    MAREY_ASSERT(target.knot_spacing_s <= 0.0);
    if (target.stays || errors_px(model, sighting).empty()) continue;
    instants[{sighting.target, sighting.instant}].push_back(&sighting);
  }
  return instants;
}

/// Returns the typical error of a corner, per camera.
std::vector<double> typical_errors_px(const RigModel& model) {
  std::vector<std::vector<double>> errors(model.cameras.size());
  for (const Sighting& sighting : model.sightings) {
    for (const double e : errors_px(model, sighting))
      errors[sighting.camera].push_back(e);
  }
  std::vector<double> usual;
  for (auto& own : errors) {
    usual.push_back(own.empty() ? 1.0 : std::max(0.02, median(std::move(own))));
  }
  return usual;
}

void add(const Row& row, std::size_t camera, double typical_px, Normal& normal) {
  // Cauchy weight: reduces the effect of wrong tags. Its scale is twice the typical
  // error.
  const double far = row.error_px.squaredNorm() / (4.0 * typical_px * typical_px);
  const double weight = 1.0 / (typical_px * typical_px * (1.0 + far));
  const auto c = static_cast<Eigen::Index>(camera);
  normal.place += weight * row.by_place.transpose() * row.by_place;
  normal.place_right += weight * row.by_place.transpose() * row.error_px;
  normal.mixed.col(c) += weight * row.by_place.transpose() * row.by_time;
  normal.clock[c] += weight * row.by_time.squaredNorm();
  normal.clock_right[c] += weight * row.by_time.dot(row.error_px);
}

}  // namespace

std::vector<ApparentClock> apparent_clocks(const RigModel& model, double rate_hz) {
  const auto cameras = static_cast<Eigen::Index>(model.cameras.size());
  const std::vector<double> typical_px = typical_errors_px(model);
  Eigen::MatrixXd clock = Eigen::MatrixXd::Zero(cameras, cameras);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(cameras);
  for (const auto& [place, sightings] : instants_of(model)) {
    const RigidTarget& target = model.targets[place.first];
    const auto velocity = velocity_at(target, place.second, rate_hz);
    const std::size_t first = sightings.front()->camera;
    const bool is_shared = std::any_of(
        sightings.begin(), sightings.end(), [&](auto* s) { return s->camera != first; });
    if (!velocity || !is_shared) continue;
    const RigidTransform& pose = target.world_from_target.at(place.second);
    Normal normal;
    normal.mixed = Eigen::MatrixXd::Zero(6, cameras);
    normal.clock = Eigen::VectorXd::Zero(cameras);
    normal.clock_right = Eigen::VectorXd::Zero(cameras);
    for (const Sighting* s : sightings) {
      for (int i = 0; i < s->count; ++i) {
        const auto row = row_of(model, *s, i, pose, *velocity);
        if (row) add(*row, s->camera, typical_px[s->camera], normal);
      }
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(normal.place);
    if (factor.info() != Eigen::Success || !factor.isPositive()) continue;
    const Eigen::MatrixXd solved = factor.solve(normal.mixed);
    clock -= normal.mixed.transpose() * solved;
    clock += Eigen::MatrixXd(normal.clock.asDiagonal());
    right += normal.clock_right - solved.transpose() * normal.place_right;
  }
  std::vector<ApparentClock> out(model.cameras.size());
  if (cameras < 2) return out;
  // The first camera's clock is the reference. A weak prior of a second constrains clocks
  // without data.
  const Eigen::Index others = cameras - 1;
  Eigen::MatrixXd information = clock.bottomRightCorner(others, others);
  information.diagonal().array() += 1.0;
  const Eigen::MatrixXd inverse =
      information.ldlt().solve(Eigen::MatrixXd::Identity(others, others));
  const Eigen::VectorXd offset = inverse * right.tail(others);
  for (Eigen::Index c = 0; c < others; ++c) {
    const double sigma_s = std::sqrt(std::max(0.0, inverse(c, c)));
    out[static_cast<std::size_t>(c + 1)] = {offset[c], sigma_s};
  }
  return out;
}

bool clocks_disagree(const std::vector<ApparentClock>& clocks) {
  // A hand at 1 m/s moves by as many millimetres; half of that is absorbed in the
  // cameras' poses. A false alarm costs only some seconds of computation.
  constexpr double kMinHarmful_s = 1e-3;
  constexpr double kSigmas = 4.0;
  return std::any_of(clocks.begin(), clocks.end(), [&](const ApparentClock& clock) {
    return std::abs(clock.offset_s) > std::max(kMinHarmful_s, kSigmas * clock.sigma_s);
  });
}

}  // namespace marey::calib
