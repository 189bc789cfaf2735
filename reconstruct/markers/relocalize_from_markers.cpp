// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/relocalize_from_markers.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "reconstruct/clusters/cluster_frame.h"

namespace marey::reconstruct {
namespace {

// A limb is tried again if one of its markers is off by this many sigmas.
constexpr double kMisfitSigmas = 4.0;

struct Attitude {
  double arm_down;     ///< From the T-pose. [rad]
  double arm_forward;  ///< [rad]
  double elbow;        ///< [rad]
  double leg_forward;  ///< [rad]
  double knee;         ///< [rad]
};
constexpr std::array<Attitude, 4> kAttitudes{{
    {1.2, 0.0, 0.3, 0.0, 0.1},
    {0.1, 0.0, 0.1, 0.0, 0.1},
    {1.0, 0.6, 1.0, 1.4, 1.4},
    {1.0, 0.5, 1.5, 0.4, 0.8},
}};

/// Attitude of one limb: its frame in the trunk as a rotation vector on the left side,
/// and flexion.
struct LimbAttitude {
  glm::dvec3 rad;
  double flexion;
};
constexpr std::array<LimbAttitude, 6> kArmAttitudes{{
    {{0.0, 0.0, -1.2}, 0.3},
    {{0.0, -1.3, 0.0}, 0.4},
    {{0.0, 0.0, 1.2}, 0.4},
    {{0.0, 0.0, 0.0}, 1.2},
    {{0.0, -1.0, -0.7}, 1.8},
    {{0.0, 0.8, -0.8}, 0.5},
}};
constexpr std::array<LimbAttitude, 5> kLegAttitudes{{
    {{0.0, 0.0, 0.0}, 0.2},
    {{-1.3, 0.0, 0.0}, 1.4},
    {{-0.7, 0.0, 0.0}, 0.2},
    {{0.5, 0.0, 0.0}, 1.2},
    {{-0.6, 0.0, 0.7}, 0.8},
}};

glm::dquat mirrored_turn(const glm::dvec3& rad, bool left) {
  // The mirror image through the plane between left and right.
  return rotation_from_vector(left ? rad : glm::dvec3(rad.x, -rad.y, -rad.z));
}

Posture posture_in(const Attitude& attitude) {
  Posture posture;
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    const LimbParameters& s = kLimbParameters[limb];
    const bool left = limb % 2 == 0;
    const bool arm = limb < 2;
    const glm::dquat frame =
        arm ? mirrored_turn({-attitude.arm_forward, 0.0, 0.0}, left) *
                  mirrored_turn({0.0, 0.0, -attitude.arm_down}, left)
            : mirrored_turn({-attitude.leg_forward, 0.0, 0.0}, left);
    posture.set_rotation(s.frame, frame);
    posture.set_rotation(s.extremity, frame);
    *posture.block(s.flexion) = arm ? attitude.elbow : attitude.knee;
  }
  return posture;
}

}  // namespace

MarkerPoseRelocalizer::MarkerPoseRelocalizer(const MarkerModel& model)
    : model_(&model), solver_(model) {
  p_in_body_.reserve(model.markers.size());
  p_in_world_.reserve(model.markers.size());
  weights_.reserve(model.markers.size());
}

FoundPosture MarkerPoseRelocalizer::find(std::span<const SeenMarker> seen) {
  MAREY_ASSERT(seen.size() >= 3);
  FoundPosture best;
  bool first = true;
  for (const Attitude& attitude : kAttitudes) {
    Posture posture = laid_on(posture_in(attitude), seen);
    const double cost = anneal(seen, 30.0, posture);
    if (first || cost < best.cost) best = {posture, cost};
    first = false;
  }
  retry_limbs(seen, best);
  return best;
}

FoundPosture MarkerPoseRelocalizer::find_near(const Posture& near,
                                              std::span<const SeenMarker> seen) {
  FoundPosture found;
  found.posture = near;
  found.cost = anneal(seen, 10.0, found.posture);
  if (!misfits(seen, found.posture)) return found;
  const FoundPosture searched = find(seen);
  return searched.cost < found.cost ? searched : found;
}

