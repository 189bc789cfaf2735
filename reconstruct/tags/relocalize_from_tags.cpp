// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/relocalize_from_tags.h"

#include <algorithm>
#include <array>

#include "core/base/assert.h"

namespace marey::reconstruct {
namespace {

using B = HumanBone;

// A larger misfit of a bone's tags together means that they are not rigidly connected:
// one belongs to another person or is misread.
constexpr double kMaxRms_px = 4.0;
// A single view is ambiguous if its second pose costs less than this times the first.
constexpr double kUnambiguous = 3.0;
// Maximum number of starts of a bone that are refined; the best before refinement are
// kept.
constexpr std::size_t kStartsOfABone = 3;
// Maximum number of sightings of a limb that are tried.
constexpr std::size_t kSightingsOfALimb = 4;
// Loose motion prior on a limb that is searched again. It matters only for unseen
// parameters.
constexpr double kMotionSigma_rad = 0.3;
// Sigma of held parameters: [rad] and [m].
constexpr double kHeld = 1e-3;
// Another attitude must reduce the cost to less than this share.
constexpr double kClearly = 0.9;
// Share of the sightings that must be explained, and their minimum number.
constexpr double kExplained = 0.6;
constexpr std::size_t kMinSightings = 4;
// Elbow flexion of unseen arms.
constexpr double kElbow_rad = 0.3;

constexpr std::array<B, 4> kTrunk{B::kHips, B::kUpperChest, B::kChest, B::kSpine};

Posture hanging_arms() {
  Posture posture;
  for (std::size_t limb = 0; limb < 2; ++limb) {
    const double side = limb == 0 ? 1.0 : -1.0;
    const glm::dquat down = rotation_from_vector({0.0, 0.0, -side * kHangingArm_rad});
    posture.set_rotation(kLimbParameters[limb].frame, down);
    posture.set_rotation(kLimbParameters[limb].extremity, down);
    *posture.block(kLimbParameters[limb].flexion) = kElbow_rad;
  }
  return posture;
}

/// Returns the posture moved as a rigid whole, so that its hips are at `world_from_hips`.
Posture carried_to(const RigidTransform& world_from_hips, const Posture& posture) {
  Posture out = posture;
  for (const PoseParameter parameter : kAllPoseParameters) {
    if (!is_rotation(parameter)) continue;
    out.set_rotation(
        parameter,
        glm::normalize(world_from_hips.rotation * posture.rotation(parameter)));
  }
  for (int i = 0; i < 3; ++i) {
    out.block(PoseParameter::kHipsPosition)[i] = world_from_hips.translation[i];
  }
  return out;
}

double squares_of(std::span<const RigidPointView> views, const RigidTransform& pose) {
  double sum = 0.0;
  for (const RigidPointView& view : views) {
    const auto pixel = project(*view.camera, pose * view.p_in_body);
    // A point without a projection counts as 1000 px off.
    const glm::dvec2 off = pixel ? *pixel - view.pixel_px : glm::dvec2(1000.0);
    sum += std::min(1e4, glm::dot(off, off));
  }
  return sum;
}

}  // namespace

TagPoseRelocalizer::TagPoseRelocalizer(const TagModel& model)
    : model_(&model), solver_(model) {
  const std::size_t maximum = model.tags.size() * model.cameras.size();
  views_.reserve(4 * maximum);
  starts_.reserve(2 * maximum);
  fits_.reserve(maximum);
  own_.reserve(maximum);
}

std::optional<RigidTransform> TagPoseRelocalizer::locate_bone(
    HumanBone bone, std::span<const SeenTag> seen) {
  views_.clear();
  starts_.clear();
  for (const SeenTag& one : seen) {
    const ModelTag& tag = model_->tags[one.tag];
    if (tag.bone != bone) continue;
    const Camera& camera = model_->cameras[one.camera];
    append_corner_views(camera, one.detection, tag.tag.size_m, tag.bone_from_tag, views_);
    const auto poses = planar_poses(camera, one.detection, tag.tag.size_m);
    if (!poses) continue;
    for (const RigidTransform& world_from_tag : *poses) {
      starts_.push_back(world_from_tag * inverse(tag.bone_from_tag));
    }
  }
  if (views_.empty()) return std::nullopt;
  const std::size_t kept = std::min(starts_.size(), kStartsOfABone);
  std::partial_sort(starts_.begin(),
                    starts_.begin() + static_cast<std::ptrdiff_t>(kept),
                    starts_.end(),
                    [&](const RigidTransform& a, const RigidTransform& b) {
                      return squares_of(views_, a) < squares_of(views_, b);
                    });
  const auto pose = locate_rigid_in_place(views_, std::span(starts_).first(kept));
  if (!pose || pose->rms_px > kMaxRms_px) return std::nullopt;
  const bool one_view = views_.size() == 4;
  if (one_view && pose->ambiguity_ratio < kUnambiguous) return std::nullopt;
  return pose->world_from_body;
}

void TagPoseRelocalizer::locate(std::span<const SeenTag> seen) {
  for (const HumanBone bone : human_bones()) {
    found_[index(bone)] = locate_bone(bone, seen);
  }
}

std::optional<Posture> TagPoseRelocalizer::find(std::span<const SeenTag> seen) {
  if (seen.size() < kMinSightings) return std::nullopt;
  locate(seen);
  const auto trunk = std::find_if(kTrunk.begin(), kTrunk.end(), [&](HumanBone bone) {
    return found_[index(bone)].has_value();
  });
  if (trunk == kTrunk.end()) return std::nullopt;
  const Posture attitude = hanging_arms();
  const RigidTransform world_from_hips =
      *found_[index(*trunk)] *
      inverse(world_from_bone(*trunk, attitude, model_->lengths, model_->body));
  Posture posture = posture_from_segments(
      found_, model_->lengths, model_->body, carried_to(world_from_hips, attitude));
  (void)solver_.solve(seen, {}, posture, {{8, 0.03}, 10.0});
  (void)solver_.solve(seen, {}, posture, {{15, 3e-3}, 1.0});
  fits_.resize(seen.size());
  solver_.fit(seen, {}, posture, fits_);
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    if (!limb_misfits(limb, seen, fits_)) continue;
    if (retry_limb(limb, seen, {}, {}, posture)) (void)solver_.solve(seen, {}, posture);
  }
  solver_.fit(seen, {}, posture, fits_);
  const auto explained =
      std::count_if(fits_.begin(), fits_.end(), [](const SightingFit& f) {
        return f.rms_px < kLostPx;
      });
  if (static_cast<double>(explained) < kExplained * static_cast<double>(seen.size())) {
    return std::nullopt;
  }
  return posture;
}

