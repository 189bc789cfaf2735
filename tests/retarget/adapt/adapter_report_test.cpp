// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// Compares the reports of the adapter with its postures.
namespace marey::retarget {
namespace {

class AdapterReport : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterReport, both_methods(), name_of);

// Single precision, 2 m from the root.
constexpr double kFloat_m = 2e-6;

Constraint orientation_of(const std::string& segment, const glm::dquat& wanted) {
  Constraint out;
  out.id = segment;
  out.point.segment = segment;
  out.goal = SegmentOrientation{wanted};
  return out;
}

Constraint off_by(const Character& body,
                  const Pose& reference,
                  const std::string& segment,
                  const glm::dvec3& way,
                  double importance = 1.0) {
  return contact(segment,
                 segment,
                 place_of(body, reference, {segment}) + way,
                 glm::dvec3(0.0),
                 importance);
}

// A head alone may rotate by 95 degrees, not by 160.
TEST_P(AdapterReport, OrientationsAreOffByAngles) {
  const Character body = human(true);
  const Pose reference = waiting(body);
  Constraint head = orientation_of("head", glm::angleAxis(2.8, glm::dvec3(0, 1, 0)));
  head.range = 1;
  const Constraint hand =
      orientation_of("leftHand", glm::angleAxis(0.2, glm::dvec3(1, 0, 0)));
  Adapter adapter = make_adapter(body, {{head, hand}, {}}, options());
  Pose out;
  const AdaptReport report = adapter.adapt(reference, 0.0, out);
  double worst_rad = 0.0;
  for (const Constraint& wish : {head, hand}) {
    const glm::dquat wanted = std::get<SegmentOrientation>(wish.goal).world_from_t_pose;
    const double error_rad =
        angle_between_rad(rotation_of(body, out, wish.point.segment), wanted);
    const ConstraintOutcome& outcome = adapter.constraint(wish.id)->outcome();
    EXPECT_EQ(outcome.error_m, 0.0) << wish.id << ": an angle is no length";
    EXPECT_NEAR(outcome.error_rad, error_rad, 1e-5) << wish.id;
    // 1 mm at 100 mm from the joint.
    EXPECT_EQ(outcome.met, error_rad < 0.01) << wish.id << ", " << error_rad;
    worst_rad = std::max(worst_rad, error_rad);
  }
  EXPECT_GT(worst_rad, 0.5) << "the neck's limits";
  EXPECT_NEAR(report.worst_error_rad, worst_rad, 1e-5);
  EXPECT_EQ(report.worst_error_m, 0.0);
  EXPECT_EQ(report.constraint_error_m, 0.0);
}

// Equation 4.2 covers constraints; supports are not included, and orientations have no
// length.
TEST_P(AdapterReport, TheMeanIsOfConstraintsByImportance) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  const Constraint left = off_by(body, reference, "leftHand", {1.5, 0.2, 0.3}, 3.0);
  const Constraint right = off_by(body, reference, "rightHand", {-1.5, 0.2, 0.3}, 1.0);
  for (const Control control : {Control::kPriority, Control::kBlend}) {
    AdaptOptions wanted = options();
    wanted.control = control;
    Adapter adapter = make_adapter(body,
                                   {{left,
                                     right,
                                     standing("stands", "leftFoot"),
                                     orientation_of("head", glm::dquat(1, 0, 0, 0))},
                                    {}},
                                   wanted);
    Pose out;
    const AdaptReport report = adapter.adapt(reference, 0.0, out);
    const double left_m = target_distance_m(body, out, left);
    const double right_m = target_distance_m(body, out, right);
    ASSERT_GT(left_m + right_m, 0.1) << "nothing is asked";
    EXPECT_NEAR(report.constraint_error_m, (3.0 * left_m + right_m) / 4.0, kFloat_m);
    EXPECT_NEAR(report.worst_error_m, std::max(left_m, right_m), kFloat_m);
    EXPECT_FALSE(adapter.constraint("rightHand")->outcome().met);
    EXPECT_TRUE(adapter.constraint("stands")->outcome().met);
  }
}

TEST_P(AdapterReport, ReportsWhetherTheCapEndedTheSolve) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  const ConstraintSet near{{off_by(body, reference, "leftHand", {0, 0.1, 0.1})}, {}};
  const ConstraintSet far{{off_by(body, reference, "leftHand", {0.6, 0.9, 0.9}),
                           off_by(body, reference, "rightHand", {-0.9, 0.6, 0.9})},
                          {}};
  AdaptOptions wanted = options();
  EXPECT_FALSE(adapted(body, near, reference, wanted).report.capped);
  wanted.max_iterations = 1000;
  const AdaptReport whole = adapted(body, far, reference, wanted).report;
  EXPECT_FALSE(whole.capped);
  ASSERT_GT(whole.iterations, 6) << "the cap below must be one";
  // Exactly the needed number is not capped; one less is.
  wanted.max_iterations = whole.iterations;
  EXPECT_FALSE(adapted(body, far, reference, wanted).report.capped);
  wanted.max_iterations = 5;
  EXPECT_TRUE(adapted(body, far, reference, wanted).report.capped);
}

