// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/segment_inertia.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace marey::retarget {
namespace {

// Smallest spread of mass in any direction, as a share of the segment's total spread.
constexpr double kMinSpread = 1e-3;

double trace(const glm::dmat3& m) {
  return m[0][0] + m[1][1] + m[2][2];
}

// Second moments of the mass (sum of p p^T) from the inertia. A body can have an inertia
// if and only if these are positive semidefinite.
glm::dmat3 spread_of(const glm::dmat3& inertia) {
  return 0.5 * trace(inertia) * glm::dmat3(1.0) - inertia;
}

glm::dmat3 inertia_of(const glm::dmat3& spread) {
  return trace(spread) * glm::dmat3(1.0) - spread;
}

// Raises the eigenvalues of a symmetric matrix to at least `min` (Jacobi rotations).
glm::dmat3 with_min_eigenvalue(glm::dmat3 m, double min) {
  constexpr std::array<std::array<int, 2>, 3> kPairs{{{0, 1}, {0, 2}, {1, 2}}};
  glm::dmat3 axes(1.0);
  for (int sweep = 0; sweep < 12; ++sweep) {
    for (const auto& [p, q] : kPairs) {
      if (std::abs(m[p][q]) < 1e-300) continue;
      const double theta = 0.5 * (m[q][q] - m[p][p]) / m[p][q];
      const double t =
          std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
      const double c = 1.0 / std::hypot(t, 1.0);
      glm::dmat3 turn(1.0);
      turn[p][p] = c;
      turn[q][q] = c;
      turn[p][q] = -t * c;
      turn[q][p] = t * c;
      m = glm::transpose(turn) * m * turn;
      axes = axes * turn;
    }
  }
  glm::dmat3 out(0.0);
  for (int k = 0; k < 3; ++k) {
    out += std::max(m[k][k], min) * glm::outerProduct(axes[k], axes[k]);
  }
  return out;
}

}  // namespace

glm::dmat3 inertia_per_kg(const GyrationRadii& radii, const SegmentAxes& axes) {
  const double length_m = glm::length(axes.along_m);
  if (length_m < 1e-9) return glm::dmat3(0.0);
  const glm::dvec3 longitudinal = axes.along_m / length_m;
  glm::dvec3 transverse =
      axes.transverse - glm::dot(axes.transverse, longitudinal) * longitudinal;
  if (glm::length(transverse) < 1e-6) {
    // Any direction across serves. This one is alike on both sides of a body.
    const glm::dvec3 other = std::abs(longitudinal.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0)
                                                            : glm::dvec3(0.0, 0.0, 1.0);
    transverse = other - glm::dot(other, longitudinal) * longitudinal;
  }
  transverse = glm::normalize(transverse);
  const glm::dvec3 sagittal = glm::cross(transverse, longitudinal);
  const auto about = [&](const glm::dvec3& axis, double radius) {
    const double radius_m = radius * length_m;
    return radius_m * radius_m * glm::outerProduct(axis, axis);
  };
  return about(sagittal, radii.sagittal) + about(transverse, radii.transverse) +
         about(longitudinal, radii.longitudinal);
}

glm::dmat3 part_inertia_per_kg(const glm::dmat3& segment_inertia_per_kg_m2,
                               std::span<const SegmentPart> parts) {
  const glm::dmat3 whole = spread_of(segment_inertia_per_kg_m2);
  glm::dmat3 left = whole;
  for (const SegmentPart& part : parts) {
    left -= part.mass_share * glm::outerProduct(part.from_centre_m, part.from_centre_m);
  }
  return inertia_of(with_min_eigenvalue(left, kMinSpread * trace(whole)));
}

}  // namespace marey::retarget
