// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/sighting_cost.h"

#include <algorithm>
#include <cmath>

#include "calib/model/project_point.h"
#include "core/base/cross_matrix.h"

namespace marey::calib {
namespace {

constexpr int kLens = Intrinsics::kParameterCount;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Quaterniond rotation_of(const double* xyzw) {
  return Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
}

Eigen::Quaterniond turn(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-12) {
    return Eigen::Quaterniond(1.0, 0.5 * vector.x(), 0.5 * vector.y(), 0.5 * vector.z())
        .normalized();
  }
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
}

/// Derivatives of one corner's pixel by all parameters.
struct CornerSight {
  Eigen::Vector2d pixel_px;
  Eigen::Matrix<double, 2, kLens> lens;
  Eigen::Matrix<double, 2, 3> world;  ///< By the point in the world.
  Eigen::Vector3d from_centre;
  Eigen::Vector3d from_target;  ///< The point minus the target's origin, in the world.
  Eigen::Vector3d from_piece;   ///< The point minus the piece's origin, in the target.
};

using Pixels = Eigen::Matrix<double, 8, 1>;
using Rows = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kLens>;

constexpr std::size_t kFirstPose = 2;  // After intrinsics and the camera's pose.

/// Corrects a tag's four pixels for shrinkage; derivatives by the pixels and the
/// shrinkage.
Pixels shrink(const Pixels& seen,
              const double* shrinkage,
              Eigen::Matrix<double, 8, 10>* by) {
  using Jet = ceres::Jet<double, 10>;
  std::array<std::array<Jet, 2>, 4> corners;
  for (int i = 0; i < 8; ++i) {
    corners[static_cast<std::size_t>(i / 2)][static_cast<std::size_t>(i % 2)] =
        Jet(seen[i], i);
  }
  const Jet offset(shrinkage[0], 8);
  const Jet slope(shrinkage[1], 9);
  move_edges(corners, [&](const Jet& apart_px) {
    return Jet(apart_px - offset - slope * apart_px);
  });
  Pixels out;
  for (int i = 0; i < 8; ++i) {
    const Jet& value =
        corners[static_cast<std::size_t>(i / 2)][static_cast<std::size_t>(i % 2)];
    out[i] = value.a;
    by->row(i) = value.v.transpose();
  }
  return out;
}

}  // namespace

bool PoseManifold::Plus(const double* x, const double* step, double* out) const {
  const Eigen::Quaterniond q =
      (turn(Eigen::Map<const Eigen::Vector3d>(step)) * rotation_of(x)).normalized();
  out[0] = q.x();
  out[1] = q.y();
  out[2] = q.z();
  out[3] = q.w();
  for (int i = 4; i < numbers_; ++i) out[i] = x[i] + (i <= steps_ ? step[i - 1] : 0.0);
  return true;
}

bool PoseManifold::PlusJacobian(const double*, double* jacobian) const {
  Eigen::Map<RowMajor> m(jacobian, AmbientSize(), TangentSize());
  m.setIdentity();
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* step) const {
  const Eigen::AngleAxisd between(rotation_of(y) * rotation_of(x).conjugate());
  for (int i = 0; i < 3; ++i) step[i] = between.angle() * between.axis()[i];
  for (int i = 4; i <= steps_; ++i) step[i - 1] = y[i] - x[i];
  return true;
}

bool PoseManifold::MinusJacobian(const double*, double* jacobian) const {
  Eigen::Map<RowMajor> m(jacobian, TangentSize(), AmbientSize());
  m.setIdentity();
  return true;
}

bool SizeManifold::Plus(const double* x, const double* step, double* out) const {
  std::copy_n(x, 8, out);
  out[7] += step[0];
  return true;
}

bool SizeManifold::PlusJacobian(const double*, double* jacobian) const {
  std::fill_n(jacobian, 8, 0.0);
  jacobian[6] = 1.0;
  return true;
}

bool SizeManifold::Minus(const double* y, const double* x, double* step) const {
  step[0] = y[7] - x[7];
  return true;
}

bool SizeManifold::MinusJacobian(const double* x, double* jacobian) const {
  return PlusJacobian(x, jacobian);
}

