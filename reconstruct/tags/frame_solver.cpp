// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/frame_solver.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "reconstruct/clusters/locate_rigid.h"
#include "reconstruct/posture/initial_posture.h"
#include "reconstruct/posture/posture_terms.h"
#include "reconstruct/tags/disambiguate_extremities.h"
#include "reconstruct/tags/tag_corner_cost.h"

namespace marey::reconstruct {
namespace {

// A larger distance of a tag from its model is not explained by noise or blur.
constexpr double kMaxMisfit_px = 3.0;
// Loose prior on the change of a tracked frame from the previous one. It matters only for
// unseen parameters.
constexpr double kMotionSigmaRad = 0.3;
constexpr double kMotionSigmaM = 0.1;
// Expected share of its speed that a frame keeps: below 1, so that unseen parameters do
// not drift away.
constexpr double kSpeedShare = 0.7;
// Postures that differ by less in every rotation count as the same solution.
constexpr double kAgreeRad = 0.35;

std::vector<TagCluster> clusters_of(const BodyModel& model) {
  std::map<HumanBone, TagCluster> by_bone;
  for (const auto& [tag, segment_from_tag] : model.segment_from_tag) {
    TagCluster& cluster = by_bone[model.bone(tag)];
    cluster.segment = model.bone(tag);
    cluster.cluster_from_tag[tag] = segment_from_tag;
  }
  std::vector<TagCluster> clusters;
  for (auto& [bone, cluster] : by_bone) clusters.push_back(std::move(cluster));
  return clusters;
}

/// Returns the largest rotation between blocks of two postures. [rad]
double turn_between(const Posture& a, const Posture& b) {
  double max_rad = 0.0;
  for (const PoseParameter parameter : kAllPoseParameters) {
    if (!is_rotation(parameter)) continue;
    const glm::dquat turn = glm::conjugate(a.rotation(parameter)) * b.rotation(parameter);
    max_rad = std::max(max_rad, glm::length(rotation_vector(turn)));
  }
  return max_rad;
}

}  // namespace

FrameSolver::FrameSolver(const BodyModel& model, std::span<const Camera> cameras)
    : model_(&model), cameras_(cameras), clusters_(clusters_of(model)) {}

std::map<HumanBone, RigidTransform> FrameSolver::locate(
    std::span<const TagSighting> frame) const {
  std::map<HumanBone, RigidTransform> found;
  for (const TagCluster& cluster : clusters_) {
    if (const auto pose = locate_cluster(cluster, cameras_, model_->tags, frame)) {
      found[cluster.segment] = *pose;
    }
  }
  return found;
}

Posture FrameSolver::track(std::span<const TagSighting> frame,
                           const Posture* before,
                           const Posture* earlier) const {
  Posture predicted = before ? *before : Posture{};
  if (earlier) predicted = extrapolate(*earlier, *before, kSpeedShare);
  const Posture* expected = before ? &predicted : nullptr;
  const auto found = locate(frame);
  const Posture from_tags =
      posture_from_segments(found, model_->lengths, model_->body, predicted);
  const bool tags_are_nearer =
      !before || median_misfit_px(frame, from_tags) < median_misfit_px(frame, predicted);
  Posture posture = tags_are_nearer ? from_tags : predicted;
  (void)refine(frame, expected, posture);
  if (disambiguate_extremities(*model_, frame, cameras_, before, posture) > 0) {
    (void)refine(frame, expected, posture);
  }
  if (median_misfit_px(frame, posture) > kMaxMisfit_px) {
    Posture other = tags_are_nearer ? predicted : from_tags;
    (void)refine(frame, expected, other);
    if (median_misfit_px(frame, other) < median_misfit_px(frame, posture)) {
      posture = other;
    }
  }
  retry_limbs(frame, found, expected, posture);
  return posture;
}

void FrameSolver::track_back(std::span<const TagSighting> frame,
                             const Posture& after,
                             const Posture* later,
                             Posture& posture) const {
  const Posture predicted = later ? extrapolate(*later, after, kSpeedShare) : after;
  if (turn_between(predicted, posture) < kAgreeRad) return;
  Posture candidate = predicted;
  (void)refine(frame, &predicted, candidate);
  (void)disambiguate_extremities(*model_, frame, cameras_, &after, candidate);
  Posture forward = posture;
  if (refine(frame, &predicted, candidate) < refine(frame, &predicted, forward)) {
    posture = candidate;
  }
}

double FrameSolver::refine(std::span<const TagSighting> frame,
                           const Posture* predicted,
                           Posture& posture) const {
  ceres::Problem problem;
  for (const TagSighting& s : frame) {
    add_sighting(*model_, s, cameras_, posture, problem);
  }
  add_posture_priors(posture, model_->lengths, problem);
  if (predicted)
    add_motion_prior(*predicted, kMotionSigmaRad, kMotionSigmaM, posture, problem);
  set_manifolds(posture, problem);
  ceres::Solver::Options solver = solver_options(15);
  solver.function_tolerance = 1e-4;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return cost_of(summary);
}

/// Returns the distance of the sighting's corners from their model, as the median of the
/// four; 0 for a tag without a place.
double FrameSolver::misfit_px(const TagSighting& sighting, const Posture& posture) const {
  if (!model_->place(sighting.tag)) return 0.0;
  const auto e = corner_errors_px(*model_, sighting, cameras_, posture);
  return median({e.begin(), e.end()});
}

double FrameSolver::median_misfit_px(std::span<const TagSighting> frame,
                                     const Posture& posture) const {
  std::vector<double> misfits;
  for (const TagSighting& s : frame) {
    if (model_->place(s.tag)) misfits.push_back(misfit_px(s, posture));
  }
  return misfits.empty() ? 0.0 : median(std::move(misfits));
}

/// Restarts limbs whose tags do not fit from every planar pose of their bones' tags. Such
/// a limb bends in the wrong direction, because a single tag had the wrong planar pose.
void FrameSolver::retry_limbs(std::span<const TagSighting> frame,
                              const std::map<HumanBone, RigidTransform>& found,
                              const Posture* predicted,
                              Posture& posture) const {
  for (const HumanLimb& limb : human_limbs()) {
    std::vector<const TagSighting*> of_limb;
    double worst_px = 0.0;
    for (const TagSighting& s : frame) {
      const HumanBone bone = model_->bone(s.tag);
      if (bone != limb.upper && bone != limb.lower && bone != limb.end) continue;
      if (model_->place(s.tag)) of_limb.push_back(&s);
      worst_px = std::max(worst_px, misfit_px(s, posture));
    }
    if (worst_px < kMaxMisfit_px) continue;
    double min_cost = refine(frame, predicted, posture);
    const Posture start = posture;
    for (const TagSighting* s : of_limb) {
      for (const RigidTransform& world_from_tag : planar_candidates(
               cameras_[index(s->camera)], *s->detection, model_->tags[s->tag].size_m)) {
        auto segments = found;
        segments[model_->bone(s->tag)] = world_from_tag * inverse(*model_->place(s->tag));
        Posture candidate =
            posture_from_segments(segments, model_->lengths, model_->body, start);
        const double cost = refine(frame, predicted, candidate);
        if (cost >= min_cost) continue;
        min_cost = cost;
        posture = candidate;
      }
    }
  }
}

std::optional<std::vector<Posture>> track_postures(const FrameSolver& solver,
                                                   const Sightings& sightings,
                                                   const Progress& progress) {
  const std::size_t count = sightings.frames.size();
  std::size_t first = 0;
  while (first < count &&
         !solver.locate(sightings.frames[first]).contains(HumanBone::kHips)) {
    ++first;
  }
  if (first == count) return std::nullopt;
  std::vector<Posture> postures(count);
  for (std::size_t f = first; f < count; ++f) {
    const Posture* before = f > first ? &postures[f - 1] : nullptr;
    const Posture* earlier = f > first + 1 ? &postures[f - 2] : nullptr;
    postures[f] = solver.track(sightings.frames[f], before, earlier);
    if (progress) progress(static_cast<int>(f) + 1, static_cast<int>(count));
  }
  for (std::size_t f = 0; f < first; ++f) postures[f] = postures[first];
  for (std::size_t f = count - 1; f-- > 0;) {
    const Posture* later = f + 2 < count ? &postures[f + 2] : nullptr;
    solver.track_back(sightings.frames[f], postures[f + 1], later, postures[f]);
  }
  return postures;
}

}  // namespace marey::reconstruct
