// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/plan_body.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calib/plan/plan_calibration.h"
#include "calib/plan/posture_chain.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::Dice;
using marey::testing::ring_of_cameras;
using marey::testing::webcam_at;

double tenth_px(double /*side_px*/) {
  return 0.1;
}

const ErrorMapGrid kSmall{{-0.5, 0.0, -0.5}, {0.5, 0.0, 0.5}, 0.25, {}};

PlanBodyOptions quick() {
  PlanBodyOptions options;
  options.headings = 3;
  options.strides = 1;
  options.step_m = 1.0;
  return options;
}

TEST(DressBody, WearsTagsOffItsSkinFacingOut) {
  const PlannedBody body = make_planned_body(1.75, typical_tags(0.08));
  ASSERT_EQ(body.tags.size(), 29U);
  const BodyPlace place = standing_body(body, {0.3, -0.2}, 1.0);
  const auto soft_tissue = soft_tissue_of(body, place);
  for (const PlacedTag& tag : body.tags) {
    const RigidTransform world_from_tag =
        place[index(tag.tag.segment)] * tag.segment_from_tag;
    const glm::dvec3 out = world_from_tag.rotation * glm::dvec3(0.0, 0.0, -1.0);
    // From a metre in front, the tag is visible; from behind, the body hides it.
    const glm::dvec3 centre = world_from_tag.translation;
    EXPECT_FALSE(is_hidden(centre, centre + out, soft_tissue)) << number(tag.tag.id);
    EXPECT_TRUE(is_hidden(centre, centre - out, soft_tissue)) << number(tag.tag.id);
  }
}

TEST(DressBody, OmitsTagsWithoutRoomOnTheirSegment) {
  std::vector<TagOnSegment> tags(9, {TagId{1}, HumanBone::kHips, 0.08});
  tags.push_back({TagId{2}, HumanBone::kSpine, 0.08});
  EXPECT_EQ(make_planned_body(1.75, tags).tags.size(), 4U);
}

TEST(StandingBody, HasItsFeetOnTheFloor) {
  const PlannedBody body = make_planned_body(1.75, {});
  const BodyPlace place = standing_body(body, {2.0, 3.0}, 0.5);
  const glm::dvec3 toes = place[index(HumanBone::kLeftToes)].translation;
  EXPECT_NEAR(toes.y, 0.012 * 1.75, 1e-9);
  EXPECT_NEAR(place[index(HumanBone::kHips)].translation.x, 2.0, 1e-12);
}

TEST(SolveChain, IsTheInverseOfTheWholeNormalMatrix) {
  constexpr int kFrames = 4;
  constexpr int kShared = 3;
  constexpr int kN = kPostureColumns;
  Dice dice(3);
  const StepPrior steps = step_prior({30.0});
  std::vector<FrameInformation> frames(kFrames);
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(kFrames * kN, kFrames * kN);
  Eigen::MatrixXd right(kFrames * kN, kShared);
  for (int f = 0; f < kFrames; ++f) {
    FrameInformation& frame = frames[static_cast<std::size_t>(f)];
    const Eigen::MatrixXd rows =
        Eigen::MatrixXd::NullaryExpr(kN, kN, [&] { return dice.noise(30.0); });
    frame.posture = rows.transpose() * rows + 100.0 * PostureMatrix::Identity();
    frame.coupling =
        Eigen::MatrixXd::NullaryExpr(kN, kShared, [&] { return dice.noise(30.0); });
    whole.block(f * kN, f * kN, kN, kN) += frame.posture;
    right.middleRows(f * kN, kN) = frame.coupling;
  }
  for (int i = 0; i < kN; ++i) {
    const auto add = [&](std::initializer_list<double> row, int first, double sigma) {
      Eigen::RowVectorXd full = Eigen::RowVectorXd::Zero(kFrames * kN);
      int f = first;
      for (const double value : row) full[kN * f++ + i] = value / sigma;
      whole += full.transpose() * full;
    };
    const double k = steps.correlation[i];
    add({-1.0, 1.0}, 0, steps.sigma[i] / std::sqrt(1.0 - k * k));
    for (int f = 2; f < kFrames; ++f) add({k, -1.0 - k, 1.0}, f - 2, steps.sigma[i]);
  }
  const Eigen::MatrixXd inverse = whole.inverse();
  const Eigen::MatrixXd follows = -inverse * right;
  const auto uncertainties = solve_chain(frames, steps);
  ASSERT_EQ(uncertainties.size(), 4U);
  for (int f = 0; f < kFrames; ++f) {
    const PostureUncertainty& uncertainty = uncertainties[static_cast<std::size_t>(f)];
    const Eigen::MatrixXd block = inverse.block(f * kN, f * kN, kN, kN);
    EXPECT_LT((uncertainty.covariance - block).norm(), 1e-8 * block.norm());
    const Eigen::MatrixXd shift = follows.middleRows(f * kN, kN);
    EXPECT_LT((uncertainty.by_shared - shift).norm(), 1e-8 * shift.norm());
  }
}