SightingCost::SightingCost(const Sighting& sighting,
                           const RigidTarget& target,
                           LensModel lens,
                           int height_px,
                           Parts parts,
                           Knots knots)
    : sighting_(sighting), lens_(lens), parts_(parts), knots_(knots) {
  set_num_residuals(2 * sighting.count);
  auto& sizes = *mutable_parameter_block_sizes();
  sizes = {kLens, 7};
  sizes.insert(sizes.end(), parts.spline ? 4 : 1, 7);
  if (parts.spline) sizes.push_back(3);
  if (parts.shrinks) sizes.push_back(2);
  if (parts.piece) sizes.push_back(8);
  if (parts.warp) sizes.push_back(3);
  for (std::size_t i = 0; i < static_cast<std::size_t>(sighting.count); ++i) {
    bend_[i] = board_warp(target, sighting.corners[i].p_in_board);
    line_ += sighting.corners[i].pixel_px.y / sighting.count;
  }
  line_ -= 0.5 * (height_px - 1);
}

/// A target's pose at the time of a sighting, from its pose or from four knots and a
/// clock.
struct TargetPose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d origin;
  SplinePose spline;
};

/// Indices of the blocks (SightingCost).
struct SightingCost::BlockIndices {
  std::size_t clock = 0;
  std::size_t shrinkage = 0;
  std::size_t piece = 0;
  std::size_t warp = 0;
};

SightingCost::BlockIndices SightingCost::block_indices() const {
  BlockIndices indices;
  std::size_t next = kFirstPose + (parts_.spline ? 4 : 1);
  indices.clock = next;
  next += parts_.spline ? 1 : 0;
  indices.shrinkage = next;
  next += parts_.shrinks ? 1 : 0;
  indices.piece = next;
  next += parts_.piece ? 1 : 0;
  indices.warp = next;
  return indices;
}

TargetPose SightingCost::target_pose(const double* const* blocks) const {
  TargetPose out;
  if (!parts_.spline) {
    out.rotation = rotation_of(blocks[kFirstPose]).toRotationMatrix();
    out.origin = Eigen::Map<const Eigen::Vector3d>(blocks[kFirstPose] + 4);
    return out;
  }
  const double* clock = blocks[kFirstPose + 4];
  const double time_s = sighting_.time_s * (1.0 + clock[1]) + clock[0] + clock[2] * line_;
  const double* const* knots = blocks + kFirstPose;
  out.spline = spline_pose({knots[0], knots[1], knots[2], knots[3]},
                           (time_s - knots_.first_s) / knots_.spacing_s);
  out.rotation = out.spline.rotation;
  out.origin = out.spline.translation;
  return out;
}

/// Intermediate results for the derivatives of a sighting.
struct SightingCost::View {
  TargetPose target;
  Eigen::Matrix3d piece_rotation = Eigen::Matrix3d::Identity();
  double size_m = 1.0;
  std::array<CornerSight, 4> sights;
  Pixels pixels = Pixels::Zero();  ///< Corrected for shrinkage, if enabled.
  Eigen::Matrix<double, 8, 10> by_seen = Eigen::Matrix<double, 8, 10>::Identity();
  Pixels weight = Pixels::Zero();
};

bool SightingCost::project_target(const double* const* blocks, View& view) const {
  const BlockIndices at = block_indices();
  view.target = target_pose(blocks);
  const double* camera = blocks[1];
  const Eigen::Matrix3d camera_from_world =
      rotation_of(camera).conjugate().toRotationMatrix();
  const Eigen::Vector3d centre = Eigen::Map<const Eigen::Vector3d>(camera + 4);
  Eigen::Vector3d piece_origin = Eigen::Vector3d::Zero();
  if (parts_.piece) {
    view.piece_rotation = rotation_of(blocks[at.piece]).toRotationMatrix();
    piece_origin = Eigen::Map<const Eigen::Vector3d>(blocks[at.piece] + 4);
    view.size_m = std::exp(blocks[at.piece][7]);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(sighting_.count); ++i) {
    CornerSight& sight = view.sights[i];
    Eigen::Vector3d p = to_eigen(sighting_.corners[i].p_in_board);
    if (parts_.warp) {
      for (std::size_t k = 0; k < 3; ++k) p.z() += bend_[i][k] * blocks[at.warp][k];
    }
    sight.from_piece = view.piece_rotation * (view.size_m * p);
    sight.from_target = view.target.rotation * (sight.from_piece + piece_origin);
    sight.from_centre = sight.from_target + view.target.origin - centre;
    const auto pixel =
        pixel_of_point(lens_, blocks[0], camera_from_world * sight.from_centre);
    if (!pixel) return false;
    sight.lens = pixel->by_lens;
    sight.world = pixel->by_point * camera_from_world;
    const auto row = 2 * static_cast<Eigen::Index>(i);
    view.pixels.segment<2>(row) = pixel->pixel_px;
    view.weight.segment<2>(row).setConstant(1.0 / sighting_.corners[i].sigma_px);
  }
  if (parts_.shrinks) {
    view.pixels = shrink(view.pixels, blocks[at.shrinkage], &view.by_seen);
  }
  return true;
}

