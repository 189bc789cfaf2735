// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/zmp_judge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "core/pose.h"

namespace marey::testing {
namespace {

constexpr double kJudgeGravity_m_s2 = 9.81;

// First and second derivative.
struct Slopes {
  glm::dvec3 first{0.0};
  glm::dvec3 second{0.0};
};

// Fits a polynomial to samples around a frame by Gaussian elimination.
Slopes fitted(const std::vector<glm::dvec3>& samples,
              std::size_t frame,
              double hz,
              double window_s) {
  const int count = static_cast<int>(samples.size());
  const int half = std::min(
      std::max(2, static_cast<int>(std::lround(0.5 * window_s * hz))), (count - 1) / 2);
  const int at = static_cast<int>(frame);
  const int middle = std::clamp(at, half, count - 1 - half);
  const std::size_t terms = middle == at && half > 1 ? 4 : 3;
  std::array<std::array<double, 4>, 4> matrix{};
  std::array<glm::dvec3, 4> right{};
  for (int k = middle - half; k <= middle + half; ++k) {
    std::array<double, 4> power{1.0};
    for (std::size_t i = 1; i < 4; ++i) power[i] = power[i - 1] * (k - at) / half;
    for (std::size_t i = 0; i < terms; ++i) {
      for (std::size_t j = 0; j < terms; ++j) matrix[i][j] += power[i] * power[j];
      right[i] += power[i] * samples[static_cast<std::size_t>(k)];
    }
  }
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t row = 0; row < terms; ++row) {
      if (row == i) continue;
      const double share = matrix[row][i] / matrix[i][i];
      for (std::size_t j = 0; j < terms; ++j) matrix[row][j] -= share * matrix[i][j];
      right[row] -= share * right[i];
    }
  }
  const double per_s = hz / half;
  return {per_s * right[1] / matrix[1][1], 2.0 * per_s * per_s * right[2] / matrix[2][2]};
}

// Returns the corners of the bearing parts of both soles.
std::vector<glm::dvec2> sole_corners(const JudgedFeet& feet,
                                     const std::vector<RigidTransform>& joints,
                                     const Contacts& contacts,
                                     int frame) {
  const auto holds = [&](const std::vector<FrameRange>& runs) {
    return std::any_of(runs.begin(), runs.end(), [&](const FrameRange& run) {
      return run.first <= frame && frame <= run.last;
    });
  };
  std::vector<glm::dvec2> out;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    const bool heel = holds(contacts.feet[s].heel);
    const bool ball = holds(contacts.feet[s].ball);
    if (!heel && !ball) continue;
    const JudgedFoot& foot = feet[s];
    const auto turned = [&](JointIndex joint, const glm::dquat& t_pose) {
      return joints[index(joint)].rotation * glm::inverse(t_pose);
    };
    const glm::dquat turn = turned(foot.ankle, foot.t_pose_from_ankle);
    const glm::dquat toes_turn =
        foot.toes ? turned(*foot.toes, foot.t_pose_from_toes) : turn;
    const glm::dvec3 p = joints[index(foot.ankle)].translation;
    const glm::dvec3 rear = p + turn * foot.heel_m;
    const glm::dvec3 middle = p + turn * foot.ball_m;
    const glm::dvec3 front = middle + toes_turn * foot.tip_from_ball_m;
    const glm::dvec2 whole(front.x - rear.x, front.z - rear.z);
    const glm::dvec2 half_width = 0.19 * glm::dvec2(-whole.y, whole.x);
    const glm::dvec2 from =
        heel ? glm::dvec2(rear.x, rear.z) : glm::dvec2(middle.x, middle.z);
    const glm::dvec2 to =
        ball ? glm::dvec2(front.x, front.z) : glm::dvec2(rear.x, rear.z) + 0.25 * whole;
    for (const double sign : {-1.0, 1.0}) {
      out.push_back(from + sign * half_width);
      out.push_back(to + sign * half_width);
    }
  }
  return out;
}