TEST(PlanBody, ErrsLessWithMoreCameras) {
  const PlannedBody body = make_planned_body(1.75, typical_tags(0.1));
  const std::vector<Camera> four = ring_of_cameras();
  const std::vector<Camera> two(four.begin(), four.begin() + 2);
  const BodyPlan by_four = plan_body(four, nullptr, body, kSmall, tenth_px, quick());
  const BodyPlan by_two = plan_body(two, nullptr, body, kSmall, tenth_px, quick());
  ASSERT_EQ(by_four.joints.size(), 12U);
  EXPECT_EQ(by_four.stands.size(), 4U);
  EXPECT_LT(by_four.error_m.median, by_two.error_m.median);
  EXPECT_GT(by_four.measured_share, by_two.measured_share);
  // A tenth of a pixel at 3 m and 900 px is a third of a millimetre; a lever increases
  // the error to several times that, the posture prior reduces it.
  EXPECT_GT(by_four.error_m.median, 0.5e-3);
  EXPECT_LT(by_four.error_m.median, 2e-3);
  EXPECT_LT(by_four.error_m.p95, 2e-2);
}

TEST(PlanBody, IsOfTheSameWalkAtAnyRate) {
  const PlannedBody body = make_planned_body(1.75, typical_tags(0.1));
  const std::vector<Camera> cameras = ring_of_cameras();
  PlanBodyOptions options = quick();
  const BodyPlan at_30 = plan_body(cameras, nullptr, body, kSmall, tenth_px, options);
  for (const double rate_hz : {13.0, 60.0}) {
    options.rate_hz = rate_hz;
    const BodyPlan plan = plan_body(cameras, nullptr, body, kSmall, tenth_px, options);
    // The same walk is seen, in more or fewer frames.
    EXPECT_NEAR(plan.views_share, at_30.views_share, 0.03) << rate_hz;
    EXPECT_NEAR(plan.measured_share, at_30.measured_share, 0.05) << rate_hz;
  }
}

TEST(PlanBody, IncludesTheUncertaintyOfCameras) {
  const PlannedBody body = make_planned_body(1.75, typical_tags(0.1));
  const std::vector<Camera> cameras = ring_of_cameras();
  RigCovariance uncertainty{4, std::vector<double>(16 * 18 * 18, 0.0)};
  // All centres have a common error of a centimetre along each axis; the body has the
  // same error.
  for (std::size_t axis = 15; axis < 18; ++axis) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        uncertainty.values[(18 * a + axis) * uncertainty.size() + 18 * b + axis] = 1e-4;
      }
    }
  }
  const BodyPlan plan = plan_body(cameras, &uncertainty, body, kSmall, tenth_px, quick());
  ASSERT_EQ(plan.joints.size(), 12U);
  // The hips' own part is far smaller; the direction of gravity while standing and moving
  // does not depend on the cameras.
  EXPECT_NEAR(plan.joints[6].lasting_error_m, std::sqrt(3e-4), 1e-3);
}

