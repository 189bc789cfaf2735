// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/bundle_frames.h"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

#include "reconstruct/bundle/subject_solve.h"
#include "reconstruct/clusters/locate_rigid.h"
#include "reconstruct/posture/initial_posture.h"
#include "reconstruct/posture/posture_descent.h"
#include "reconstruct/tags/tag_loss.h"

namespace marey::reconstruct {
namespace {

// A sighting with a larger squared misfit is not explained by noise: five times the
// expectation.
constexpr double kMisfit2 = 40.0;
// A start with a smaller gain is the same pose.
constexpr double kGain = 2.0;

constexpr DescentLimits kSettle{15, 1e-3};

/// Returns whether descents from both end at the same solution, within the agreement of
/// tags and cameras.
bool is_near(const RigidTransform& a, const RigidTransform& b) {
  constexpr double kSameTurn_rad = 0.3;
  constexpr double kSamePlace_m = 0.06;
  return glm::distance(a.translation, b.translation) < kSamePlace_m &&
         glm::length(rotation_vector(glm::conjugate(a.rotation) * b.rotation)) <
             kSameTurn_rad;
}

bool is_of(const HumanLimb& limb, HumanBone bone) {
  return bone == limb.upper || bone == limb.lower || bone == limb.end;
}

}  // namespace

BundleFrameSolver::BundleFrameSolver(const SubjectBundle& bundle,
                                     std::span<const Camera> cameras,
                                     std::optional<std::size_t> limb)
    : bundle_(&bundle), cameras_(cameras), sight_(cameras), limb_(limb) {
  if (limb) held_ = columns_outside(*limb);
}

void BundleFrameSolver::evaluate(const BundleFrame& frame,
                                 const Posture& posture,
                                 PostureEquations& out) const {
  out.clear();
  UnfoldedPosture unfolded;
  unfolded.unfold(posture, bundle_->model.lengths, bundle_->model.body);
  SightedTag sighted;
  for (const TagSighting& s : frame.sightings) {
    if (!bundle_->model.place(s.tag)) continue;
    const SightingNoise noise = bundle_->noise(s.tag, posture, unfolded);
    if (!sight_.look(bundle_->model, unfolded, s, noise, true, sighted)) {
      out.cost += tag_cost(kBehind2);
      continue;
    }
    const double squared = sighted.residual.squaredNorm();
    out.cost += tag_cost(squared);
    const double weight = tag_weight(squared);
    for (int i = 0; i < sighted.posture_columns; ++i) {
      const int row = sighted.posture_column[static_cast<std::size_t>(i)];
      out.gradient[row] += weight * sighted.by_posture.col(i).dot(sighted.residual);
      for (int j = 0; j <= i; ++j) {
        const int at = sighted.posture_column[static_cast<std::size_t>(j)];
        out.hessian(std::max(row, at), std::min(row, at)) +=
            weight * sighted.by_posture.col(i).dot(sighted.by_posture.col(j));
      }
    }
  }
  out.add_posture_priors(posture, unfolded, kFrameTwists);
  if (frame.standing) out.add_standing(posture, unfolded);
  for (const int column : held_) {
    out.hessian.row(column).setZero();
    out.hessian.col(column).setZero();
    out.hessian(column, column) = 1.0;
    out.gradient[column] = 0.0;
  }
}

double BundleFrameSolver::descend(const BundleFrame& frame, Posture& posture) const {
  PostureDescent descent;
  return descent.run(
      [&](const Posture& p, PostureEquations& out) { evaluate(frame, p, out); },
      kSettle,
      posture);
}

double BundleFrameSolver::worst_misfit(const BundleFrame& frame,
                                       const Posture& posture,
                                       std::optional<std::size_t> limb) const {
  UnfoldedPosture unfolded;
  unfolded.unfold(posture, bundle_->model.lengths, bundle_->model.body);
  SightedTag sighted;
  double worst = 0.0;
  for (const TagSighting& s : frame.sightings) {
    if (!bundle_->model.place(s.tag)) continue;
    if (limb && !is_of(human_limbs()[*limb], bundle_->model.bone(s.tag))) continue;
    const SightingNoise noise = bundle_->noise(s.tag, posture, unfolded);
    const bool seen = sight_.look(bundle_->model, unfolded, s, noise, false, sighted);
    worst = std::max(worst, seen ? sighted.residual.squaredNorm() : kBehind2);
  }
  return worst;
}

std::vector<BundleFrameSolver::Start> BundleFrameSolver::candidate_starts(
    const BundleFrame& frame, std::span<const HumanBone> bones) const {
  std::vector<Start> starts;
  for (const TagSighting& s : frame.sightings) {
    const RigidTransform* segment_from_tag = bundle_->model.place(s.tag);
    const HumanBone bone = bundle_->model.bone(s.tag);
    if (!segment_from_tag || std::find(bones.begin(), bones.end(), bone) == bones.end()) {
      continue;
    }
    for (const RigidTransform& world_from_tag :
         planar_candidates(cameras_[index(s.camera)],
                           *s.detection,
                           bundle_->model.tags[s.tag].size_m)) {
      const RigidTransform world_from_bone = world_from_tag * inverse(*segment_from_tag);
      const bool is_known =
          std::any_of(starts.begin(), starts.end(), [&](const Start& start) {
            return start.bone == bone && is_near(start.world_from_bone, world_from_bone);
          });
      if (!is_known) starts.push_back({bone, world_from_bone});
    }
  }
  return starts;
}

bool BundleFrameSolver::settle_limb(std::size_t limb, BundleFrame& frame) const {
  if (worst_misfit(frame, frame.posture, limb) < kMisfit2) return false;
  const HumanLimb& bones = human_limbs()[limb];
  const BodyModel& model = bundle_->model;
  Posture best = frame.posture;
  double minimum = descend(frame, best) - kGain;
  bool changed = false;
  const auto try_start = [&](const FoundSegments& found) {
    const Posture start =
        posture_from_segments(found, model.lengths, model.body, frame.posture);
    Posture candidate = limb_ ? frame.posture : start;
    if (limb_) copy_limb(limb, start, candidate);
    const double cost = descend(frame, candidate);
    if (cost >= minimum) return;
    minimum = cost;
    best = candidate;
    changed = true;
  };
  const std::array of_limb{bones.upper, bones.lower, bones.end};
  const std::vector<Start> starts = candidate_starts(frame, of_limb);
  FoundSegments found;
  for (const HumanBone bone : {HumanBone::kHips, HumanBone::kUpperChest}) {
    found[index(bone)] = world_from_bone(bone, frame.posture, model.lengths, model.body);
  }
  for (const Start& a : starts) {
    found[index(a.bone)] = a.world_from_bone;
    if (a.bone == bones.upper) {
      for (const Start& b : starts) {
        if (b.bone != bones.lower) continue;
        found[index(b.bone)] = b.world_from_bone;
        try_start(found);
        found[index(b.bone)].reset();
      }
    }
    try_start(found);
    found[index(a.bone)].reset();
  }
  if (changed) frame.posture = best;
  return changed;
}

void BundleFrameSolver::settle_extremity(std::size_t limb, BundleFrame& frame) const {
  const HumanBone end = human_limbs()[limb].end;
  const std::array of_end{end};
  Posture best = frame.posture;
  double minimum = descend(frame, best);
  for (const Start& start : candidate_starts(frame, of_end)) {
    Posture candidate = frame.posture;
    candidate.set_rotation(kLimbParameters[limb].extremity,
                           start.world_from_bone.rotation);
    const double cost = descend(frame, candidate);
    if (cost >= minimum) continue;
    minimum = cost;
    best = candidate;
  }
  frame.posture = best;
}

bool BundleFrameSolver::settle(BundleFrame& frame) const {
  bool changed = false;
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    changed = settle_limb(limb, frame) || changed;
  }
  return changed;
}

}  // namespace marey::reconstruct
