// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/planar_match.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "retarget/body/place_masses.h"

namespace marey::edit {
namespace {

glm::dvec3 turned(double cos_turn, double sin_turn, const glm::dvec3& p) {
  return {p.x * cos_turn + p.z * sin_turn, p.y, p.z * cos_turn - p.x * sin_turn};
}

// Mass of each joint's own segment. [kg]
std::vector<double> segment_masses(const Skeleton& skeleton,
                                   const retarget::BodyMap& map) {
  std::vector<double> mass(skeleton.joints.size(), 0.0);
  const auto points = retarget::place_masses(skeleton, map, MassSpec{});
  if (!points) {
    // The default table cannot fail; all joints alike is the neutral answer.
    std::fill(mass.begin(), mass.end(), 1.0);
    return mass;
  }
  for (const PointMass& point : *points) mass[index(point.joint)] += point.mass_kg;
  return mass;
}

// The nearest joint above that has mass.
std::optional<std::size_t> carrier(const Skeleton& skeleton,
                                   const std::vector<double>& mass,
                                   std::size_t joint) {
  auto parent = skeleton.joints[joint].parent;
  while (parent && mass[index(*parent)] <= 0.0) {
    parent = skeleton.joints[index(*parent)].parent;
  }
  if (!parent) return std::nullopt;
  return index(*parent);
}

}  // namespace

glm::dquat PlanarMove::rotation() const {
  return glm::angleAxis(turn_rad, glm::dvec3(0, 1, 0));
}

RigidTransform PlanarMove::transform() const {
  return {rotation(), {shift_xz_m.x, 0.0, shift_xz_m.y}};
}

glm::dvec3 PlanarMove::operator()(const glm::dvec3& p_in_world) const {
  return turned(std::cos(turn_rad), std::sin(turn_rad), p_in_world) +
         glm::dvec3(shift_xz_m.x, 0.0, shift_xz_m.y);
}

PlanarMove operator*(const PlanarMove& a, const PlanarMove& b) {
  const glm::dvec3 shift = a({b.shift_xz_m.x, 0.0, b.shift_xz_m.y});
  return {a.turn_rad + b.turn_rad, {shift.x, shift.z}};
}

PlanarMove inverse(const PlanarMove& move) {
  const PlanarMove back{-move.turn_rad, {0.0, 0.0}};
  const glm::dvec3 shift = back({-move.shift_xz_m.x, 0.0, -move.shift_xz_m.y});
  return {-move.turn_rad, {shift.x, shift.z}};
}

PlanarMove power(const PlanarMove& move, int count) {
  PlanarMove base = count < 0 ? inverse(move) : move;
  PlanarMove out;
  for (unsigned n = static_cast<unsigned>(std::abs(count)); n > 0; n >>= 1U) {
    if ((n & 1U) != 0U) out = out * base;
    base = base * base;
  }
  return out;
}

void move_pose(const PlanarMove& move, Pose& pose) {
  pose.root_in_world = move(pose.root_in_world);
  pose.parent_from_joint.front() = move.rotation() * pose.parent_from_joint.front();
}

PlanarMove fit_planar(std::span<const glm::dvec3> a,
                      std::span<const glm::dvec3> b,
                      std::span<const double> weights) {
  MAREY_ASSERT(a.size() == b.size() && a.size() == weights.size());
  glm::dvec3 mean_a(0.0);
  glm::dvec3 mean_b(0.0);
  double total = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    mean_a += weights[k] * a[k];
    mean_b += weights[k] * b[k];
    total += weights[k];
  }
  MAREY_ASSERT(total > 0.0);
  mean_a /= total;
  mean_b /= total;
  // Centred first: sums of raw places lose digits far from the origin.
  double sine = 0.0;
  double cosine = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const glm::dvec3 p = a[k] - mean_a;
    const glm::dvec3 q = b[k] - mean_b;
    sine += weights[k] * (p.x * q.z - q.x * p.z);
    cosine += weights[k] * (p.x * q.x + p.z * q.z);
  }
  PlanarMove move;
  move.turn_rad = std::atan2(sine, cosine);
  const glm::dvec3 shift = mean_a - move(mean_b);
  move.shift_xz_m = {shift.x, shift.z};
  return move;
}

