// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/find_tagged_posture.h"

#include <algorithm>
#include <array>

#include "core/assert.h"

namespace marey::reconstruct {
namespace {

using B = HumanBone;

// A bone's tags that fit no better together are not one rigid thing: one is somebody
// else's, or misread.
constexpr double kBelievableRms_px = 4.0;
// A single view whose second reading costs less than this times the first is ambiguous.
constexpr double kUnambiguous = 3.0;
// Starts of a bone that are refined; those that fit worst at once are not.
constexpr std::size_t kStartsOfABone = 3;
// Of a limb, that are tried.
constexpr std::size_t kSightingsOfALimb = 4;
// How far a limb that is looked for anew may stray from where it was expected: a loose
// leash that matters where nothing is seen.
constexpr double kLeash_rad = 0.3;
// Of what stands still: [rad] and [m].
constexpr double kHeld = 1e-3;
// Another attitude has to be so much better.
constexpr double kClearly = 0.9;
// What has to be explained of what is seen, and how much there has to be.
constexpr double kExplained = 0.6;
constexpr std::size_t kFewestSightings = 4;
// Arms hang, in a posture that nothing tells.
constexpr double kElbow_rad = 0.3;

constexpr std::array<B, 4> kTrunk{B::kHips, B::kUpperChest, B::kChest, B::kSpine};

Posture hanging_arms() {
  Posture posture;
  for (std::size_t limb = 0; limb < 2; ++limb) {
    const double side = limb == 0 ? 1.0 : -1.0;
    const glm::dquat down = rotation_from_vector({0.0, 0.0, -side * kHangingArm_rad});
    posture.set_rotation(kLimbSlots[limb].frame, down);
    posture.set_rotation(kLimbSlots[limb].extremity, down);
    *posture.block(kLimbSlots[limb].flexion) = kElbow_rad;
  }
  return posture;
}

/// The posture carried as a whole, so that its hips are at `world_from_hips`.
Posture carried_to(const RigidTransform& world_from_hips, const Posture& posture) {
  Posture out = posture;
  for (const Slot slot : kAllSlots) {
    if (!is_rotation(slot)) continue;
    out.set_rotation(slot,
                     glm::normalize(world_from_hips.rotation * posture.rotation(slot)));
  }
  for (int i = 0; i < 3; ++i) {
    out.block(Slot::kHipsPosition)[i] = world_from_hips.translation[i];
  }
  return out;
}

void take_limb(std::size_t limb, const Posture& from, Posture& to) {
  const LimbSlots& s = kLimbSlots[limb];
  for (const Slot slot :
       {s.frame, s.flexion, s.upper_twist, s.lower_twist, s.extremity}) {
    std::copy_n(from.block(slot), block_size(slot), to.block(slot));
  }
}

double squares_of(std::span<const RigidPointView> views, const RigidTransform& pose) {
  double sum = 0.0;
  for (const RigidPointView& view : views) {
    const auto pixel = project(*view.camera, pose * view.p_in_body);
    // As if it were on the other side of the picture.
    const glm::dvec2 off = pixel ? *pixel - view.pixel_px : glm::dvec2(1000.0);
    sum += std::min(1e4, glm::dot(off, off));
  }
  return sum;
}

}  // namespace

TaggedPostureFinder::TaggedPostureFinder(const TagModel& model)
    : model_(&model), solver_(model) {
  const std::size_t most = model.tags.size() * model.cameras.size();
  views_.reserve(4 * most);
  starts_.reserve(2 * most);
  fits_.reserve(most);
  own_.reserve(most);
}

std::optional<RigidTransform> TaggedPostureFinder::locate_bone(
    HumanBone bone, std::span<const SeenTag> seen) {
  views_.clear();
  starts_.clear();
  for (const SeenTag& one : seen) {
    const ModelTag& tag = model_->tags[one.tag];
    if (tag.bone != bone) continue;
    const Camera& camera = model_->cameras[one.camera];
    append_corner_views(camera, one.detection, tag.tag.size_m, tag.bone_from_tag, views_);
    const auto readings = planar_readings(camera, one.detection, tag.tag.size_m);
    if (!readings) continue;
    for (const RigidTransform& world_from_tag : *readings) {
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
  if (!pose || pose->rms_px > kBelievableRms_px) return std::nullopt;
  const bool one_view = views_.size() == 4;
  if (one_view && pose->ambiguity_ratio < kUnambiguous) return std::nullopt;
  return pose->world_from_body;
}

void TaggedPostureFinder::locate(std::span<const SeenTag> seen) {
  for (const HumanBone bone : human_bones()) {
    found_[index(bone)] = locate_bone(bone, seen);
  }
}

std::optional<Posture> TaggedPostureFinder::find(std::span<const SeenTag> seen) {
  if (seen.size() < kFewestSightings) return std::nullopt;
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
  for (std::size_t limb = 0; limb < kLimbSlots.size(); ++limb) {
    if (!limb_misfits(limb, seen, fits_)) continue;
    if (retry_limb(limb, seen, {}, {}, posture)) (void)solver_.solve(seen, {}, posture);
  }
  solver_.fit(seen, {}, posture, fits_);
  const auto explained = std::count_if(
      fits_.begin(), fits_.end(), [](const TagFit& f) { return f.rms_px < kLostPx; });
  if (static_cast<double>(explained) < kExplained * static_cast<double>(seen.size())) {
    return std::nullopt;
  }
  return posture;
}

bool TaggedPostureFinder::limb_misfits(std::size_t limb,
                                       std::span<const SeenTag> seen,
                                       std::span<const TagFit> fits) const {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (limb_of(model_->tags[seen[i].tag].bone) != limb) continue;
    if (fits[i].rms_px > kLostPx) return true;
  }
  return false;
}

bool TaggedPostureFinder::retry_limb(std::size_t limb,
                                     std::span<const SeenTag> seen,
                                     const TagFrameSolver::Beside& beside,
                                     const TagLimits& limits,
                                     Posture& posture) {
  own_.clear();
  for (const SeenTag& one : seen) {
    if (!beside.prior || limb_of(model_->tags[one.tag].bone) == limb) own_.push_back(one);
  }
  const Posture start = posture;
  TagFrameSolver::Beside own = beside;
  if (beside.prior) {
    leash(limb, start, *beside.prior);
    own.prior = &leash_;
  }
  TagLimits quick = limits;
  quick.iterations = 8;
  locate(own_);
  const FoundSegments found = found_;
  double least = solver_.solve(own_, own, posture, quick);
  bool changed = false;
  std::size_t tried = 0;
  for (const SeenTag& one : own_) {
    const ModelTag& tag = model_->tags[one.tag];
    if (limb_of(tag.bone) != limb || tried == kSightingsOfALimb) continue;
    const auto readings =
        planar_readings(model_->cameras[one.camera], one.detection, tag.tag.size_m);
    if (!readings) continue;
    ++tried;
    for (const RigidTransform& world_from_tag : *readings) {
      found_ = found;
      found_[index(tag.bone)] = world_from_tag * inverse(tag.bone_from_tag);
      Posture candidate = start;
      take_limb(limb,
                posture_from_segments(found_, model_->lengths, model_->body, start),
                candidate);
      const double cost = solver_.solve(own_, own, candidate, quick);
      if (!(cost < kClearly * least)) continue;
      least = cost;
      posture = candidate;
      changed = true;
    }
  }
  if (!changed) posture = start;
  return changed;
}

/// What is believed while a limb is tried: the rest of the body stands still, the limb is
/// somewhere near to where it is expected.
void TaggedPostureFinder::leash(std::size_t limb,
                                const Posture& start,
                                const PosturePrior& prior) {
  leash_.expected = start;
  for (Eigen::Matrix3d& information : leash_.information) {
    information = Eigen::Matrix3d::Identity() / (kHeld * kHeld);
  }
  take_limb(limb, prior.expected, leash_.expected);
  const LimbSlots& s = kLimbSlots[limb];
  for (const Slot slot :
       {s.frame, s.flexion, s.upper_twist, s.lower_twist, s.extremity}) {
    leash_.information[index(slot)] =
        Eigen::Matrix3d::Identity() / (kLeash_rad * kLeash_rad);
  }
}

}  // namespace marey::reconstruct
