// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/quality_frames.h"

#include <algorithm>
#include <cmath>

#include "core/human/centre_of_mass.h"
#include "core/pose.h"
#include "retarget/body/body_volume.h"
#include "retarget/body/place_masses.h"

namespace marey::library {
namespace {

using retarget::VolumePart;

constexpr std::array kTrunkParts{
    VolumePart::kHead, VolumePart::kChest, VolumePart::kAbdomen, VolumePart::kPelvis};

// Angle between two rotations, exact also for small angles.
double angle_between_rad(const glm::dquat& a, const glm::dquat& b) {
  const double s = glm::dot(a, b) < 0.0 ? -1.0 : 1.0;
  const glm::dquat d = a - b * s;
  return 4.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(glm::dot(d, d))));
}

/// Fills one frame after the other; allocates only when it is made.
class FrameFiller {
 public:
  FrameFiller(const Motion& motion, const retarget::BodyMap& map)
      : motion_(motion),
        map_(map),
        volume_(retarget::average_volume(motion.skeleton, map)),
        world_(motion.skeleton.joints.size()) {
    if (auto masses = retarget::place_masses(motion.skeleton, map, {})) {
      masses_ = std::move(*masses);
    }
    out_.count = static_cast<int>(motion.poses.size());
    out_.hz = motion.rate.hz;
    out_.leg_m = map.leg_length_m;
    const std::size_t count = motion.poses.size();
    for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
      if (!map.joint_of[b]) continue;
      out_.bones[b].joint = *map.joint_of[b];
      out_.bones[b].p_in_world.resize(count);
      out_.bones[b].world_from_t_pose.resize(count);
      out_.bones[b].step_rad.resize(count);
    }
    out_.com_in_world.resize(count);
    for (std::size_t side = 0; side < 2; ++side) {
      out_.sole_m[side].resize(count);
      out_.ball_in_world[side].resize(count);
      if (map.limbs[side]) out_.hand_depth_m[side].resize(count);
    }
  }

  void fill(std::size_t t) {
    world_from_joints(motion_.skeleton, motion_.poses[t], world_);
    for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
      BonePath& bone = out_.bones[b];
      if (bone.empty()) continue;
      const std::size_t j = index(bone.joint);
      bone.p_in_world[t] = world_[j].translation;
      bone.world_from_t_pose[t] =
          world_[j].rotation * glm::conjugate(map_.joints[j].t_pose_from_joint);
      bone.step_rad[t] =
          t == 0 ? 0.0
                 : angle_between_rad(motion_.poses[t - 1].parent_from_joint[j],
                                     motion_.poses[t].parent_from_joint[j]);
    }
    out_.com_in_world[t] =
        masses_.empty() ? world_[0].translation : centre_of_mass(masses_, world_);
    for (int side = 0; side < 2; ++side) {
      fill_foot(t, side);
      fill_hand(t, side);
    }
  }

  [[nodiscard]] QualityFrames&& take() { return std::move(out_); }

 private:
  void fill_foot(std::size_t t, int side) {
    const auto s = static_cast<std::size_t>(side);
    const retarget::FootMap& foot = map_.feet[s];
    const BonePath& ankle = out_[foot_of(side)];
    const BonePath& toes = out_[toes_of(side)];
    const glm::dvec3 ball = toes.empty()
                                ? ankle.p_in_world[t] + ankle.world_from_t_pose[t] *
                                                            foot.ball_from_ankle_in_t_pose
                                : toes.p_in_world[t];
    out_.ball_in_world[s][t] = ball;
    out_.sole_m[s][t] = std::min(ball.y - foot.ball_height_m,
                                 ankle.p_in_world[t].y - foot.ankle_height_m);
  }

  void fill_hand(std::size_t t, int side) {
    const auto s = static_cast<std::size_t>(side);
    if (out_.hand_depth_m[s].empty()) return;
    const glm::dvec3 hand = world_[index(map_.limbs[s]->end)].translation;
    double depth_m = 0.0;
    for (const VolumePart part : kTrunkParts) {
      const auto& capsule = volume_[part];
      if (!capsule) continue;
      depth_m = std::max(depth_m, -retarget::side_of(*capsule, world_, hand).distance_m);
    }
    out_.hand_depth_m[s][t] = depth_m;
  }

  const Motion& motion_;
  const retarget::BodyMap& map_;
  retarget::BodyVolume volume_;
  std::vector<PointMass> masses_;
  std::vector<RigidTransform> world_;
  QualityFrames out_;
};

}  // namespace

QualityFrames quality_frames(const Motion& motion, const retarget::BodyMap& map) {
  FrameFiller filler(motion, map);
  for (std::size_t t = 0; t < motion.poses.size(); ++t) filler.fill(t);
  return filler.take();
}

double quantile_in_place(std::span<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto place = static_cast<std::ptrdiff_t>(
      std::floor(share * static_cast<double>(values.size() - 1) + 0.5));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

}  // namespace marey::library
