// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/jump_judge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "tests/support/truth/momentum_judge.h"

namespace marey::testing {
namespace {

constexpr double kJudgeGravity_m_s2 = 9.81;

}  // namespace

double JudgedFlight::airtime_s(double takeoff_m, double touchdown_m) const {
  const double up = 2.0 * kJudgeGravity_m_s2 * (apex_m - takeoff_m);
  const double down = 2.0 * kJudgeGravity_m_s2 * (apex_m - touchdown_m);
  if (up < 0.0 || down < 0.0) return 0.0;
  return (std::sqrt(up) + std::sqrt(down)) / kJudgeGravity_m_s2;
}

glm::dvec3 JudgedFlight::at(double time_s) const {
  return p0_in_world + time_s * v0_m_s -
         glm::dvec3(0.0, 0.5 * kJudgeGravity_m_s2 * time_s * time_s, 0.0);
}

JudgedFlight judge_flight(const Motion& motion,
                          std::span<const PointMass> masses,
                          const FrameRange& frames) {
  // Normal equations of p = p0 + v0 t after the fall is added; times about their mean.
  std::vector<glm::dvec3> places;
  std::vector<double> times;
  double mean_s = 0.0;
  glm::dvec3 mean(0.0);
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const double time_s = frame / motion.rate.hz;
    glm::dvec3 p = judged_com(
        motion.skeleton, masses, motion.poses[static_cast<std::size_t>(frame)]);
    p.y += 0.5 * kJudgeGravity_m_s2 * time_s * time_s;
    places.push_back(p);
    times.push_back(time_s);
    mean_s += time_s;
    mean += p;
  }
  const auto count = static_cast<double>(places.size());
  mean_s /= count;
  mean /= count;
  glm::dvec3 moment(0.0);
  double square = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    moment += (times[i] - mean_s) * (places[i] - mean);
    square += (times[i] - mean_s) * (times[i] - mean_s);
  }
  JudgedFlight out;
  out.v0_m_s = square > 0.0 ? moment / square : glm::dvec3(0.0);
  out.p0_in_world = mean - mean_s * out.v0_m_s;
  out.apex_m = out.p0_in_world.y + 0.5 * out.v0_m_s.y * out.v0_m_s.y / kJudgeGravity_m_s2;
  for (std::size_t i = 0; i < places.size(); ++i) {
    glm::dvec3 model = out.p0_in_world + times[i] * out.v0_m_s;
    out.off_parabola_m = std::max(out.off_parabola_m, glm::distance(model, places[i]));
  }
  return out;
}

double largest_jerk_m_s3(const Motion& motion, const FrameRange& frames) {
  const std::size_t joints = motion.skeleton.joints.size();
  std::vector<std::vector<RigidTransform>> world;
  const int first = std::max(0, frames.first - 1);
  const int last = std::min(static_cast<int>(motion.poses.size()) - 1, frames.last + 2);
  for (int frame = first; frame <= last; ++frame) {
    world.emplace_back(joints);
    world_from_joints(
        motion.skeleton, motion.poses[static_cast<std::size_t>(frame)], world.back());
  }
  const double cube = std::pow(motion.rate.hz, 3.0);
  double largest = 0.0;
  for (std::size_t t = 0; t + 3 < world.size(); ++t) {
    for (std::size_t j = 0; j < joints; ++j) {
      const glm::dvec3 third =
          world[t + 3][j].translation - 3.0 * world[t + 2][j].translation +
          3.0 * world[t + 1][j].translation - world[t][j].translation;
      largest = std::max(largest, cube * glm::length(third));
    }
  }
  return largest;
}

}  // namespace marey::testing
