// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/spline_pose.h"

#include <ceres/jet.h>
#include <ceres/rotation.h>

namespace marey::calib {
namespace {

// A rotation step of each of four knots, then u.
constexpr int kInputs = 13;
using Jet = ceres::Jet<double, kInputs>;
using JetQuaternion = std::array<Jet, 4>;  // w, x, y, z

JetQuaternion product(const JetQuaternion& a, const JetQuaternion& b) {
  JetQuaternion out;
  ceres::QuaternionProduct(a.data(), b.data(), out.data());
  return out;
}

JetQuaternion conjugate(const JetQuaternion& q) {
  return {q[0], -q[1], -q[2], -q[3]};
}

/// Returns the knot's rotation after a small step on its left.
JetQuaternion stepped(const double* xyzw, int first_input) {
  const JetQuaternion q{Jet(xyzw[3]), Jet(xyzw[0]), Jet(xyzw[1]), Jet(xyzw[2])};
  JetQuaternion step{Jet(1.0), Jet(0.0), Jet(0.0), Jet(0.0)};
  for (int i = 0; i < 3; ++i)
    step[static_cast<std::size_t>(i + 1)].v[first_input + i] = 0.5;
  return product(step, q);
}

/// Returns the cumulative basis: the fractions of the step from knot j - 1 to j.
std::array<Jet, 3> taken(const Jet& u) {
  const Jet u2 = u * u;
  const Jet u3 = u2 * u;
  return {(5.0 + 3.0 * u - 3.0 * u2 + u3) / 6.0,
          (1.0 + 3.0 * u + 3.0 * u2 - 2.0 * u3) / 6.0,
          u3 / 6.0};
}

}  // namespace

SplinePose spline_pose(const std::array<const double*, 4>& knots, double u) {
  const std::array<Jet, 3> basis = taken(Jet(u, kInputs - 1));
  JetQuaternion q = stepped(knots[0], 0);
  JetQuaternion before = q;
  SplinePose out;
  out.translation = Eigen::Map<const Eigen::Vector3d>(knots[0] + 4);
  out.translation_by_u.setZero();
  out.translation_by_knot = {1.0, 0.0, 0.0, 0.0};
  for (std::size_t j = 1; j < 4; ++j) {
    const JetQuaternion here = stepped(knots[j], 3 * static_cast<int>(j));
    const JetQuaternion step = product(conjugate(before), here);
    std::array<Jet, 3> vector;
    ceres::QuaternionToAngleAxis(step.data(), vector.data());
    for (Jet& x : vector) x *= basis[j - 1];
    JetQuaternion part;
    ceres::AngleAxisToQuaternion(vector.data(), part.data());
    q = product(q, part);
    before = here;

    const Eigen::Vector3d travel = Eigen::Map<const Eigen::Vector3d>(knots[j] + 4) -
                                   Eigen::Map<const Eigen::Vector3d>(knots[j - 1] + 4);
    out.translation += basis[j - 1].a * travel;
    out.translation_by_u += basis[j - 1].v[kInputs - 1] * travel;
    out.translation_by_knot[j] += basis[j - 1].a;
    out.translation_by_knot[j - 1] -= basis[j - 1].a;
  }
  const Eigen::Quaterniond value(q[0].a, q[1].a, q[2].a, q[3].a);
  out.rotation = value.normalized().toRotationMatrix();
  const Eigen::Quaterniond back = value.conjugate();
  for (int i = 0; i < kInputs; ++i) {
    const Eigen::Quaterniond by(q[0].v[i], q[1].v[i], q[2].v[i], q[3].v[i]);
    const Eigen::Vector3d step = 2.0 * (by * back).vec();
    if (i == kInputs - 1) {
      out.rotation_by_u = step;
    } else {
      out.rotation_by_knot[static_cast<std::size_t>(i / 3)].col(i % 3) = step;
    }
  }
  return out;
}

}  // namespace marey::calib