bool MarkerPoseRelocalizer::misfits(std::span<const SeenMarker> seen,
                                    const Posture& posture) {
  const UnfoldedPosture& unfolded = solver_.unfold(posture);
  std::size_t off = 0;
  for (const SeenMarker& sample : seen) {
    const ModelMarker& marker = model_->markers[sample.marker];
    const double distance =
        (unfolded.point(marker.bone, marker.p_in_bone) - sample.p_in_world).norm();
    off += distance > kMisfitSigmas * std::hypot(marker.sigma_m, sample.sigma_m);
  }
  return 4 * off > seen.size();
}

Posture MarkerPoseRelocalizer::laid_on(const Posture& attitude,
                                       std::span<const SeenMarker> seen) {
  const UnfoldedPosture& unfolded = solver_.unfold(attitude);
  p_in_body_.clear();
  p_in_world_.clear();
  weights_.clear();
  for (const SeenMarker& sample : seen) {
    const ModelMarker& marker = model_->markers[sample.marker];
    const Eigen::Vector3d p = unfolded.point(marker.bone, marker.p_in_bone);
    p_in_body_.emplace_back(p.x(), p.y(), p.z());
    p_in_world_.emplace_back(
        sample.p_in_world.x(), sample.p_in_world.y(), sample.p_in_world.z());
    weights_.push_back(1.0);
  }
  const RigidTransform world_from_body = align(p_in_body_, p_in_world_, weights_);
  Posture posture = attitude;
  for (const PoseParameter parameter : kAllPoseParameters) {
    if (!is_rotation(parameter)) continue;
    posture.set_rotation(
        parameter,
        glm::normalize(world_from_body.rotation * attitude.rotation(parameter)));
  }
  // The hips of the attitude are at the origin.
  for (int i = 0; i < 3; ++i) {
    posture.block(PoseParameter::kHipsPosition)[i] = world_from_body.translation[i];
  }
  return posture;
}

double MarkerPoseRelocalizer::anneal(std::span<const SeenMarker> seen,
                                     double first_scale,
                                     Posture& posture) {
  for (double scale = first_scale; scale > 1.5; scale /= 3.2) {
    (void)solver_.solve(seen, nullptr, posture, {{8, 0.03}, scale});
  }
  return solver_.solve(seen, nullptr, posture, {{15, 3e-3}, 1.0});
}

bool MarkerPoseRelocalizer::limb_misfits(std::size_t limb,
                                         std::span<const SeenMarker> seen,
                                         const Posture& posture) {
  const HumanLimb& bones = human_limbs()[limb];
  const UnfoldedPosture& unfolded = solver_.unfold(posture);
  for (const SeenMarker& sample : seen) {
    const ModelMarker& marker = model_->markers[sample.marker];
    if (marker.bone != bones.upper && marker.bone != bones.lower &&
        marker.bone != bones.end) {
      continue;
    }
    const double off =
        (unfolded.point(marker.bone, marker.p_in_bone) - sample.p_in_world).norm();
    if (off > kMisfitSigmas * std::hypot(marker.sigma_m, sample.sigma_m)) return true;
  }
  return false;
}

void MarkerPoseRelocalizer::retry_limbs(std::span<const SeenMarker> seen,
                                        FoundPosture& best) {
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    if (!limb_misfits(limb, seen, best.posture)) continue;
    const LimbParameters& s = kLimbParameters[limb];
    const bool left = limb % 2 == 0;
    const auto attitudes =
        limb < 2 ? std::span<const LimbAttitude>(kArmAttitudes) : kLegAttitudes;
    const Posture start = best.posture;
    const glm::dquat trunk =
        start.rotation(limb < 2 ? PoseParameter::kThorax : PoseParameter::kHips);
    for (const LimbAttitude& attitude : attitudes) {
      Posture posture = start;
      const glm::dquat frame = glm::normalize(trunk * mirrored_turn(attitude.rad, left));
      posture.set_rotation(s.frame, frame);
      posture.set_rotation(s.extremity, frame);
      *posture.block(s.flexion) = attitude.flexion;
      *posture.block(s.upper_twist) = 0.0;
      *posture.block(s.lower_twist) = 0.0;
      const double cost = anneal(seen, 10.0, posture);
      if (cost < best.cost) best = {posture, cost};
    }
  }
}

}  // namespace marey::reconstruct
