// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/momentum/flight_turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dynamics/momentum/posed_masses.h"
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

// Largest rotation of one step: beyond, the linear equations do not hold.
constexpr double kMaxStep_rad = 0.4;
constexpr std::size_t kUnknowns = 6;
constexpr std::size_t kRows = kUnknowns + 3;
using Equations = std::array<std::array<double, kRows + 1>, kRows>;

// Columns of the matrix whose product with x is the cross product of v and x.
glm::dmat3 cross_with(const glm::dvec3& v) {
  return {0.0, v.z, -v.y, -v.z, 0.0, v.x, v.y, -v.x, 0.0};
}

double trace(const glm::dmat3& m) {
  return m[0][0] + m[1][1] + m[2][2];
}

// The matrix that gives a x (phi x b) from phi, for a b^T or a sum of such products.
glm::dmat3 double_cross(const glm::dmat3& a_bt) {
  return trace(a_bt) * glm::dmat3(1.0) - glm::transpose(a_bt);
}

// Gaussian elimination with pivoting. The solution is in the last column. Returns false
// for a singular matrix.
bool eliminate(Equations& e) {
  for (std::size_t c = 0; c < kRows; ++c) {
    std::size_t best = c;
    for (std::size_t r = c + 1; r < kRows; ++r) {
      if (std::abs(e[r][c]) > std::abs(e[best][c])) best = r;
    }
    if (!(std::abs(e[best][c]) > 1e-300)) return false;
    std::swap(e[c], e[best]);
    for (std::size_t r = 0; r < kRows; ++r) {
      if (r == c) continue;
      const double factor = e[r][c] / e[c][c];
      for (std::size_t k = c; k <= kRows; ++k) e[r][k] -= factor * e[c][k];
    }
  }
  for (std::size_t r = 0; r < kRows; ++r) e[r][kRows] /= e[r][r];
  return true;
}

}  // namespace

FlightTurn::FlightTurn(const Skeleton& skeleton,
                       std::span<const PointMass> masses,
                       FrameRate rate,
                       std::span<const Pose> poses)
    : step_s_(1.0 / rate.hz),
      turns_(poses.size(), glm::dquat(1.0, 0.0, 0.0, 0.0)),
      coms_in_world_(poses.size()),
      cross_moments_(poses.size() - 1),
      momenta_(poses.size() - 2),
      slopes_(poses.size() - 2),
      rows_(poses.size()) {
  MAREY_ASSERT(poses.size() >= 3 && rate.hz > 0.0 && total_mass_kg(masses) > 0.0);
  for (const PointMass& mass : masses) {
    if (mass.inertia_per_kg_m2 != glm::dmat3(0.0)) ++own_count_;
  }
  own_.resize(own_count_ * momenta_.size());
  std::vector<RigidTransform> joints(skeleton.joints.size());
  std::array<PosedMasses, 3> ring;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const PosedMasses& here = ring[k % 3];
    place_masses_of_pose(skeleton, masses, poses[k], joints, ring[k % 3]);
    coms_in_world_[k] = here.com_in_world;
    if (k == 0) {
      inertia_kg_m2_ = trace(locked_inertia(masses, here)) / 3.0;
      continue;
    }
    const PosedMasses& before = ring[(k - 1) % 3];
    glm::dmat3 moments(0.0);
    for (std::size_t i = 0; i < masses.size(); ++i) {
      moments +=
          masses[i].mass_kg * glm::outerProduct(before.from_com_m[i], here.from_com_m[i]);
    }
    cross_moments_[k - 1] = moments;
    if (k == 1) continue;
    const PosedMasses& twice_before = ring[(k - 2) % 3];
    OwnTurn* own = own_.data() + own_count_ * (k - 2);
    for (std::size_t i = 0; i < masses.size(); ++i) {
      if (masses[i].inertia_per_kg_m2 == glm::dmat3(0.0)) continue;
      own->inertia_kg_m2 = own_inertia(masses[i], before.world_from_mass[i]);
      own->after_from_before =
          here.world_from_mass[i] * glm::conjugate(twice_before.world_from_mass[i]);
      ++own;
    }
  }
  measure();
}

// The sum over all masses of the cross product of the place in a frame and the difference
// of places in its neighbours, plus their own inertia times their rotation between the
// neighbours. Sums with subscript "own" are in the axes of the captured posture.
void FlightTurn::measure() {
  const double span_s = 2.0 * step_s_;
  for (std::size_t k = 1; k + 1 < frame_count(); ++k) {
    const glm::dmat3 before = glm::mat3_cast(turns_[k - 1]);
    const glm::dmat3 here = glm::mat3_cast(turns_[k]);
    const glm::dmat3 captured = glm::transpose(here);
    const glm::dmat3 forth =
        here * cross_moments_[k] * glm::transpose(glm::mat3_cast(turns_[k + 1]));
    const glm::dmat3 back =
        here * glm::transpose(cross_moments_[k - 1]) * glm::transpose(before);
    const glm::dmat3 here_from_before = captured * before;
    const glm::dquat added = glm::conjugate(turns_[k - 1]) * turns_[k + 1];
    glm::dvec3 own_sum(0.0);
    glm::dmat3 own_inertia_sum(0.0);
    glm::dmat3 own_cross_sum(0.0);
    const OwnTurn* own = own_.data() + own_count_ * (k - 1);
    for (std::size_t i = 0; i < own_count_; ++i) {
      const glm::dmat3& inertia = own[i].inertia_kg_m2;
      const glm::dvec3 turn =
          here_from_before * quick_rotation_vector(added * own[i].after_from_before);
      own_sum += inertia * turn;
      own_inertia_sum += inertia;
      own_cross_sum += inertia * cross_with(turn);
    }
    momenta_[k - 1] = (axial(forth - back) + here * own_sum) / span_s;
    // The logarithm of a rotation to first order in that rotation.
    const glm::dmat3 inertia = here * own_inertia_sum * captured;
    const glm::dmat3 cross = here * own_cross_sum * captured;
    Slopes& slopes = slopes_[k - 1];
    slopes.after = double_cross(forth) + inertia - 0.5 * cross;
    slopes.before = -(double_cross(back) + inertia + 0.5 * cross);
    slopes.here = glm::transpose(double_cross(back) - double_cross(forth)) -
                  cross_with(here * own_sum) + cross;
  }
}