// Each of two solves may be below the cap and their sum above it, and the reverse.
TEST_P(AdapterReport, ReportsWhetherTheCapEndedAnySolveWhileFading) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  ConstraintSet asked{{off_by(body, reference, "leftHand", {0.3, 0.5, 0.6}),
                       off_by(body, reference, "rightHand", {-0.3, 0.5, 0.6})},
                      {}};
  AdaptOptions wanted = options();
  wanted.max_iterations = 1000;
  const int alone = adapted(body, asked, reference, wanted).report.iterations;
  ASSERT_GT(alone, kFirstSteps);
  asked.constraints[1].activation = {0.0, {}, 1.0, 0.0};
  Pose out;
  const auto half_way = [&] {
    Adapter adapter = make_adapter(body, asked, wanted);
    return adapter.adapt(reference, 0.5, out);
  };
  const AdaptReport both = half_way();
  ASSERT_GT(both.iterations, alone);
  wanted.max_iterations = both.iterations - 1;
  EXPECT_FALSE(half_way().capped) << "the sum of two is not what is capped";
  wanted.max_iterations = alone - 1;
  EXPECT_TRUE(half_way().capped);
}

// During a fade a constraint has an error above kFirmActivation, and none at or below it.
TEST_P(AdapterReport, ConstraintsHaveErrorsAboveTheFirmActivationAlone) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Constraint hand = off_by(body, reference, "leftHand", {0, 0.1, 0.1});
  hand.activation = {0.0, {}, 1.0, 0.0};
  Adapter adapter = make_adapter(body, {{hand}, {}}, options());
  Pose out;
  int hardly = 0;
  int firmly = 0;
  for (double time_s = 0.5; time_s < 1.0; time_s += 0.004) {
    static_cast<void>(adapter.adapt(reference, time_s, out));
    const ConstraintOutcome& outcome = adapter.constraint("leftHand")->outcome();
    if (outcome.activation <= kFirmActivation) {
      ++hardly;
      EXPECT_EQ(outcome.error_m, 0.0) << outcome.activation;
      EXPECT_FALSE(outcome.met) << outcome.activation;
    } else {
      ++firmly;
      EXPECT_NEAR(outcome.error_m, target_distance_m(body, out, hand), kFloat_m);
      EXPECT_EQ(outcome.met, outcome.error_m < hand.precision_m + 2e-5);
    }
  }
  EXPECT_GT(hardly, 10);
  EXPECT_GT(firmly, 10);
}

TEST(AdapterFirstSteps, AreNeverCutShort) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  const ConstraintSet far{{off_by(body, reference, "leftHand", {2.0, 2.0, 1.5})}, {}};
  for (const BalanceMode balance : {BalanceMode::kOff, BalanceMode::kHorizontal}) {
    AdaptOptions wanted;
    wanted.balance = balance;
    const int first = balance == BalanceMode::kOff ? kFirstSteps : kFirstStepsBalanced;
    wanted.max_iterations = first;
    const Adapted as_many = adapted(body, far, reference, wanted);
    wanted.max_iterations = 1;
    const Adapted one = adapted(body, far, reference, wanted);
    EXPECT_EQ(one.report.iterations, first);
    EXPECT_TRUE(one.report.capped);
    EXPECT_TRUE(same_bits(one.pose, as_many.pose));
  }
}

TEST_P(AdapterReport, KnowsTheCentreOfMassWithoutBalance) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Adapter adapter = make_adapter(
      body, {{off_by(body, reference, "leftHand", {0.3, 0.5, 0.6})}, {}}, options());
  Pose out;
  static_cast<void>(adapter.adapt(reference, 0.0, out));
  EXPECT_LT(glm::distance(adapter.centre_of_mass_in_world(), centre_of_mass(body, out)),
            kFloat_m);
  ASSERT_TRUE(adapter.carry("bag", true));
  static_cast<void>(adapter.adapt(reference, 0.0, out));
  EXPECT_LT(
      glm::distance(adapter.centre_of_mass_in_world(), centre_of_mass(body, out, true)),
      kFloat_m);
}

}  // namespace
}  // namespace marey::retarget