bool TagPoseRelocalizer::limb_misfits(std::size_t limb,
                                      std::span<const SeenTag> seen,
                                      std::span<const SightingFit> fits) const {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (limb_of(model_->tags[seen[i].tag].bone) != limb) continue;
    if (fits[i].rms_px > kLostPx) return true;
  }
  return false;
}

bool TagPoseRelocalizer::retry_limb(std::size_t limb,
                                    std::span<const SeenTag> seen,
                                    const TagFrameSolver::SolveInputs& inputs,
                                    const FrameLimits& limits,
                                    Posture& posture) {
  own_.clear();
  for (const SeenTag& one : seen) {
    if (!inputs.prior || limb_of(model_->tags[one.tag].bone) == limb) own_.push_back(one);
  }
  const Posture start = posture;
  TagFrameSolver::SolveInputs own = inputs;
  if (inputs.prior) {
    set_motion_prior(limb, start, *inputs.prior);
    own.prior = &motion_prior_;
  }
  FrameLimits quick = limits;
  quick.iterations = 8;
  locate(own_);
  const FoundSegments found = found_;
  double minimum = solver_.solve(own_, own, posture, quick);
  bool changed = false;
  std::size_t tried = 0;
  for (const SeenTag& one : own_) {
    const ModelTag& tag = model_->tags[one.tag];
    if (limb_of(tag.bone) != limb || tried == kSightingsOfALimb) continue;
    const auto poses =
        planar_poses(model_->cameras[one.camera], one.detection, tag.tag.size_m);
    if (!poses) continue;
    ++tried;
    for (const RigidTransform& world_from_tag : *poses) {
      found_ = found;
      found_[index(tag.bone)] = world_from_tag * inverse(tag.bone_from_tag);
      Posture candidate = start;
      copy_limb(limb,
                posture_from_segments(found_, model_->lengths, model_->body, start),
                candidate);
      const double cost = solver_.solve(own_, own, candidate, quick);
      if (!(cost < kClearly * minimum)) continue;
      minimum = cost;
      posture = candidate;
      changed = true;
    }
  }
  if (!changed) posture = start;
  return changed;
}

/// Sets the prior for trying a limb: the rest of the body is held, the limb is near its
/// expected pose.
void TagPoseRelocalizer::set_motion_prior(std::size_t limb,
                                          const Posture& start,
                                          const PosturePrior& prior) {
  motion_prior_.expected = start;
  for (Eigen::Matrix3d& information : motion_prior_.information) {
    information = Eigen::Matrix3d::Identity() / (kHeld * kHeld);
  }
  copy_limb(limb, prior.expected, motion_prior_.expected);
  const LimbParameters& s = kLimbParameters[limb];
  for (const PoseParameter parameter :
       {s.frame, s.flexion, s.upper_twist, s.lower_twist, s.extremity}) {
    motion_prior_.information[index(parameter)] =
        Eigen::Matrix3d::Identity() / (kMotionSigma_rad * kMotionSigma_rad);
  }
}

}  // namespace marey::reconstruct
