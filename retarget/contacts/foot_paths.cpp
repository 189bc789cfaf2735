// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/foot_paths.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/pose.h"
#include "retarget/body/foot_shape.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::retarget {
namespace {

// The back of the heel, at the ankle's height, and the rear end of the sole: distances
// behind the ankle in lengths from ankle to ball. The former is that of a marker on a
// running shoe, chosen on one run and one drop jump; the latter is the full extent of the
// heel of foot_shape.h.
constexpr double kBackInBall = 0.7;
constexpr double kHeelInBall = kHeelInFoot * (1.0 + kToesInBall);
// The belt's velocity is that of most low frames, within this.
constexpr double kSameBelt_legs_per_s = 0.35;
void fit_velocities(double hz,
                    double smoothing_s,
                    const glm::dvec3& floor_velocity,
                    EdgePath& path) {
  const int count = static_cast<int>(path.p_in_world.size());
  const int half = std::max(1, static_cast<int>(std::lround(0.5 * smoothing_s * hz)));
  for (int t = 0; t < count; ++t) {
    const int first = std::max(0, t - half);
    const int last = std::min(count - 1, t + half);
    const double middle = 0.5 * (first + last);
    glm::dvec3 slope(0.0);
    double weight = 0.0;
    for (int k = first; k <= last; ++k) {
      slope += (k - middle) * path.p_in_world[static_cast<std::size_t>(k)];
      weight += (k - middle) * (k - middle);
    }
    if (weight > 0.0) slope *= hz / weight;
    const glm::dvec3 relative = slope - floor_velocity;
    path.across_m_per_s.push_back(std::hypot(relative.x, relative.z));
    path.up_m_per_s.push_back(slope.y);
  }
}

EdgePaths points_of(const Motion& motion, const BodyMap& map) {
  EdgePaths paths;
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world_from_joint);
    for (std::size_t side = 0; side < 2; ++side) {
      const FootMap& foot = map.feet[side];
      const JointIndex ankle = map.leg(static_cast<int>(side)).end;
      const auto toes =
          map.joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
      const glm::dquat turn = rotation_from_t_pose(map, world_from_joint, ankle);
      const glm::dquat toes_turn =
          toes ? rotation_from_t_pose(map, world_from_joint, *toes) : turn;
      const glm::dvec3 at = world_from_joint[index(ankle)].translation;
      const glm::dvec3 along = foot.ball_from_ankle_in_t_pose;
      const double length_m = std::hypot(along.x, along.z);
      const glm::dvec3 back(0.0, 0.0, -kBackInBall * length_m);
      const glm::dvec3 heel(0.0, -foot.ankle_height_m, -kHeelInBall * length_m);
      const glm::dvec3 ball = at + turn * along;
      paths[side][kBackPoint].p_in_world.push_back(at + turn * back);
      paths[side][kHeelPoint].p_in_world.push_back(at + turn * heel);
      paths[side][kBallPoint].p_in_world.push_back(ball);
      paths[side][kTipPoint].p_in_world.push_back(
          ball + toes_turn * foot.tip_from_ball_in_t_pose);
    }
  }
  return paths;
}

}  // namespace

EdgePaths edge_paths(const Motion& motion,
                     const BodyMap& map,
                     double smoothing_s,
                     const glm::dvec3& floor_velocity) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  EdgePaths paths = points_of(motion, map);
  for (auto& foot : paths) {
    for (EdgePath& path : foot) {
      fit_velocities(motion.rate.hz, smoothing_s, floor_velocity, path);
    }
  }
  return paths;
}

std::optional<glm::dvec3> belt_velocity(const Motion& motion, const BodyMap& map) {
  constexpr double kLow = 0.35;           // Share of the frames that are low.
  constexpr double kMost = 0.5;           // Share of low frames on the belt.
  constexpr std::size_t kMaxTried = 400;  // Bounds the cost.
  const EdgePaths paths = points_of(motion, map);
  std::vector<glm::dvec2> low;
  for (const auto& foot : paths) {
    const auto& p = foot[kBallPoint].p_in_world;
    if (p.size() < 3) return std::nullopt;
    std::vector<double> heights;
    for (const glm::dvec3& at : p) heights.push_back(at.y);
    const double level_m = quantile(heights, kLow);
    for (std::size_t t = 1; t + 1 < p.size(); ++t) {
      if (p[t].y > level_m) continue;
      const glm::dvec3 v = 0.5 * motion.rate.hz * (p[t + 1] - p[t - 1]);
      low.emplace_back(v.x, v.z);
    }
  }
  const double same = kSameBelt_legs_per_s * map.leg_length_m;
  const std::size_t step = std::max<std::size_t>(1, low.size() / kMaxTried);
  std::size_t most = 0;
  glm::dvec2 mean(0.0);
  for (std::size_t i = 0; i < low.size(); i += step) {
    std::size_t near = 0;
    glm::dvec2 sum(0.0);
    for (const glm::dvec2& v : low) {
      if (glm::distance(v, low[i]) > same) continue;
      ++near;
      sum += v;
    }
    if (near <= most) continue;
    most = near;
    mean = sum / static_cast<double>(near);
  }
  if (static_cast<double>(most) < kMost * static_cast<double>(low.size())) {
    return std::nullopt;
  }
  return glm::dvec3(mean.x, 0.0, mean.y);
}

}  // namespace marey::retarget
