// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/loop_cost.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/assert.h"

namespace marey::edit {
namespace {

using B = HumanBone;

/// Parts of the body that the feature joints represent, as shares of the mass: trunk with
/// head, forearm with hand and part of the upper arm, leg below the hip (de Leva 1996).
constexpr double kTrunkShare = 0.50;
constexpr double kWristShare = 0.05;
constexpr double kAnkleShare = 0.20;

struct FeatureJoint {
  JointIndex joint{};
  double weight = 0.0;
};

std::vector<FeatureJoint> feature_joints(const retarget::BodyMap& map) {
  std::vector<FeatureJoint> out{{map.hips(), kTrunkShare},
                                {map.leg(0).end, kAnkleShare},
                                {map.leg(1).end, kAnkleShare}};
  for (const B hand : {B::kLeftHand, B::kRightHand}) {
    if (const auto joint = map.joint_of[index(hand)])
      out.push_back({*joint, kWristShare});
  }
  if (out.size() == 3) {
    if (const auto head = map.joint_of[index(B::kHead)]) {
      out.push_back({*head, 2 * kWristShare});
    }
  }
  double total = 0.0;
  for (const FeatureJoint& feature : out) total += feature.weight;
  for (FeatureJoint& feature : out) feature.weight /= total;
  return out;
}

}  // namespace

LoopCost::LoopCost(const Motion& motion,
                   const retarget::BodyMap& map,
                   const MatchOptions& options,
                   int stride)
    : options_(options) {
  MAREY_ASSERT(stride >= 1);
  const std::vector<FeatureJoint> joints = feature_joints(map);
  for (const FeatureJoint& feature : joints) weights_.push_back(feature.weight);
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  glm::dvec3 mean(0.0);
  for (std::size_t t = 0; t < motion.poses.size();
       t += static_cast<std::size_t>(stride)) {
    world_from_joints(motion.skeleton, motion.poses[t], world);
    for (const FeatureJoint& feature : joints) {
      places_.push_back(world[index(feature.joint)].translation);
      mean += places_.back();
    }
    ++frames_;
  }
  // Sums of squares lose digits far from the origin.
  mean /= std::max(1.0, static_cast<double>(places_.size()));
  for (glm::dvec3& place : places_) place -= mean;
  velocities_.resize(places_.size(), glm::dvec3(0.0));
  const std::size_t points = weights_.size();
  const int reach = velocity_reach(motion.rate.hz / stride);
  for (int k = 0; k < frames_ && frames_ > 1; ++k) {
    const auto before = static_cast<std::size_t>(std::max(k - reach, 0)) * points;
    const auto after =
        static_cast<std::size_t>(std::min(k + reach, frames_ - 1)) * points;
    const double per_s = motion.rate.hz * static_cast<double>(points) /
                         (stride * static_cast<double>(after - before));
    for (std::size_t p = 0; p < points; ++p) {
      velocities_[static_cast<std::size_t>(k) * points + p] =
          per_s * (places_[after + p] - places_[before + p]);
    }
  }
}

// 0 to 3: mean x, z of both; 4: sine, 5: cosine products of places; 6: squared horizontal
// places and squared height differences; 7, 8: sine and cosine products of velocities;
// 9: squared velocities, without the products along X and Z.
LoopCost::Sums LoopCost::pair_sums(std::size_t a, std::size_t b) const {
  Sums sums{};
  const std::size_t points = weights_.size();
  for (std::size_t k = 0; k < points; ++k) {
    const double w = weights_[k];
    const glm::dvec3& p = places_[a * points + k];
    const glm::dvec3& q = places_[b * points + k];
    const glm::dvec3& u = velocities_[a * points + k];
    const glm::dvec3& v = velocities_[b * points + k];
    const double rise = p.y - q.y;
    const double faster = u.y - v.y;
    sums[0] += w * p.x;
    sums[1] += w * p.z;
    sums[2] += w * q.x;
    sums[3] += w * q.z;
    sums[4] += w * (p.x * q.z - q.x * p.z);
    sums[5] += w * (p.x * q.x + p.z * q.z);
    sums[6] += w * (p.x * p.x + p.z * p.z + q.x * q.x + q.z * q.z + rise * rise);
    sums[7] += w * (u.x * v.z - v.x * u.z);
    sums[8] += w * (u.x * v.x + u.z * v.z);
    sums[9] += w * (u.x * u.x + u.z * u.z + v.x * v.x + v.z * v.z + faster * faster);
  }
  return sums;
}

double LoopCost::squared_distance(const Sums& sums, int width) const {
  const double n = 1.0 / width;
  const double ax = n * sums[0];
  const double az = n * sums[1];
  const double bx = n * sums[2];
  const double bz = n * sums[3];
  const double sine = n * sums[4] - (ax * bz - bx * az);
  const double cosine = n * sums[5] - (ax * bx + az * bz);
  const double length = std::sqrt(sine * sine + cosine * cosine);
  const double places =
      n * sums[6] - (ax * ax + az * az + bx * bx + bz * bz) - 2.0 * length;
  const double along =
      length > 0.0 ? (sine * sums[7] + cosine * sums[8]) / length : sums[8];
  const double velocities = n * (sums[9] - 2.0 * along);
  return std::max(0.0, places) +
         options_.velocity_s * options_.velocity_s * std::max(0.0, velocities);
}

void LoopCost::squared_distances(int lag, std::span<double> out) {
  MAREY_ASSERT(lag >= 0 && lag < frames_);
  const int count = frames_ - lag;
  MAREY_ASSERT(static_cast<int>(out.size()) == count);
  running_.resize(static_cast<std::size_t>(count) + 1);
  running_[0] = Sums{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const Sums sums = pair_sums(k, k + static_cast<std::size_t>(lag));
    for (std::size_t s = 0; s < kSums; ++s) running_[k + 1][s] = running_[k][s] + sums[s];
  }
  for (int k = 0; k < count; ++k) {
    // Cut at the ends as match_windows() does.
    const int first = std::max(0, k - options_.half_window);
    const int last = std::min(count - 1, k + options_.half_window);
    Sums sums{};
    for (std::size_t s = 0; s < kSums; ++s) {
      sums[s] = running_[static_cast<std::size_t>(last) + 1][s] -
                running_[static_cast<std::size_t>(first)][s];
    }
    out[static_cast<std::size_t>(k)] = squared_distance(sums, last - first + 1);
  }
}

}  // namespace marey::edit
