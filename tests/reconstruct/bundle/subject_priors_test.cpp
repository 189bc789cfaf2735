// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/subject_priors.h"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/skeleton.h"

namespace marey::reconstruct {
namespace {

/// One tag on a segment of an average person.
BodyModel one_tag(HumanBone segment, const RigidTransform& segment_from_tag) {
  BodyModel model;
  const Proportions average = average_proportions(1.75);
  model.lengths = lengths_of(average);
  model.body = body_constants(average);
  model.tags = {{TagId{7}, segment, 0.08}};
  model.segment_from_tag[0] = segment_from_tag;
  return model;
}

/// Returns a tag on the front of the left shank, half way down: its normal points into
/// the soft tissue.
RigidTransform on_shank(double forward_m) {
  return {glm::angleAxis(glm::pi<double>(), glm::dvec3(0, 1, 0)),
          glm::dvec3(0.0, -0.2, forward_m)};
}

double off(HumanBone segment, const RigidTransform& segment_from_tag) {
  return off_soft_tissue(one_tag(segment, segment_from_tag), 0);
}

double cost_of(const BodyModel& model, SubjectSystem& system) {
  const SubjectColumns columns(model, false);
  system.hessian.setZero(columns.size(), columns.size());
  system.gradient.setZero(columns.size());
  system.cost = 0.0;
  add_subject_priors(model, lengths_of(average_proportions(1.75)), columns, system);
  return system.cost;
}

TEST(SubjectPriors, KeepTagsOnTheSkinOfLimbs) {
  const HumanBone shank = HumanBone::kLeftLowerLeg;
  EXPECT_EQ(off(shank, on_shank(0.05)), 0.0);
  EXPECT_EQ(off(shank, on_shank(0.10)), 0.0) << "a stout leg";
  EXPECT_GT(off(shank, on_shank(0.16)), 3.0) << "in the air";
  EXPECT_GT(off(shank, on_shank(-0.05)), 3.0) << "behind the bone, facing it";
  RigidTransform below = on_shank(0.05);
  below.translation.y = -0.7;
  EXPECT_GT(off(shank, below), 3.0) << "past the foot";
}

TEST(SubjectPriors, KeepHandsTagsNearTheHand) {
  const HumanBone hand = HumanBone::kLeftHand;
  EXPECT_EQ(off(hand, {{1, 0, 0, 0}, {0.09, 0.04, 0.0}}), 0.0);
  EXPECT_GT(off(hand, {{1, 0, 0, 0}, {0.09, 0.06, 0.12}}), 3.0);
}

TEST(SubjectPriors, HoldTheDistanceOfATagFromItsBoneSoftly) {
  SubjectSystem system;
  const double usual =
      cost_of(one_tag(HumanBone::kLeftLowerLeg, on_shank(0.062)), system);
  EXPECT_NEAR(cost_of(one_tag(HumanBone::kLeftLowerLeg, on_shank(0.084)), system) - usual,
              0.5,
              1e-6)
      << "one sigma";
}

// Compares central differences of the cost with the equations' gradient.
TEST(SubjectPriors, GiveTheGradientOfTheirCost) {
  const RigidTransform poses[] = {
      on_shank(0.05), on_shank(-0.03), on_shank(0.15), on_shank(0.01)};
  for (RigidTransform pose : poses) {
    // Tilted along the bone: the normal still meets the axis. Off the axis the sigma of
    // the facing term, which depends on the radius, is held.
    pose.rotation =
        glm::normalize(pose.rotation * rotation_from_vector(glm::dvec3(0.2, 0.0, 0.0)));
    const BodyModel model = one_tag(HumanBone::kLeftLowerLeg, pose);
    const SubjectColumns columns(model, false);
    SubjectSystem at;
    cost_of(model, at);
    for (int i = 0; i < 6; ++i) {
      constexpr double kStep = 1e-6;
      const auto moved = [&](double by) {
        BodyModel other = model;
        glm::dvec3 step(0.0);
        step[i % 3] = by;
        RigidTransform& own = other.segment_from_tag[0];
        if (i < 3) own.rotation = rotation_from_vector(step) * own.rotation;
        if (i >= 3) own.translation += step;
        SubjectSystem system;
        return cost_of(other, system);
      };
      const double slope = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
      EXPECT_NEAR(
          at.gradient[*columns.of_tag(0) + i], slope, 1e-3 * (1.0 + std::abs(slope)))
          << i;
    }
  }
}

}  // namespace
}  // namespace marey::reconstruct