std::vector<double> joint_mass_shares(const Skeleton& skeleton,
                                      const retarget::BodyMap& map) {
  const std::vector<double> mass = segment_masses(skeleton, map);
  const std::size_t count = skeleton.joints.size();
  std::vector<std::optional<std::size_t>> ends_segment(count);
  std::vector<int> end_count(count, 0);
  for (std::size_t j = 0; j < count; ++j) {
    if (!skeleton.joints[j].bone) continue;
    ends_segment[j] = carrier(skeleton, mass, j);
    if (ends_segment[j]) ++end_count[*ends_segment[j]];
  }
  std::vector<double> share(count, 0.0);
  double total = 0.0;
  for (std::size_t j = 0; j < count; ++j) {
    share[j] += end_count[j] > 0 ? 0.5 * mass[j] : mass[j];
    if (const auto of = ends_segment[j]) share[j] += 0.5 * mass[*of] / end_count[*of];
    total += mass[j];
  }
  for (double& s : share) s /= total;
  return share;
}

int velocity_reach(double hz) {
  constexpr double kReach_s = 0.025;
  return std::max(1, static_cast<int>(std::lround(kReach_s * hz)));
}

MatchPoints match_points(const Motion& motion, const retarget::BodyMap& map) {
  const std::vector<double> shares = joint_mass_shares(motion.skeleton, map);
  MatchPoints out;
  std::vector<std::size_t> joints;
  for (std::size_t j = 0; j < shares.size(); ++j) {
    if (shares[j] <= 0.0) continue;
    joints.push_back(j);
    out.weights.push_back(shares[j]);
  }
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  out.places.reserve(motion.poses.size() * joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    for (const std::size_t j : joints) out.places.push_back(world[j].translation);
  }
  const int frames = static_cast<int>(motion.poses.size());
  const int reach = velocity_reach(motion.rate.hz);
  out.velocities.resize(out.places.size(), glm::dvec3(0.0));
  for (int k = 0; k < frames && frames > 1; ++k) {
    const int before = std::max(k - reach, 0);
    const int after = std::min(k + reach, frames - 1);
    const double per_s = motion.rate.hz / (after - before);
    for (std::size_t p = 0; p < joints.size(); ++p) {
      const auto at = [&](int frame) {
        return static_cast<std::size_t>(frame) * joints.size() + p;
      };
      out.velocities[at(k)] = per_s * (out.places[at(after)] - out.places[at(before)]);
    }
  }
  return out;
}

PlanarMatch match_windows(const MatchPoints& a,
                          int frame_a,
                          const MatchPoints& b,
                          int frame_b,
                          const MatchOptions& options) {
  MAREY_ASSERT(a.point_count() == b.point_count());
  MAREY_ASSERT(frame_a >= 0 && frame_a < a.frame_count());
  MAREY_ASSERT(frame_b >= 0 && frame_b < b.frame_count());
  const int before = std::min({options.half_window, frame_a, frame_b});
  const int after = std::min({options.half_window,
                              a.frame_count() - 1 - frame_a,
                              b.frame_count() - 1 - frame_b});
  const auto points = static_cast<std::size_t>(a.point_count());
  const std::size_t count = static_cast<std::size_t>(before + after + 1) * points;
  const std::size_t from_a = static_cast<std::size_t>(frame_a - before) * points;
  const std::size_t from_b = static_cast<std::size_t>(frame_b - before) * points;
  std::vector<double> weights(count);
  for (std::size_t k = 0; k < count; ++k) {
    weights[k] = a.weights[k % points] / (before + after + 1);
  }
  PlanarMatch match;
  match.a_from_b = fit_planar(
      {a.places.data() + from_a, count}, {b.places.data() + from_b, count}, weights);
  const double cos_turn = std::cos(match.a_from_b.turn_rad);
  const double sin_turn = std::sin(match.a_from_b.turn_rad);
  const glm::dvec3 shift(match.a_from_b.shift_xz_m.x, 0.0, match.a_from_b.shift_xz_m.y);
  const std::size_t middle = static_cast<std::size_t>(before) * points;
  double places = 0.0;
  double velocities = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const glm::dvec3 off =
        a.places[from_a + k] - turned(cos_turn, sin_turn, b.places[from_b + k]) - shift;
    const glm::dvec3 faster =
        a.velocities[from_a + k] - turned(cos_turn, sin_turn, b.velocities[from_b + k]);
    places += weights[k] * glm::dot(off, off);
    velocities += weights[k] * glm::dot(faster, faster);
    if (k >= middle && k < middle + points) {
      match.worst_m = std::max(match.worst_m, glm::length(off));
    }
  }
  match.rms_m = std::sqrt(places);
  match.rms_velocity_m_per_s = std::sqrt(velocities);
  match.distance_m =
      std::sqrt(places + options.velocity_s * options.velocity_s * velocities);
  return match;
}

}  // namespace marey::edit
