// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/body_model.h"

#include <memory>

#include <glm/geometric.hpp>

#include "core/assert.h"
#include "reconstruct/locate_rigid.h"
#include "reconstruct/posture_terms.h"
#include "reconstruct/sighting_cost.h"
#include "reconstruct/tag_slip.h"

namespace marey::reconstruct {
namespace {

struct Leaf {
  HumanBone bone;
  Slot slot;
};
constexpr std::array<Leaf, 5> kLeaves{{{HumanBone::kHead, Slot::kHead},
                                       {HumanBone::kLeftHand, Slot::kLeftHand},
                                       {HumanBone::kRightHand, Slot::kRightHand},
                                       {HumanBone::kLeftFoot, Slot::kLeftFoot},
                                       {HumanBone::kRightFoot, Slot::kRightFoot}}};

// How far a hand turns in a thirtieth of a second, at most: what tells two readings of
// one tag apart when both fit the picture.
constexpr double kTurnPerFrameRad = 0.3;

/// Least cost of one leaf's sightings over its rotation alone.
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
  add_habits(posture, model.lengths, problem);
  Posture held = before ? *before : posture;
  if (before) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<RelativeRotationPrior, 3, 4, 4>(
            new RelativeRotationPrior{{1, 0, 0, 0}, glm::dvec3(kTurnPerFrameRad)}),
        nullptr,
        held.block(leaf.slot),
        posture.block(leaf.slot));
    problem.SetParameterBlockConstant(held.block(leaf.slot));
  }
  set_manifolds(posture, problem);
  hold(posture, problem);
  problem.SetParameterBlockVariable(posture.block(leaf.slot));
  ceres::Solver::Options options = solver_options(10);
  options.linear_solver_type = ceres::DENSE_QR;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return cost_of(summary);
}

/// The rotations of the leaf that its tags propose, two each.
std::vector<glm::dquat> readings_of(const BodyModel& model,
                                    std::span<const TagSighting> sightings,
                                    std::span<const Camera> cameras,
                                    const Leaf& leaf) {
  std::vector<glm::dquat> readings;
  for (const TagSighting& s : sightings) {
    const RigidTransform* segment_from_tag = model.place(s.tag);
    if (model.bone(s.tag) != leaf.bone || !segment_from_tag) continue;
    for (const RigidTransform& world_from_tag : planar_candidates(
             cameras[index(s.camera)], *s.detection, model.tags[s.tag].size_m)) {
      readings.push_back(world_from_tag.rotation *
                         glm::conjugate(segment_from_tag->rotation));
    }
  }
  return readings;
}

}  // namespace

const RigidTransform* BodyModel::place(std::size_t tag) const {
  const auto found = segment_from_tag.find(tag);
  return found == segment_from_tag.end() ? nullptr : &found->second;
}

BodyModel to_model(const Body& body) {
  BodyModel model;
  model.lengths = lengths_of(body.proportions);
  model.body = frame_of(body);
  for (const PlacedTag& placed : body.tags) {
    model.segment_from_tag[model.tags.size()] = placed.segment_from_tag;
    model.tags.push_back(placed.tag);
  }
  return model;
}

ceres::LossFunction* tag_loss() {
  return new ceres::CauchyLoss(5.0);
}

void add_sighting(const BodyModel& model,
                  const TagSighting& sighting,
                  std::span<const Camera> cameras,
                  Posture& posture,
                  ceres::Problem& problem) {
  if (!model.place(sighting.tag)) return;
  problem.AddResidualBlock(new SightingCost(model, sighting, cameras),
                           tag_loss(),
                           blocks_of(posture, model.bone(sighting.tag)));
}

ceres::ResidualBlockId add_late_sighting(const BodyModel& model,
                                         const TagSighting& sighting,
                                         std::span<const Camera> cameras,
                                         Posture& posture,
                                         ceres::Problem& problem,
                                         double* offset_s,
                                         const std::array<glm::dvec2, 4>& velocity_px_s,
                                         const TagSlip& slip) {
  auto cost = std::make_unique<SightingCost>(model, sighting, cameras);
  cost->set_late(velocity_px_s, slip);
  std::vector<double*> blocks = blocks_of(posture, model.bone(sighting.tag));
  blocks.push_back(offset_s);
  return problem.AddResidualBlock(cost.release(), tag_loss(), blocks);
}

std::optional<std::array<glm::dvec2, 4>> predicted_corners_px(
    const BodyModel& model,
    const TagSighting& sighting,
    std::span<const Camera> cameras,
    const Posture& posture) {
  const RigidTransform* segment_from_tag = model.place(sighting.tag);
  if (!segment_from_tag) return std::nullopt;
  const RigidTransform world_from_tag =
      world_from_bone(model.bone(sighting.tag), posture, model.lengths, model.body) *
      *segment_from_tag;
  std::array<glm::dvec2, 4> corners{};
  for (int c = 0; c < 4; ++c) {
    const auto pixel =
        project(cameras[index(sighting.camera)],
                world_from_tag * corner_in_tag(c, model.tags[sighting.tag].size_m));
    if (!pixel) return std::nullopt;
    corners[static_cast<std::size_t>(c)] = *pixel;
  }
  return corners;
}

std::array<double, 4> corner_errors_px(const BodyModel& model,
                                       const TagSighting& sighting,
                                       std::span<const Camera> cameras,
                                       const Posture& posture) {
  constexpr double kBehind = 1e3;
  std::array<double, 4> errors{kBehind, kBehind, kBehind, kBehind};
  const auto predicted = predicted_corners_px(model, sighting, cameras, posture);
  if (!predicted) return errors;
  for (std::size_t i = 0; i < 4; ++i) {
    errors[i] = glm::distance((*predicted)[i], sighting.detection->corners_px[i]);
  }
  return errors;
}

int reconsider_extremities(const BodyModel& model,
                           std::span<const TagSighting> sightings,
                           std::span<const Camera> cameras,
                           const Posture* before,
                           Posture& posture) {
  int changed = 0;
  for (const Leaf& leaf : kLeaves) {
    const std::vector<glm::dquat> readings = readings_of(model, sightings, cameras, leaf);
    if (readings.empty()) continue;
    const glm::dquat was = posture.rotation(leaf.slot);
    double best = refine_leaf(model, sightings, cameras, leaf, before, posture);
    glm::dquat best_rotation = posture.rotation(leaf.slot);
    for (const glm::dquat& reading : readings) {
      posture.set_rotation(leaf.slot, reading);
      const double cost = refine_leaf(model, sightings, cameras, leaf, before, posture);
      if (cost < best) {
        best = cost;
        best_rotation = posture.rotation(leaf.slot);
      }
    }
    posture.set_rotation(leaf.slot, best_rotation);
    changed += glm::length(rotation_vector(glm::conjugate(was) * best_rotation)) > 0.1;
  }
  return changed;
}

}  // namespace marey::reconstruct