glm::dvec3 FlightTurn::mean_momentum() const {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& momentum : momenta_) sum += momentum;
  return sum / static_cast<double>(momenta_.size());
}

double FlightTurn::sd_kg_m2_s() const {
  const glm::dvec3 mean = mean_momentum();
  glm::dvec3 squares(0.0);
  for (const glm::dvec3& momentum : momenta_) {
    squares += (momentum - mean) * (momentum - mean);
  }
  return std::sqrt(std::max({squares.x, squares.y, squares.z}) /
                   static_cast<double>(momenta_.size()));
}

double FlightTurn::largest_turn_rad() const {
  double largest_rad = 0.0;
  for (const glm::dquat& turn : turns_) {
    largest_rad = std::max(largest_rad, glm::length(quick_rotation_vector(turn)));
  }
  return largest_rad;
}

// The rotation of frame k + 1 follows from those of k - 1 and k, since the momentum of k
// has to be the constant one.
void FlightTurn::march(const glm::dvec3& mean, double scale) {
  rows_[0] = {};
  rows_[1] = {glm::dvec3(0.0), glm::dmat3(1.0), glm::dmat3(0.0)};
  const double span_s = 2.0 * step_s_;
  for (std::size_t k = 1; k + 1 < frame_count(); ++k) {
    const Slopes& slopes = slopes_[k - 1];
    const glm::dmat3 solve = glm::inverse(slopes.after);
    const glm::dmat3 of_before = -(solve * slopes.before);
    const glm::dmat3 of_here = -(solve * slopes.here);
    const Row& before = rows_[k - 1];
    const Row& here = rows_[k];
    rows_[k + 1] = {solve * (span_s * (mean - momenta_[k - 1])) +
                        of_before * before.constant + of_here * here.constant,
                    of_before * before.of_first + of_here * here.of_first,
                    (span_s * scale) * solve + of_before * before.of_momentum +
                        of_here * here.of_momentum};
  }
}

// Central differences leave the offset between the even and the odd frames open. This
// solution ends without rotation and has the smallest second differences.
bool FlightTurn::solve(glm::dvec3& first, glm::dvec3& momentum) const {
  Equations e{};
  const auto column = [](const Row& row, std::size_t c) {
    const auto axis = static_cast<glm::length_t>(c % 3);
    return c < 3 ? row.of_first[axis] : row.of_momentum[axis];
  };
  for (std::size_t k = 1; k + 1 < frame_count(); ++k) {
    std::array<glm::dvec3, kUnknowns + 1> bend;
    for (std::size_t c = 0; c < kUnknowns; ++c) {
      bend[c] =
          column(rows_[k + 1], c) - 2.0 * column(rows_[k], c) + column(rows_[k - 1], c);
    }
    bend[kUnknowns] =
        -(rows_[k + 1].constant - 2.0 * rows_[k].constant + rows_[k - 1].constant);
    for (std::size_t r = 0; r < kUnknowns; ++r) {
      for (std::size_t c = 0; c < kUnknowns; ++c) e[r][c] += glm::dot(bend[r], bend[c]);
      e[r][kRows] += glm::dot(bend[r], bend[kUnknowns]);
    }
  }
  const Row& last = rows_.back();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<glm::length_t>(i);
    for (std::size_t c = 0; c < kUnknowns; ++c) {
      e[kUnknowns + i][c] = column(last, c)[axis];
      e[c][kUnknowns + i] = column(last, c)[axis];
    }
    e[kUnknowns + i][kRows] = -last.constant[axis];
  }
  if (!eliminate(e)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    first[static_cast<glm::length_t>(i)] = e[i][kRows];
    momentum[static_cast<glm::length_t>(i)] = e[3 + i][kRows];
  }
  return true;
}

std::optional<double> FlightTurn::step() {
  // The unknown momentum in units that give about as much rotation as the other unknown.
  const double scale = inertia_kg_m2_ / (step_s_ * static_cast<double>(frame_count()));
  march(mean_momentum(), scale);
  glm::dvec3 first(0.0);
  glm::dvec3 momentum(0.0);
  if (!solve(first, momentum)) return std::nullopt;
  const auto rotation = [&](std::size_t k) {
    const Row& row = rows_[k];
    return row.constant + row.of_first * first + row.of_momentum * momentum;
  };
  double largest_rad = 0.0;
  for (std::size_t k = 1; k + 1 < frame_count(); ++k) {
    const double angle_rad = glm::length(rotation(k));
    if (!std::isfinite(angle_rad)) return std::nullopt;
    largest_rad = std::max(largest_rad, angle_rad);
  }
  const double share = std::min(1.0, kMaxStep_rad / std::max(largest_rad, 1e-300));
  for (std::size_t k = 1; k + 1 < frame_count(); ++k) {
    turns_[k] = glm::normalize(rotation_from_vector(share * rotation(k)) * turns_[k]);
  }
  measure();
  return largest_rad;
}

}  // namespace marey::dynamics
