// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/sighting_cost.h"

#include <algorithm>
#include <cmath>

#include "calib/see_point.h"

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

/// Derivatives of one corner's pixel by everything that moves it.
struct CornerSight {
  Eigen::Vector2d pixel_px;
  Eigen::Matrix<double, 2, kLens> lens;
  Eigen::Matrix<double, 2, 3> world;  ///< By the point in the world.
  Eigen::Vector3d from_centre;
  Eigen::Vector3d from_target;  ///< The point less the target's origin, in the world.
  Eigen::Vector3d from_piece;   ///< The point less the piece's origin, in the target.
};

using Pixels = Eigen::Matrix<double, 8, 1>;

/// Shrinks a tag's four pixels; derivatives by the pixels and the shrinkage.
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

std::array<double, 3> board_warp(const RigidTarget& target,
                                 const glm::dvec3& p_in_target) {
  const double x = (p_in_target.x - target.middle_in_target.x) / target.half_extent_m.x;
  const double y = (p_in_target.y - target.middle_in_target.y) / target.half_extent_m.y;
  return {x * x, y * y, x * y};
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

bool SightingCost::Evaluate(const double* const* blocks,
                            double* residuals,
                            double** jacobians) const {
  const double* lens = blocks[0];
  const double* camera = blocks[1];
  std::size_t next = 2;
  const std::size_t first_pose = next;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d origin;
  SplinePose spline;
  std::size_t clock_block = 0;
  if (parts_.spline) {
    clock_block = next + 4;
    const double* clock = blocks[clock_block];
    const double time_s =
        sighting_.time_s * (1.0 + clock[1]) + clock[0] + clock[2] * line_;
    const double u = (time_s - knots_.first_s) / knots_.spacing_s;
    spline = spline_pose(
        {blocks[next], blocks[next + 1], blocks[next + 2], blocks[next + 3]}, u);
    rotation = spline.rotation;
    origin = spline.translation;
    next += 5;
  } else {
    rotation = rotation_of(blocks[next]).toRotationMatrix();
    origin = Eigen::Map<const Eigen::Vector3d>(blocks[next] + 4);
    next += 1;
  }
  const std::size_t shrink_block = next;
  next += parts_.shrinks;
  const std::size_t piece_block = next;
  next += parts_.piece;
  const std::size_t warp_block = next;

  const Eigen::Matrix3d camera_from_world =
      rotation_of(camera).conjugate().toRotationMatrix();
  const Eigen::Vector3d centre = Eigen::Map<const Eigen::Vector3d>(camera + 4);
  Eigen::Matrix3d piece_rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d piece_origin = Eigen::Vector3d::Zero();
  double size_m = 1.0;
  if (parts_.piece) {
    piece_rotation = rotation_of(blocks[piece_block]).toRotationMatrix();
    piece_origin = Eigen::Map<const Eigen::Vector3d>(blocks[piece_block] + 4);
    size_m = std::exp(blocks[piece_block][7]);
  }

  const auto count = static_cast<std::size_t>(sighting_.count);
  std::array<CornerSight, 4> sights;
  Pixels pixels = Pixels::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    CornerSight& sight = sights[i];
    Eigen::Vector3d p = to_eigen(sighting_.corners[i].p_in_board);
    if (parts_.warp) {
      for (std::size_t k = 0; k < 3; ++k) p.z() += bend_[i][k] * blocks[warp_block][k];
    }
    sight.from_piece = piece_rotation * (size_m * p);
    sight.from_target = rotation * (sight.from_piece + piece_origin);
    sight.from_centre = sight.from_target + origin - centre;
    const auto pixel = pixel_of_point(lens_, lens, camera_from_world * sight.from_centre);
    if (!pixel) return false;
    sight.lens = pixel->by_lens;
    sight.world = pixel->by_point * camera_from_world;
    pixels.segment<2>(2 * static_cast<int>(i)) = pixel->pixel_px;
  }
  Eigen::Matrix<double, 8, 10> by_seen = Eigen::Matrix<double, 8, 10>::Identity();
  if (parts_.shrinks) pixels = shrink(pixels, blocks[shrink_block], &by_seen);
  const int rows = 2 * sighting_.count;
  Pixels weight;
  for (int i = 0; i < rows; ++i) {
    const BoardCorner& corner = sighting_.corners[static_cast<std::size_t>(i / 2)];
    weight[i] = 1.0 / corner.sigma_px;
    residuals[i] = (pixels[i] - corner.pixel_px[i % 2]) * weight[i];
  }
  if (!jacobians) return true;

  const auto put = [&](std::size_t block, int columns, const auto& of_corner) {
    if (!jacobians[block]) return;
    Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, kLens> raw(8, columns);
    raw.setZero();
    for (std::size_t i = 0; i < count; ++i) {
      raw.middleRows<2>(2 * static_cast<int>(i)) = of_corner(i, sights[i]);
    }
    if (parts_.shrinks) raw = (by_seen.leftCols<8>() * raw).eval();
    Eigen::Map<RowMajor> out(jacobians[block], rows, parameter_block_sizes()[block]);
    out.setZero();
    out.leftCols(columns) = weight.head(rows).asDiagonal() * raw.topRows(rows);
  };
  using Two = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kLens>;
  put(0, kLens, [&](std::size_t, const CornerSight& s) -> Two { return s.lens; });
  put(1, 6, [&](std::size_t, const CornerSight& s) -> Two {
    Two d(2, 6);
    d << s.world * cross_matrix(s.from_centre), -s.world;
    return d;
  });
  if (parts_.spline) {
    for (std::size_t k = 0; k < 4; ++k) {
      put(first_pose + k, 6, [&](std::size_t, const CornerSight& s) -> Two {
        Two d(2, 6);
        d << -s.world * cross_matrix(s.from_target) * spline.rotation_by_knot[k],
            s.world * spline.translation_by_knot[k];
        return d;
      });
    }
    put(clock_block, 3, [&](std::size_t, const CornerSight& s) -> Two {
      const Eigen::Vector2d by_time =
          s.world *
          (spline.rotation_by_u.cross(s.from_target) + spline.translation_by_u) /
          knots_.spacing_s;
      Two d(2, 3);
      d << by_time, by_time * sighting_.time_s, by_time * line_;
      return d;
    });
  } else {
    put(first_pose, 6, [&](std::size_t, const CornerSight& s) -> Two {
      Two d(2, 6);
      d << -s.world * cross_matrix(s.from_target), s.world;
      return d;
    });
  }
  if (parts_.shrinks && jacobians[shrink_block]) {
    Eigen::Map<Eigen::Matrix<double, 8, 2, Eigen::RowMajor>> out(jacobians[shrink_block]);
    out = weight.asDiagonal() * by_seen.rightCols<2>();
  }
  if (parts_.piece) {
    put(piece_block, 7, [&](std::size_t, const CornerSight& s) -> Two {
      Two d(2, 7);
      d << -s.world * rotation * cross_matrix(s.from_piece), s.world * rotation,
          s.world * rotation * s.from_piece;
      return d;
    });
  }
  if (parts_.warp) {
    put(warp_block, 3, [&](std::size_t i, const CornerSight& s) -> Two {
      const Eigen::Vector2d up = s.world * rotation * piece_rotation.col(2) * size_m;
      Two d(2, 3);
      d << up * bend_[i][0], up * bend_[i][1], up * bend_[i][2];
      return d;
    });
  }
  return true;
}

}  // namespace marey::calib
