// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject/place_extremity.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "reconstruct/bundle/bundle_frames.h"
#include "reconstruct/bundle/limb_bundle.h"
#include "reconstruct/bundle/subject_solve.h"
#include "reconstruct/clusters/locate_rigid.h"
#include "reconstruct/clusters/tag_clusters.h"

namespace marey::reconstruct {
namespace {

// Candidates nearer than this (metres, a radian counting as 0.1 m) are one hypothesis:
// half of the distance between the two poses of a tag that faces away by 20 degrees.
constexpr double kOneHypothesis = 0.05;
constexpr std::size_t kMaxHypotheses = 5;
// Largest squared misfit of an explained sighting.
constexpr double kExtremityExplained2 = 40.0;
constexpr double kMinShare = 0.6;
constexpr int kMinTagSightings = 3;
// Wrists or ankles this far apart are different answers. [m]
constexpr double kMinMove_m = 0.02;

double apart(const RigidTransform& x, const RigidTransform& y) {
  return glm::distance(x.translation, y.translation) +
         0.1 * glm::length(rotation_vector(glm::conjugate(x.rotation) * y.rotation));
}

/// Returns the rotation of an extremity of which only the bone before it is known.
glm::dquat expected_rotation(std::size_t limb,
                             const BundleFrame& frame,
                             const RigidTransform& world_from_lower) {
  if (limb < 2 || !frame.standing) return world_from_lower.rotation;
  // A foot flat on the floor, turned out as far as the shin.
  const glm::dvec3 side = world_from_lower.rotation * glm::dvec3(1, 0, 0);
  const glm::dvec3 level = glm::normalize(glm::dvec3(side.x, 0.0, side.z));
  return rotation_between(glm::dvec3(1, 0, 0), level);
}

/// Computes bone_from_tag by every planar pose of every sighting of `tag`.
std::vector<RigidTransform> candidates(std::size_t limb,
                                       std::size_t tag,
                                       const SubjectBundle& bundle,
                                       std::span<const Camera> cameras) {
  const HumanLimb& bones = human_limbs()[limb];
  const BodyModel& model = bundle.model;
  std::vector<RigidTransform> out;
  for (const BundleFrame& frame : bundle.frames) {
    for (const TagSighting& s : frame.sightings) {
      if (s.tag != tag) continue;
      const RigidTransform lower =
          world_from_bone(bones.lower, frame.posture, model.lengths, model.body);
      const RigidTransform end{
          expected_rotation(limb, frame, lower),
          world_from_bone(bones.end, frame.posture, model.lengths, model.body)
              .translation};
      for (const RigidTransform& world_from_tag : planar_candidates(
               cameras[index(s.camera)], *s.detection, model.tags[tag].size_m)) {
        out.push_back(inverse(end) * world_from_tag);
      }
    }
  }
  return out;
}

/// Adds the candidates with most others nearby, each of another neighbourhood.
void add_modes(std::vector<RigidTransform> left, std::vector<RigidTransform>& modes) {
  while (!left.empty() && modes.size() < kMaxHypotheses) {
    std::size_t best = 0;
    std::ptrdiff_t maximum = -1;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const auto near = std::count_if(left.begin(), left.end(), [&](const auto& other) {
        return apart(left[i], other) < kOneHypothesis;
      });
      if (near <= maximum) continue;
      maximum = near;
      best = i;
    }
    const RigidTransform mode = left[best];
    std::erase_if(left, [&](const auto& c) { return apart(mode, c) < kOneHypothesis; });
    const bool known = std::any_of(modes.begin(), modes.end(), [&](const auto& other) {
      return apart(mode, other) < 0.5 * kOneHypothesis;
    });
    if (!known) modes.push_back(mode);
  }
}

/// Places the other tags of the extremity whose sightings agree with the body's.
void place_others(std::span<const std::size_t> tags,
                  std::span<const Camera> cameras,
                  SubjectBundle& bundle) {
  constexpr double kPostureAgreement = 0.04;
  for (const std::size_t tag : tags) {
    if (bundle.model.place(tag)) continue;
    std::vector<RigidTransform> bone_from_tag;
    for (const BundleFrame& frame : bundle.frames) {
      const auto world_from_tag =
          locate_tag(tag, cameras, bundle.model.tags, frame.sightings);
      if (!world_from_tag) continue;
      bone_from_tag.push_back(inverse(world_from_bone(bundle.model.bone(tag),
                                                      frame.posture,
                                                      bundle.model.lengths,
                                                      bundle.model.body)) *
                              *world_from_tag);
    }
    if (const auto agreed = agreed_pose(bone_from_tag, kPostureAgreement)) {
      bundle.model.segment_from_tag[tag] = *agreed;
    }
  }
}

std::optional<double> solve_hypothesis(std::size_t limb,
                                       const RigidTransform& bone_from_tag,
                                       std::span<const std::size_t> tags,
                                       std::span<const Camera> cameras,
                                       SubjectBundle& bundle) {
  bundle.model.segment_from_tag[tags.front()] = bone_from_tag;
  const double noise_scale = bundle.noise_scale;
  std::optional<double> cost;
  // A loose loss first, in which distant sightings still have an effect.
  for (const double looser : {5.0, 1.0}) {
    bundle.noise_scale = looser * noise_scale;
    const BundleFrameSolver solver(bundle, cameras, limb);
    for (BundleFrame& frame : bundle.frames) solver.settle_extremity(limb, frame);
    cost = adjust(bundle, cameras, looser > 1.0 ? 8 : 15, {limb});
    if (!cost) break;
    if (looser > 1.0) place_others(tags, cameras, bundle);
  }
  bundle.noise_scale = noise_scale;
  return cost;
}

double explained_share(std::span<const std::size_t> tags,
                       std::span<const Camera> cameras,
                       const SubjectBundle& bundle,
                       int& sightings) {
  const SubjectSight sight(cameras);
  UnfoldedPosture unfolded;
  SightedTag sighted;
  int explained = 0;
  sightings = 0;
  for (const BundleFrame& frame : bundle.frames) {
    unfolded.unfold(frame.posture, bundle.model.lengths, bundle.model.body);
    for (const TagSighting& s : frame.sightings) {
      if (std::find(tags.begin(), tags.end(), s.tag) == tags.end()) continue;
      ++sightings;
      explained += bundle.model.place(s.tag) &&
                   sight.look(bundle.model,
                              unfolded,
                              s,
                              bundle.noise(s.tag, frame.posture, unfolded),
                              false,
                              sighted) &&
                   sighted.residual.squaredNorm() < kExtremityExplained2;
    }
  }
  return sightings == 0 ? 0.0 : static_cast<double>(explained) / sightings;
}

double ends_apart_m(std::size_t limb, const SubjectBundle& a, const SubjectBundle& b) {
  const HumanBone end = human_limbs()[limb].end;
  double sum = 0.0;
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    const auto place = [&](const SubjectBundle& bundle) {
      return world_from_bone(
                 end, bundle.frames[f].posture, bundle.model.lengths, bundle.model.body)
          .translation;
    };
    sum += glm::distance(place(a), place(b));
  }
  return sum / static_cast<double>(a.frames.size());
}

}  // namespace

