// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/tag_corner_cost.h"

#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "reconstruct/posture/posture_steps.h"
#include "reconstruct/tags/soft_tissue_noise.h"
#include "tests/reconstruct/random_posture.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Dice;
using Rows = Eigen::Matrix<double, 8, Eigen::Dynamic, Eigen::RowMajor>;

/// One tag on `bone`, seen by a camera that faces it from 3 m.
struct Sight {
  BodyModel model;
  Posture posture;
  std::vector<Camera> cameras{marey::testing::ring_of_cameras().front()};
  TagDetection detection;
  TagSighting sighting;

  Sight(HumanBone bone, unsigned seed) {
    Dice dice(seed);
    model.lengths = random_lengths(dice);
    model.body = askew_frame(dice);
    posture = random_posture(dice);
    model.tags = {{TagId{7}, bone, 0.08}};
    model.segment_from_tag[0] = {rotation_from_vector({0.3, 2.0, -0.4}),
                                 glm::dvec3(0.04, -0.1, 0.05)};
    const RigidTransform world_from_tag =
        world_from_bone(bone, posture, model.lengths, model.body) *
        model.segment_from_tag[0];
    cameras[0].camera_from_world = inverse(
        world_from_tag * RigidTransform{{1, 0, 0, 0}, glm::dvec3(0.2, 0.1, -3.0)});
    detection.id = TagId{7};
    detection.sigma_px = 0.4;
    sighting = {CameraId{0}, 0, &detection};
    const auto seen = predicted_corners_px(model, sighting, cameras, posture);
    for (std::size_t c = 0; c < 4; ++c) {
      detection.corners_px[c] = (*seen)[c] + glm::dvec2(0.3, -0.2);
    }
  }

  [[nodiscard]] std::unique_ptr<TagCornerCost> late_cost() const {
    auto cost = std::make_unique<TagCornerCost>(model, sighting, cameras);
    const TagSlip slip = tag_slip(model, sighting, cameras, posture, 0.004, 2.0);
    cost->set_late({{{10, 20}, {30, -40}, {-5, 6}, {7, 80}}}, slip);
    return cost;
  }
};

std::vector<const double*> block_pointers(const Posture& posture,
                                          HumanBone bone,
                                          const double& late_s) {
  std::vector<const double*> parameters;
  for (const PoseParameter parameter : parameters_of(bone))
    parameters.push_back(posture.block(parameter));
  parameters.push_back(&late_s);
  return parameters;
}

Eigen::Matrix<double, 8, 1> residuals(const TagCornerCost& cost,
                                      const Posture& posture,
                                      HumanBone bone,
                                      double late_s) {
  Eigen::Matrix<double, 8, 1> out;
  EXPECT_TRUE(
      cost.Evaluate(block_pointers(posture, bone, late_s).data(), out.data(), nullptr));
  return out;
}

TEST(TagCornerCost, GivesTheDerivativesOfItsResiduals) {
  constexpr double kStep = 1e-6;
  for (const HumanBone bone : {HumanBone::kHips,
                               HumanBone::kUpperChest,
                               HumanBone::kHead,
                               HumanBone::kLeftUpperArm,
                               HumanBone::kRightLowerArm,
                               HumanBone::kLeftHand,
                               HumanBone::kRightUpperLeg,
                               HumanBone::kLeftLowerLeg,
                               HumanBone::kRightFoot}) {
    const Sight sight(bone, 3);
    const auto cost = sight.late_cost();
    const double late_s = 0.004;
    const std::vector<PoseParameter> parameters = parameters_of(bone);
    std::vector<Rows> blocks;
    std::vector<double*> jacobians;
    for (const PoseParameter parameter : parameters)
      blocks.emplace_back(8, block_size(parameter));
    blocks.emplace_back(8, 1);
    for (Rows& block : blocks) jacobians.push_back(block.data());
    Eigen::Matrix<double, 8, 1> here;
    ASSERT_TRUE(cost->Evaluate(block_pointers(sight.posture, bone, late_s).data(),
                               here.data(),
                               jacobians.data()));
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      for (int k = 0; k < tangent_size(parameters[i]); ++k) {
        PostureVector step = PostureVector::Zero();
        step[column_of(parameters[i]) + k] = kStep;
        Posture ahead = sight.posture;
        Posture behind = sight.posture;
        move(ahead, step);
        move(behind, PostureVector(-step));
        const Eigen::Matrix<double, 8, 1> is = (residuals(*cost, ahead, bone, late_s) -
                                                residuals(*cost, behind, bone, late_s)) /
                                               (2.0 * kStep);
        // For the four numbers of a rotation: along the step, by the chain rule.
        Eigen::VectorXd along(block_size(parameters[i]));
        for (int n = 0; n < block_size(parameters[i]); ++n) {
          along[n] = (ahead.block(parameters[i])[n] - behind.block(parameters[i])[n]) /
                     (2.0 * kStep);
        }
        EXPECT_LT((blocks[i] * along - is).norm(), 1e-5 * (1.0 + is.norm()))
            << name(bone) << " slot " << index(parameters[i]);
      }
    }
    const Eigen::Matrix<double, 8, 1> by_lateness =
        (residuals(*cost, sight.posture, bone, late_s + kStep) -
         residuals(*cost, sight.posture, bone, late_s - kStep)) /
        (2.0 * kStep);
    EXPECT_LT((blocks.back() - by_lateness).norm(), 1e-4) << name(bone);
  }
}

TEST(TagCornerCost, CostsAConstantBehindTheCamera) {
  Sight sight(HumanBone::kHips, 4);
  const RigidTransform turned{rotation_from_vector({0.0, 3.14159265358979, 0.0}), {}};
  sight.cameras[0].camera_from_world = turned * sight.cameras[0].camera_from_world;
  const TagCornerCost cost(sight.model, sight.sighting, sight.cameras);
  const auto seen = residuals(cost, sight.posture, HumanBone::kHips, 0.0);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(seen[i], 1e3);
}

}  // namespace
}  // namespace marey::reconstruct