// Returns the distance of a point outside of the hull of corners.
double outside_of(const std::vector<glm::dvec2>& corners, const glm::dvec2& p) {
  std::vector<double> angles;
  for (const glm::dvec2& c : corners) angles.push_back(std::atan2(c.y - p.y, c.x - p.x));
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + 2.0 * std::numbers::pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) {
    gap = std::max(gap, angles[i] - angles[i - 1]);
  }
  if (gap <= std::numbers::pi) return 0.0;
  double nearest_m = glm::distance(p, corners.front());
  for (const glm::dvec2& a : corners) {
    for (const glm::dvec2& b : corners) {
      const glm::dvec2 way = b - a;
      const double square = glm::dot(way, way);
      const double share =
          square > 0.0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0.0;
      nearest_m = std::min(nearest_m, glm::distance(p, a + share * way));
    }
  }
  return nearest_m;
}

// Sums over all masses, in the world.
struct Sums {
  double mass_kg = 0.0;
  std::vector<glm::dvec3> com_in_world;
  std::vector<glm::dvec3> moment_kg_m2_s;  ///< Angular momentum about the centre.
};

Sums sums_of(const std::vector<std::vector<RigidTransform>>& joints,
             std::span<const PointMass> masses,
             double hz) {
  Sums out;
  for (const PointMass& mass : masses) out.mass_kg += mass.mass_kg;
  const std::size_t last = joints.size() - 1;
  for (std::size_t t = 0; t <= last; ++t) {
    const std::size_t a = t == 0 ? 0 : t - 1;
    const std::size_t b = std::min(t + 1, last);
    const double span_s = static_cast<double>(b - a) / hz;
    const auto centre = [&](std::size_t frame) {
      glm::dvec3 sum(0.0);
      for (const PointMass& mass : masses) {
        sum += mass.mass_kg / out.mass_kg *
               (joints[frame][index(mass.joint)] * mass.p_in_joint);
      }
      return sum;
    };
    const glm::dvec3 com = centre(t);
    const glm::dvec3 com_moved = centre(b) - centre(a);
    glm::dvec3 moment(0.0);
    for (const PointMass& mass : masses) {
      const auto j = index(mass.joint);
      const auto place = [&](std::size_t frame) {
        return joints[frame][j] * mass.p_in_joint;
      };
      moment += mass.mass_kg / span_s *
                glm::cross(place(t) - com, place(b) - place(a) - com_moved);
      glm::dquat way = joints[b][j].rotation * glm::inverse(joints[a][j].rotation);
      if (way.w < 0.0) way = -way;
      const glm::dvec3 axis(way.x, way.y, way.z);
      const double sine = glm::length(axis);
      if (sine == 0.0) continue;
      const glm::dvec3 turning = 2.0 * std::atan2(sine, way.w) / (span_s * sine) * axis;
      const glm::dmat3 turn = glm::mat3_cast(joints[t][j].rotation);
      moment +=
          mass.mass_kg * (turn * mass.inertia_per_kg_m2 * glm::transpose(turn) * turning);
    }
    out.com_in_world.push_back(com);
    out.moment_kg_m2_s.push_back(moment);
  }
  return out;
}

}  // namespace

std::vector<JudgedZmp> judge_zmp(const Motion& motion,
                                 const JudgedFeet& feet,
                                 std::span<const PointMass> masses,
                                 const Contacts& contacts,
                                 double floor_height_m,
                                 double window_s) {
  std::vector<std::vector<RigidTransform>> joints;
  for (const Pose& pose : motion.poses) {
    joints.push_back(world_from_joints(motion.skeleton, pose));
  }
  const Sums sums = sums_of(joints, masses, motion.rate.hz);
  std::vector<JudgedZmp> out;
  for (std::size_t t = 0; t < joints.size(); ++t) {
    const glm::dvec3 weight(0.0, sums.mass_kg * kJudgeGravity_m_s2, 0.0);
    const glm::dvec3 force =
        sums.mass_kg * fitted(sums.com_in_world, t, motion.rate.hz, window_s).second +
        weight;
    const glm::dvec3 moment =
        fitted(sums.moment_kg_m2_s, t, motion.rate.hz, window_s).first;
    const glm::dvec3& com = sums.com_in_world[t];
    const double height_m = com.y - floor_height_m;
    JudgedZmp one;
    one.vertical_force_g = force.y / weight.y;
    one.p_xz_m = {com.x + (moment.z - height_m * force.x) / force.y,
                  com.z - (moment.x + height_m * force.z) / force.y};
    const auto corners = sole_corners(feet, joints[t], contacts, static_cast<int>(t));
    if (!corners.empty()) one.outside_m = outside_of(corners, one.p_xz_m);
    out.push_back(one);
  }
  return out;
}

}  // namespace marey::testing
