// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/preview_body.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/balance/local_cubic.h"
#include "dynamics/balance/support_polygon.h"
#include "dynamics/balance/zero_moment_point.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/live_chain/live_zmp.h"
#include "core/base/assert.h"
#include "core/human/centre_of_mass.h"
#include "retarget/body/place_masses.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/feet/leg_placement.h"

namespace marey::app {
namespace {

// Covers a part of the angular momentum, which the model leaves out.
constexpr double kPreviewMargin_m = 0.020;
constexpr double kMaxWantedShift_m = 0.15;
// Time constant with which the wanted displacement ends without a zero moment point.
constexpr double kPreviewEnd_s = 0.2;
constexpr double kMinPreviewHeight_m = 0.1;

/// Height of the centre of mass above the lower sole at rest.
double com_height_m(const Skeleton& skeleton,
                    const retarget::BodyMap& map,
                    std::span<const PointMass> masses) {
  const auto joints = world_from_joints(skeleton, rest_pose(skeleton));
  const auto sole_m = [&](int side) {
    return joints[index(map.leg(side).end)].translation.y -
           map.feet[static_cast<std::size_t>(side)].ankle_height_m;
  };
  const double height_m =
      centre_of_mass(masses, joints).y - std::min(sole_m(0), sole_m(1));
  return std::max(height_m, kMinPreviewHeight_m);
}

dynamics::PreviewOptions preview_options(const PreviewTimes& times) {
  dynamics::PreviewOptions options;
  options.preview_s =
      static_cast<double>(times.delay - times.half_window) / times.rate.hz;
  return options;
}

/// Weights of the second derivative in the middle of a window.
std::vector<double> curvature_weights(const PreviewTimes& times) {
  const auto count = static_cast<std::size_t>(2 * times.half_window + 1);
  const double window_s = static_cast<double>(count - 1) / times.rate.hz;
  const dynamics::LocalCubic cubic(count, times.rate, window_s);
  const auto weights = cubic.curvature(count / 2);
  MAREY_ASSERT(weights.size() == count);
  return {weights.begin(), weights.end()};
}

retarget::FootPlace place_of_foot(const retarget::BodyMap& map,
                                  std::span<const RigidTransform> joints,
                                  int side) {
  const auto turn = [&](HumanBone bone) {
    const auto joint = map.joint_of[index(bone)];
    return joint ? retarget::rotation_from_t_pose(map, joints, *joint)
                 : glm::dquat(1.0, 0.0, 0.0, 0.0);
  };
  return {joints[index(map.leg(side).end)].translation,
          turn(retarget::foot_bone(side)),
          turn(retarget::toes_bone(side))};
}

}  // namespace

glm::dvec2 wanted_zmp_shift_m(std::span<const glm::dvec2> corners,
                              const glm::dvec2& zmp_xz_m) {
  if (corners.size() < 3) return glm::dvec2(0.0);
  const auto outside_m = dynamics::distance_outside(corners, zmp_xz_m);
  if (!outside_m || *outside_m <= -kPreviewMargin_m) return glm::dvec2(0.0);
  const double share = std::min(1.0, 1.0 + *outside_m / kPreviewMargin_m);
  glm::dvec2 out =
      share * (dynamics::moved_inside(corners, zmp_xz_m, kPreviewMargin_m) - zmp_xz_m);
  const double length_m = glm::length(out);
  if (length_m > kMaxWantedShift_m) out *= kMaxWantedShift_m / length_m;
  return out;
}

PreviewBody::Weight::Weight(const Skeleton& skeleton,
                            retarget::BodyMap body_map,
                            std::vector<PointMass> point_masses,
                            const PreviewTimes& times)
    : map(std::move(body_map)),
      masses(std::move(point_masses)),
      follower{skeleton, map, masses, times.rate},
      closer(follower),
      balance(times.rate, com_height_m(skeleton, map, masses), preview_options(times)),
      com_in_world(static_cast<std::size_t>(times.kept()), glm::dvec3(0.0)),
      curvature(curvature_weights(times)) {}

PreviewBody::PreviewBody(const Skeleton& skeleton, const PreviewTimes& times)
    : skeleton_(skeleton),
      times_(times),
      poses_(static_cast<std::size_t>(times.kept()), rest_pose(skeleton)),
      world_from_joint_(skeleton.joints.size()),
      kept_share_(std::exp(-1.0 / (times.rate.hz * kPreviewEnd_s))) {
  MAREY_ASSERT(times.delay > times.half_window && times.half_window > 0);
  auto map = retarget::map_body(skeleton);
  if (!map) return;
  auto masses = retarget::place_masses(skeleton, *map, {});
  if (!masses) return;
  weight_.emplace(skeleton_, *std::move(map), *std::move(masses), times);
}

void PreviewBody::push(const Pose& pose, double share) {
  MAREY_ASSERT(pose.parent_from_joint.size() == skeleton_.joints.size());
  const Pose& before = poses_[times_.slot(std::max<std::int64_t>(newest_, 0))];
  ++newest_;
  Pose& now = poses_[times_.slot(newest_)];
  if (share >= 1.0) {
    now = pose;
  } else if (share <= 0.0) {
    if (&now != &before) now = before;
  } else {
    now.root_in_world = glm::mix(before.root_in_world, pose.root_in_world, share);
    for (std::size_t j = 0; j < pose.parent_from_joint.size(); ++j) {
      now.parent_from_joint[j] =
          glm::slerp(before.parent_from_joint[j], pose.parent_from_joint[j], share);
    }
  }
  if (!weight_) return;
  world_from_joints(skeleton_, now, world_from_joint_);
  weight_->com_in_world[times_.slot(newest_)] =
      centre_of_mass(weight_->masses, world_from_joint_);
}

void PreviewBody::plan(bool is_known,
                       const std::array<retarget::StandingFoot, 2>& standing) {
  if (!weight_) return;
  const auto wanted = is_known ? wanted_xz_m(standing) : std::nullopt;
  wanted_xz_m_ = wanted ? *wanted : kept_share_ * wanted_xz_m_;
  shift_xz_m_ = weight_->balance.step(wanted_xz_m_);
}

/// Wanted displacement of the zero moment point in the middle of the newest window.
/// nullopt: there is no such point, or no support area.
std::optional<glm::dvec2> PreviewBody::wanted_xz_m(
    const std::array<retarget::StandingFoot, 2>& standing) {
  const std::int64_t middle = newest_ - times_.half_window;
  glm::dvec3 acceleration_m_s2(0.0);
  for (std::size_t i = 0; i < weight_->curvature.size(); ++i) {
    const std::int64_t frame = middle - times_.half_window + static_cast<int>(i);
    acceleration_m_s2 +=
        weight_->curvature[i] * weight_->com_in_world[times_.slot(frame)];
  }
  constexpr double kGravity_m_s2 = dynamics::kStandardGravity_m_s2;
  const double push_m_s2 = acceleration_m_s2.y + kGravity_m_s2;
  // Also false if a position is not finite.
  if (!(push_m_s2 >= dynamics::kLoadedShare * kGravity_m_s2)) return std::nullopt;
  world_from_joints(skeleton_, poses_[times_.slot(middle)], world_from_joint_);
  retarget::BalanceFrame& frame = weight_->frame;
  balance_of_posture(weight_->map, weight_->masses, world_from_joint_, standing, frame);
  if (frame.support_xz_m.size() < 3) return std::nullopt;
  const glm::dvec3& com_in_world = frame.centre_of_mass_in_world;
  const double lever_s2 = com_in_world.y / push_m_s2;
  return wanted_zmp_shift_m(frame.support_xz_m,
                            {com_in_world.x - lever_s2 * acceleration_m_s2.x,
                             com_in_world.z - lever_s2 * acceleration_m_s2.z});
}

void PreviewBody::show(const std::array<double, 2>& holds, Pose& out) {
  const std::int64_t frame = newest_ - times_.delay;
  MAREY_ASSERT(frame >= 0);
  copy(frame, out);
  if (!weight_) return;
  world_from_joints(skeleton_, out, world_from_joint_);
  std::array<retarget::FootGoal, 2> goals;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    goals[s].place = place_of_foot(weight_->map, world_from_joint_, side);
    goals[s].hold = holds[s];
  }
  const glm::dvec3 com_in_world = weight_->com_in_world[times_.slot(frame)] +
                                  glm::dvec3(shift_xz_m_.x, 0.0, shift_xz_m_.y);
  (void)weight_->closer.close(out, com_in_world, goals, out);
}

}  // namespace marey::app