template <class OfCorner>
void SightingCost::put(const View& view,
                       double* jacobian,
                       std::size_t block,
                       int columns,
                       const OfCorner& of_corner) const {
  if (!jacobian) return;
  const int rows = 2 * sighting_.count;
  Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, kLens> raw(8, columns);
  raw.setZero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(sighting_.count); ++i) {
    raw.middleRows<2>(2 * static_cast<Eigen::Index>(i)) = of_corner(i, view.sights[i]);
  }
  if (parts_.shrinks) raw = (view.by_seen.leftCols<8>() * raw).eval();
  Eigen::Map<RowMajor> out(jacobian, rows, parameter_block_sizes()[block]);
  out.setZero();
  out.leftCols(columns) = view.weight.head(rows).asDiagonal() * raw.topRows(rows);
}

void SightingCost::put_target(const View& view, double** jacobians) const {
  if (!parts_.spline) {
    put(view,
        jacobians[kFirstPose],
        kFirstPose,
        6,
        [&](std::size_t, const CornerSight& s) -> Rows {
          Rows d(2, 6);
          d << -s.world * cross_matrix<Eigen::Matrix3d>(s.from_target), s.world;
          return d;
        });
    return;
  }
  const SplinePose& spline = view.target.spline;
  for (std::size_t k = 0; k < 4; ++k) {
    put(view,
        jacobians[kFirstPose + k],
        kFirstPose + k,
        6,
        [&](std::size_t, const CornerSight& s) -> Rows {
          Rows d(2, 6);
          d << -s.world * cross_matrix<Eigen::Matrix3d>(s.from_target) *
                   spline.rotation_by_knot[k],
              s.world * spline.translation_by_knot[k];
          return d;
        });
  }
  const std::size_t clock = block_indices().clock;
  put(view, jacobians[clock], clock, 3, [&](std::size_t, const CornerSight& s) -> Rows {
    const Eigen::Vector2d by_time =
        s.world * (spline.rotation_by_u.cross(s.from_target) + spline.translation_by_u) /
        knots_.spacing_s;
    Rows d(2, 3);
    d << by_time, by_time * sighting_.time_s, by_time * line_;
    return d;
  });
}

void SightingCost::put_rest(const View& view, double** jacobians) const {
  const BlockIndices at = block_indices();
  const Eigen::Matrix3d& rotation = view.target.rotation;
  if (parts_.shrinks && jacobians[at.shrinkage]) {
    Eigen::Map<Eigen::Matrix<double, 8, 2, Eigen::RowMajor>> out(jacobians[at.shrinkage]);
    out = view.weight.asDiagonal() * view.by_seen.rightCols<2>();
  }
  if (parts_.piece) {
    put(view,
        jacobians[at.piece],
        at.piece,
        7,
        [&](std::size_t, const CornerSight& s) -> Rows {
          Rows d(2, 7);
          d << -s.world * rotation * cross_matrix<Eigen::Matrix3d>(s.from_piece),
              s.world * rotation, s.world * rotation * s.from_piece;
          return d;
        });
  }
  if (parts_.warp) {
    put(view,
        jacobians[at.warp],
        at.warp,
        3,
        [&](std::size_t i, const CornerSight& s) -> Rows {
          const Eigen::Vector2d up =
              s.world * rotation * view.piece_rotation.col(2) * view.size_m;
          Rows d(2, 3);
          d << up * bend_[i][0], up * bend_[i][1], up * bend_[i][2];
          return d;
        });
  }
}

bool SightingCost::Evaluate(const double* const* blocks,
                            double* residuals,
                            double** jacobians) const {
  View view;
  if (!project_target(blocks, view)) return false;
  for (int i = 0; i < 2 * sighting_.count; ++i) {
    const BoardCorner& corner = sighting_.corners[static_cast<std::size_t>(i / 2)];
    residuals[i] = (view.pixels[i] - corner.pixel_px[i % 2]) * view.weight[i];
  }
  if (!jacobians) return true;
  put(view, jacobians[0], 0, kLens, [](std::size_t, const CornerSight& s) -> Rows {
    return s.lens;
  });
  put(view, jacobians[1], 1, 6, [](std::size_t, const CornerSight& s) -> Rows {
    Rows d(2, 6);
    d << s.world * cross_matrix<Eigen::Matrix3d>(s.from_centre), -s.world;
    return d;
  });
  put_target(view, jacobians);
  put_rest(view, jacobians);
  return true;
}

}  // namespace marey::calib
