// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/keeper_response.h"

#include <algorithm>
#include <cstddef>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/pose.h"

namespace marey::app {
namespace {

/// Speed between frame i and the next one, at the middle of both.
struct SpeedSample {
  double time_s = 0.0;
  double speed_m_s = 0.0;
};

std::vector<SpeedSample> speeds_between(std::span<const double> times_s,
                                        std::span<const glm::dvec3> path,
                                        double from_s,
                                        double to_s) {
  std::vector<SpeedSample> speeds;
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    const double time_s = 0.5 * (times_s[i - 1] + times_s[i]);
    if (time_s < from_s || time_s > to_s) continue;
    const double speed_m_s =
        glm::distance(path[i - 1], path[i]) / (times_s[i] - times_s[i - 1]);
    speeds.push_back({time_s, speed_m_s});
  }
  return speeds;
}

double largest_speed_m_s(std::span<const SpeedSample> speeds) {
  double largest = 0.0;
  for (const SpeedSample& sample : speeds) largest = std::max(largest, sample.speed_m_s);
  return largest;
}

glm::dvec3 place_at(std::span<const double> times_s,
                    std::span<const glm::dvec3> path,
                    double time_s) {
  const auto after = std::lower_bound(times_s.begin(), times_s.end(), time_s);
  const auto i = static_cast<std::size_t>(after - times_s.begin());
  if (i == 0) return path.front();
  const double share = (time_s - times_s[i - 1]) / (times_s[i] - times_s[i - 1]);
  return glm::mix(path[i - 1], path[i], share);
}

}  // namespace

std::optional<KeeperTrack> keeper_track(const Motion& motion,
                                        double scene_from_motion_s) {
  const auto hips = motion.skeleton.find(HumanBone::kHips);
  const auto left = motion.skeleton.find(HumanBone::kLeftHand);
  const auto right = motion.skeleton.find(HumanBone::kRightHand);
  if (!hips || !left || !right) return std::nullopt;
  KeeperTrack track;
  std::vector<RigidTransform> joints(motion.skeleton.joints.size());
  for (std::size_t i = 0; i < motion.poses.size(); ++i) {
    world_from_joints(motion.skeleton, motion.poses[i], joints);
    const double frame = static_cast<double>(i) + motion.first_frame;
    track.times_s.push_back(scene_from_motion_s + frame / motion.rate.hz);
    track.hips_in_world.push_back(joints[index(*hips)].translation);
    track.wrists_in_world[0].push_back(joints[index(*left)].translation);
    track.wrists_in_world[1].push_back(joints[index(*right)].translation);
  }
  return track;
}

std::optional<double> movement_start(std::span<const double> times_s,
                                     std::span<const glm::dvec3> path,
                                     double from_s,
                                     double to_s,
                                     double share) {
  MAREY_ASSERT(times_s.size() == path.size());
  const std::vector<SpeedSample> speeds = speeds_between(times_s, path, from_s, to_s);
  const auto peak = std::max_element(
      speeds.begin(), speeds.end(), [](const SpeedSample& a, const SpeedSample& b) {
        return a.speed_m_s < b.speed_m_s;
      });
  if (speeds.size() < 3 || peak->speed_m_s <= 0.0) return std::nullopt;
  const double limit_m_s = share * peak->speed_m_s;
  for (auto at = peak; at != speeds.begin(); --at) {
    const SpeedSample& before = *(at - 1);
    if (before.speed_m_s > limit_m_s) continue;
    const double rise_m_s = at->speed_m_s - before.speed_m_s;
    const double part = (limit_m_s - before.speed_m_s) / rise_m_s;
    return before.time_s + part * (at->time_s - before.time_s);
  }
  return std::nullopt;
}

std::optional<KeeperResponse> keeper_response(const KeeperTrack& track,
                                              double start_s,
                                              double arrival_s) {
  constexpr double kAfterArrival_s = 0.3;
  const std::span<const double> times_s = track.times_s;
  if (times_s.empty() || arrival_s < times_s.front() || arrival_s > times_s.back()) {
    return std::nullopt;
  }
  const double end_s = arrival_s + kAfterArrival_s;
  KeeperResponse response;
  std::array<double, 2> fastest_m_s{};
  for (std::size_t side = 0; side < 2; ++side) {
    fastest_m_s[side] = largest_speed_m_s(
        speeds_between(times_s, track.wrists_in_world[side], start_s, end_s));
  }
  response.hand = fastest_m_s[1] >= fastest_m_s[0] ? 1 : 0;
  const auto& wrist = track.wrists_in_world[static_cast<std::size_t>(response.hand)];
  response.hand_moves_s = movement_start(times_s, wrist, start_s, end_s);
  response.hips_move_s = movement_start(times_s, track.hips_in_world, start_s, end_s);
  response.hand_at_arrival_in_world = place_at(times_s, wrist, arrival_s);
  return response;
}

}  // namespace marey::app