TEST(PlanBody, ReportsNoErrorsWhenNoCameraSeesTheBody) {
  const PlannedBody body = make_planned_body(1.75, typical_tags(0.01));
  const std::vector<Camera> cameras = ring_of_cameras();
  const BodyPlan plan = plan_body(cameras, nullptr, body, kSmall, tenth_px, quick());
  EXPECT_TRUE(plan.joints.empty());
  EXPECT_EQ(plan.found_share, 0.0);
  for (const PlannedStand& stand : plan.stands) EXPECT_FALSE(stand.error_m);
}

TEST(PlanCalibration, IsOfMillimetresAndScalesToACalibration) {
  const std::vector<Camera> cameras = ring_of_cameras();
  const ErrorMapGrid room;
  auto uncertainty = plan_calibration(cameras, room, AprilGrid{}, tenth_px, {});
  ASSERT_TRUE(uncertainty) << uncertainty.error().message();
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    EXPECT_GT(centre_sigma_m(*uncertainty, c), 1e-4);
    EXPECT_LT(centre_sigma_m(*uncertainty, c), 3e-3);
  }
  const double other_m = centre_sigma_m(*uncertainty, 1);
  std::vector<CameraQuality> quality(4);
  quality[0].centre_sigma_m = 0.004;
  fit_to_quality(quality, *uncertainty);
  EXPECT_NEAR(centre_sigma_m(*uncertainty, 0), 0.004, 1e-9);
  EXPECT_NEAR(centre_sigma_m(*uncertainty, 1), other_m, 1e-12);
}

TEST(PlanBody, MeasuresLimbsOfABodyThatIsNotFound) {
  // Tags on the wrists alone: no camera finds the trunk.
  const std::vector<TagOnSegment> wrists{{TagId{0}, HumanBone::kLeftHand, 0.1},
                                         {TagId{1}, HumanBone::kRightHand, 0.1}};
  const BodyPlan plan = plan_body(ring_of_cameras(),
                                  nullptr,
                                  make_planned_body(1.75, wrists),
                                  kSmall,
                                  tenth_px,
                                  quick());
  EXPECT_TRUE(plan.joints.empty());
  EXPECT_EQ(plan.found_share, 0.0);
  EXPECT_GT(plan.measured_share, 0.02);
  EXPECT_LE(plan.measured_share, 2.0 / 12.0);
}

TEST(CovarianceOfQuality, ContainsOnlyTheSigmasOfTheQuality) {
  std::vector<CameraQuality> quality(2);
  quality[1].centre_sigma_m = 0.003;
  quality[1].focal_sigma_px = 2.0;
  const RigCovariance uncertainty = covariance_of_quality(quality);
  ASSERT_EQ(uncertainty.size(), 36U);
  EXPECT_EQ(centre_sigma_m(uncertainty, 0), 0.0);
  EXPECT_NEAR(centre_sigma_m(uncertainty, 1), 0.003, 1e-15);
  EXPECT_EQ(uncertainty.at(18, 18), 4.0);
  EXPECT_EQ(uncertainty.at(19, 19), 4.0);
  double sum = 0.0;
  for (const double value : uncertainty.values) sum += value;
  EXPECT_NEAR(sum, 8.0 + 3 * 9e-6, 1e-12);
}

TEST(PlanCalibration, FailsWhereCamerasShareNothing) {
  const std::vector<Camera> apart{webcam_at("a", {0.0, 1.5, 3.0}, {0.0, 1.0, 0.0}),
                                  webcam_at("b", {0.0, 1.5, 40.0}, {0.0, 1.0, 80.0})};
  const auto uncertainty =
      plan_calibration(apart, ErrorMapGrid{}, AprilGrid{}, tenth_px, {});
  ASSERT_FALSE(uncertainty);
  EXPECT_EQ(uncertainty.error().next,
            "bring camera b nearer to the volume, turn it there, or give it more pixels");
}

}  // namespace
}  // namespace marey::calib
