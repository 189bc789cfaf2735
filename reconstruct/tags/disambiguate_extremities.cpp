// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/disambiguate_extremities.h"

#include <array>
#include <vector>

#include <ceres/ceres.h>
#include <glm/geometric.hpp>

#include "reconstruct/clusters/locate_rigid.h"
#include "reconstruct/posture/posture_terms.h"
#include "reconstruct/tags/tag_corner_cost.h"

namespace marey::reconstruct {
namespace {

struct Leaf {
  HumanBone bone;
  PoseParameter parameter;
};
constexpr std::array<Leaf, 5> kLeaves{
    {{HumanBone::kHead, PoseParameter::kHead},
     {HumanBone::kLeftHand, PoseParameter::kLeftHand},
     {HumanBone::kRightHand, PoseParameter::kRightHand},
     {HumanBone::kLeftFoot, PoseParameter::kLeftFoot},
     {HumanBone::kRightFoot, PoseParameter::kRightFoot}}};

// Largest turn of a hand in a thirtieth of a second: separates two poses of one tag if
// both fit the picture.
constexpr double kTurnPerFrameRad = 0.3;

/// Minimizes the cost of one leaf's sightings over its rotation alone; returns that cost.
double refine_leaf(const BodyModel& model,
                   std::span<const TagSighting> sightings,
                   std::span<const Camera> cameras,
                   const Leaf& leaf,
                   const Posture* before,
                   Posture& posture) {
  ceres::Problem problem;
  for (const TagSighting& sighting : sightings) {
    if (model.bone(sighting.tag) == leaf.bone) {
      add_sighting(model, sighting, cameras, posture, problem);
    }
  }
  add_posture_priors(posture, model.lengths, problem);
  Posture held = before ? *before : posture;
  if (before) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<RelativeRotationPrior, 3, 4, 4>(
            new RelativeRotationPrior{{1, 0, 0, 0}, glm::dvec3(kTurnPerFrameRad)}),
        nullptr,
        held.block(leaf.parameter),
        posture.block(leaf.parameter));
    problem.SetParameterBlockConstant(held.block(leaf.parameter));
  }
  set_manifolds(posture, problem);
  set_posture_constant(posture, problem);
  problem.SetParameterBlockVariable(posture.block(leaf.parameter));
  ceres::Solver::Options options = solver_options(10);
  options.linear_solver_type = ceres::DENSE_QR;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return cost_of(summary);
}

/// Returns the rotations of the leaf that its tags propose, two each.
std::vector<glm::dquat> poses_of(const BodyModel& model,
                                 std::span<const TagSighting> sightings,
                                 std::span<const Camera> cameras,
                                 const Leaf& leaf) {
  std::vector<glm::dquat> poses;
  for (const TagSighting& s : sightings) {
    const RigidTransform* segment_from_tag = model.place(s.tag);
    if (model.bone(s.tag) != leaf.bone || !segment_from_tag) continue;
    for (const RigidTransform& world_from_tag : planar_candidates(
             cameras[index(s.camera)], *s.detection, model.tags[s.tag].size_m)) {
      poses.push_back(world_from_tag.rotation *
                      glm::conjugate(segment_from_tag->rotation));
    }
  }
  return poses;
}

}  // namespace

int disambiguate_extremities(const BodyModel& model,
                             std::span<const TagSighting> sightings,
                             std::span<const Camera> cameras,
                             const Posture* before,
                             Posture& posture) {
  int changed = 0;
  for (const Leaf& leaf : kLeaves) {
    const std::vector<glm::dquat> poses = poses_of(model, sightings, cameras, leaf);
    if (poses.empty()) continue;
    const glm::dquat was = posture.rotation(leaf.parameter);
    double best = refine_leaf(model, sightings, cameras, leaf, before, posture);
    glm::dquat best_rotation = posture.rotation(leaf.parameter);
    for (const glm::dquat& pose : poses) {
      posture.set_rotation(leaf.parameter, pose);
      const double cost = refine_leaf(model, sightings, cameras, leaf, before, posture);
      if (cost < best) {
        best = cost;
        best_rotation = posture.rotation(leaf.parameter);
      }
    }
    posture.set_rotation(leaf.parameter, best_rotation);
    changed += glm::length(rotation_vector(glm::conjugate(was) * best_rotation)) > 0.1;
  }
  return changed;
}

}  // namespace marey::reconstruct