ExtremityFit place_extremity(std::size_t limb,
                             std::span<const std::size_t> tags,
                             std::span<const RigidTransform> starts,
                             std::span<const Camera> cameras,
                             SubjectBundle& bundle) {
  LimbBundle own;
  cut_out(limb, bundle, own);
  ExtremityFit fit;
  fit.runner_up_cost = std::numeric_limits<double>::infinity();
  std::vector<RigidTransform> hypotheses(starts.begin(), starts.end());
  add_modes(candidates(limb, tags.front(), own.bundle, cameras), hypotheses);
  struct Solved {
    LimbBundle limb;
    double cost = 0.0;
  };
  std::vector<Solved> solved;
  for (const RigidTransform& start : hypotheses) {
    Solved one;
    cut_out(limb, bundle, one.limb);
    const auto cost = solve_hypothesis(limb, start, tags, cameras, one.limb.bundle);
    if (!cost) continue;
    one.cost = *cost;
    solved.push_back(std::move(one));
  }
  const auto best = std::min_element(
      solved.begin(), solved.end(), [](const Solved& a, const Solved& b) {
        return a.cost < b.cost;
      });
  if (best == solved.end()) return fit;
  fit.explained_share = explained_share(tags, cameras, best->limb.bundle, fit.sightings);
  for (const Solved& other : solved) {
    const double away_m = ends_apart_m(limb, best->limb.bundle, other.limb.bundle);
    if (away_m < kMinMove_m || other.cost - best->cost >= fit.runner_up_cost) continue;
    fit.runner_up_cost = other.cost - best->cost;
    fit.runner_up_m = away_m;
  }
  fit.placed = fit.explained_share >= kMinShare && fit.sightings >= kMinTagSightings;
  if (fit.placed) take_back(limb, best->limb, bundle);
  return fit;
}

}  // namespace marey::reconstruct
