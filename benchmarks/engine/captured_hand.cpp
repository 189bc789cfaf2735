// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/captured_hand.h"

#include <algorithm>
#include <cmath>

#include "retarget/body/body_map.h"

namespace marey {

CapturedHand::CapturedHand(const Skeleton& skeleton,
                           const std::vector<Pose>& poses,
                           double rate_hz,
                           HumanBone hand)
    : rate_hz_(rate_hz) {
  const Result<retarget::BodyMap> map = retarget::map_body(skeleton);
  MAREY_ASSERT(map.has_value());
  const JointIndex wrist = *skeleton.find(hand);
  const JointIndex hips = map->hips();
  std::vector<double> times;
  std::vector<std::vector<double>> values(6);
  double heading_rad = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto joints = world_from_joints(skeleton, poses[i]);
    const RigidTransform& at = joints[index(wrist)];
    rotations_.push_back(at.rotation *
                         glm::conjugate(map->joints[index(wrist)].t_pose_from_joint));
    const glm::dvec3 ahead = joints[index(hips)].rotation *
                             glm::conjugate(map->joints[index(hips)].t_pose_from_joint) *
                             glm::dvec3(0.0, 0.0, 1.0);
    heading_rad += std::remainder(std::atan2(ahead.x, ahead.z) - heading_rad,
                                  2.0 * 3.14159265358979323846);
    times.push_back(static_cast<double>(i) / rate_hz);
    for (int c = 0; c < 3; ++c) {
      values[static_cast<std::size_t>(c)].push_back(at.translation[c]);
    }
    values[3].push_back(joints[index(hips)].translation.x);
    values[4].push_back(joints[index(hips)].translation.z);
    values[5].push_back(heading_rad);
  }
  for (std::size_t c = 0; c < 3; ++c) place_.emplace_back(times, values[c]);
  for (std::size_t c = 3; c < 6; ++c) root_.emplace_back(times, values[c]);
}

double CapturedHand::duration_s() const {
  return static_cast<double>(rotations_.size() - 1) / rate_hz_;
}

glm::dquat CapturedHand::rotation(double time_s) const {
  const double frame =
      std::clamp(time_s * rate_hz_, 0.0, static_cast<double>(rotations_.size()) - 1.001);
  const auto i = static_cast<std::size_t>(frame);
  return glm::slerp(rotations_[i], rotations_[i + 1], frame - static_cast<double>(i));
}

engine::HandMotion CapturedHand::at(double time_s) const {
  const double step_s = 1.0 / rate_hz_;
  const auto frame = [&](double t) {
    return RigidTransform{rotation(t),
                          {place_[0].at(t), place_[1].at(t), place_[2].at(t)}};
  };
  engine::HandMotion hand = engine::hand_motion(
      frame(time_s - step_s), frame(time_s), frame(time_s + step_s), step_s);
  constexpr double kStep_s = 1e-5;
  for (int c = 0; c < 3; ++c) {
    const CubicSpline& spline = place_[static_cast<std::size_t>(c)];
    hand.velocity_m_s[c] = spline.slope_at(time_s);
    hand.acceleration_m_s2[c] =
        (spline.slope_at(time_s + kStep_s) - spline.slope_at(time_s - kStep_s)) /
        (2.0 * kStep_s);
  }
  return hand;
}

engine::RootPlace CapturedHand::root(double time_s) const {
  return {root_[0].at(time_s), root_[1].at(time_s), root_[2].at(time_s)};
}

}  // namespace marey
