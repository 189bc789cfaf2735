// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tests/retarget/adapt/kernel/thesis_scene.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

// Positions in single precision over a leg of 0.85 m, and a chain of a dozen rotations.
constexpr double kSinglePrecision_m = 2e-6;

struct Standing {
  Character character = thesis_human();
  Pose reference = standing_pose(character);
  ConstraintSet set{{contact_of("leftHand", {}),
                     contact_of("rightHand", {}),
                     support_of("leftFoot"),
                     support_of("rightFoot")},
                    {}};

  glm::dvec3 at(const Pose& pose, const char* segment) const {
    return place_in_world(character, pose, segment);
  }
  /// Both hands have targets at `by` from their positions.
  void want(const glm::dvec3& left_by, const glm::dvec3& right_by) {
    set.constraints[0].goal = DistanceToPoint{0.0, at(reference, "leftHand") + left_by};
    set.constraints[1].goal = DistanceToPoint{0.0, at(reference, "rightHand") + right_by};
  }
  double worst_hand_m(const Pose& pose) const {
    double worst = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& goal = std::get<DistanceToPoint>(set.constraints[k].goal);
      worst = std::max(
          worst, glm::distance(goal.p_in_world, at(pose, k ? "rightHand" : "leftHand")));
    }
    return worst;
  }
  double worst_foot_m(const Pose& pose) const {
    return std::max(glm::distance(at(pose, "leftFoot"), at(reference, "leftFoot")),
                    glm::distance(at(pose, "rightFoot"), at(reference, "rightFoot")));
  }
};

// Table 4.1 has 2 iterations for near targets: the second finds no error, which is
// detected here at the end of the first.
TEST(ThesisAdapter, MeetsNearTargetsInOneIteration) {
  Standing scene;
  testing::Dice dice(21);
  for (int k = 0; k < 50; ++k) {
    scene.want(dice.between(0.05, 0.1) * dice.direction(),
               dice.between(0.05, 0.1) * dice.direction());
    // Arms that hang nearly straight reach up more than down.
    for (std::size_t c = 0; c < 2; ++c) {
      std::get<DistanceToPoint>(scene.set.constraints[c].goal).p_in_world.y += 0.12;
    }
    Adapter adapter = make_adapter(scene.character, scene.set, by_the_thesis());
    Pose out;
    const AdaptReport report = adapter.adapt(scene.reference, 0.0, out);
    EXPECT_EQ(report.iterations, 1);
    EXPECT_LT(scene.worst_hand_m(out), kSinglePrecision_m);
    EXPECT_LT(scene.worst_foot_m(out), kSinglePrecision_m);
    EXPECT_LT(glm::distance(out.root_in_world, scene.reference.root_in_world),
              kSinglePrecision_m);
  }
}

TEST(ThesisAdapter, ReachesFarTargetsWithTrunkAndRoot) {
  Standing scene;
  scene.want({0.1, 0.2, 0.75}, {0.0, 0.1, 0.7});
  Adapter adapter = make_adapter(scene.character, scene.set, by_the_thesis());
  Pose out;
  const AdaptReport report = adapter.adapt(scene.reference, 0.0, out);
  EXPECT_GT(report.iterations, 1);
  // A constraint's precision, where the loop stops.
  EXPECT_LT(scene.worst_hand_m(out), 1e-3);
  EXPECT_LT(scene.worst_foot_m(out), kSinglePrecision_m);
}

// Thesis 4.2.1: a standing leg follows the ground alone; once it is free it kneels.
TEST(ThesisAdapter, LeavesLegsThatStandAlone) {
  Standing scene;
  const glm::dvec3 knee = scene.at(scene.reference, "leftLowerLeg");
  scene.set.constraints[0] = contact_of("leftLowerLeg", knee + glm::dvec3(0.1, 0, 0));
  scene.set.constraints[1].activation.start_s = 100.0;
  AdaptOptions options = by_the_thesis();
  options.root_for_constraints = 0.0;
  for (const bool stands : {true, false}) {
    scene.set.constraints[2].activation.stop_s.reset();
    if (!stands) scene.set.constraints[2].activation.stop_s = -1.0;
    Adapter adapter = make_adapter(scene.character, scene.set, options);
    Pose out;
    static_cast<void>(adapter.adapt(scene.reference, 0.0, out));
    const double moved_m = glm::distance(scene.at(out, "leftLowerLeg"), knee);
    if (stands) {
      EXPECT_LT(moved_m, kSinglePrecision_m);
    } else {
      EXPECT_GT(moved_m, 0.05);
    }
  }
}

// Thesis 4.2.5: for any iteration at which it stops.
TEST(ThesisAdapter, NeverMakesAnErrorLargerByIteratingOn) {
  Standing scene;
  testing::Dice dice(4);
  for (int k = 0; k < 20; ++k) {
    scene.want(dice.between(0.3, 1.5) * dice.direction(),
               dice.between(0.3, 1.5) * dice.direction());
    for (const Control control : {Control::kPriority, Control::kBlend}) {
      double before_m = 1e9;
      for (int maximum = 1; maximum <= 20; ++maximum) {
        AdaptOptions options = by_the_thesis();
        options.control = control;
        options.max_iterations = maximum;
        Adapter adapter = make_adapter(scene.character, scene.set, options);
        Pose out;
        const AdaptReport report = adapter.adapt(scene.reference, 0.0, out);
        EXPECT_LE(report.iterations, maximum);
        EXPECT_LE(report.constraint_error_m, before_m + 1e-9);
        before_m = report.constraint_error_m;
      }
    }
  }
}

TEST(ThesisAdapter, SettlesOnTargetsThatAreOutOfReach) {
  Standing scene;
  testing::Dice dice(6);
  for (int k = 0; k < 30; ++k) {
    scene.want(dice.between(1.5, 2.5) * dice.direction(),
               dice.between(1.5, 2.5) * dice.direction());
    AdaptOptions options = by_the_thesis();
    options.constraint_threshold_m = 1e-3;
    Adapter adapter = make_adapter(scene.character, scene.set, options);
    Pose out;
    const AdaptReport report = adapter.adapt(scene.reference, 0.0, out);
    // Table 4.1: 24 iterations at this threshold.
    EXPECT_LT(report.iterations, 50);
    EXPECT_LT(scene.worst_foot_m(out), kSinglePrecision_m)
        << "supports are exact (4.2.4)";
    options.max_iterations = 500;
    options.constraint_threshold_m = 1e-6;
    Adapter patient = make_adapter(scene.character, scene.set, options);
    Pose best;
    const AdaptReport minimum = patient.adapt(scene.reference, 0.0, best);
    // Descent by groups has a long tail: improvements below the threshold, for hundreds
    // of iterations. The thesis reports 9 mm; its best was at 48 iterations.
    EXPECT_LT(report.constraint_error_m - minimum.constraint_error_m, 0.06);
  }
}

// Figures 4.10 and 4.11: the root moves by its share for constraints.
TEST(ThesisAdapter, MovesTheRootByItsShare) {
  Standing scene;
  scene.want({0.0, 0.2, 1.0}, {0.0, 0.2, 1.0});
  double before_m = -1.0;
  for (const double share : {0.0, 0.3, 1.0}) {
    AdaptOptions options = by_the_thesis();
    options.root_for_constraints = share;
    options.max_iterations = 3;
    Adapter adapter = make_adapter(scene.character, scene.set, options);
    Pose out;
    static_cast<void>(adapter.adapt(scene.reference, 0.0, out));
    const double moved_m = out.root_in_world.z - scene.reference.root_in_world.z;
    EXPECT_GT(moved_m, before_m + 1e-3 * (share > 0.0 ? 1.0 : 0.0));
    if (share == 0.0) {
      EXPECT_NEAR(moved_m, 0.0, kSinglePrecision_m);
    }
    before_m = moved_m;
  }
}

// Push-pull (5.3): the body keeps its balance for any distance of the hands' targets.
TEST(ThesisBalance, KeepsTheCentreOfMassWhileHandsReach) {
  Standing scene;
  const glm::dvec3 com = centre_of_mass_of(scene.character, scene.reference);
  testing::Dice dice(8);
  for (int k = 0; k < 40; ++k) {
    scene.want(dice.between(0.05, 1.5) * dice.direction(),
               dice.between(0.05, 1.5) * dice.direction());
    if (k % 2) scene.set.constraints[1].activation.start_s = 100.0;
    AdaptOptions options = by_the_thesis(BalanceMode::kHorizontal);
    options.root_for_balance = dice.between(0.0, 1.0);
    Adapter adapter = make_adapter(scene.character, scene.set, options);
    Pose out;
    static_cast<void>(adapter.adapt(scene.reference, 0.0, out));
    const glm::dvec3 left = centre_of_mass_of(scene.character, out) - com;
    EXPECT_LT(std::hypot(left.x, left.z), 1.1 * options.balance_precision_m);
    EXPECT_LT(scene.worst_foot_m(out), kSinglePrecision_m);
    scene.set.constraints[1].activation.start_s.reset();
  }
}

TEST(ThesisBalance, MeetsNearTargetsInAHandfulOfIterations) {
  Standing scene;
  scene.want({0.0, 0.2, 0.25}, {0.0, 0.2, 0.25});
  Adapter adapter =
      make_adapter(scene.character, scene.set, by_the_thesis(BalanceMode::kHorizontal));
  Pose out;
  const AdaptReport report = adapter.adapt(scene.reference, 0.0, out);
  // Table 5.2 has 5 for near targets.
  EXPECT_LE(report.iterations, 5);
  EXPECT_LT(scene.worst_hand_m(out), 1e-3);
}

// In flight the body rotates about its centre of mass: all three coordinates are met.
TEST(ThesisBalance, PutsTheCentreOfMassWhereItIsWantedInFlight) {
  const Character character = thesis_human();
  const Pose reference = standing_pose(character);
  const ConstraintSet set{{contact_of("leftHand",
                                      place_in_world(character, reference, "leftHand") +
                                          glm::dvec3(0.2, 0.4, 0.2))},
                          {}};
  Adapter adapter = make_adapter(character, set, by_the_thesis(BalanceMode::k3d));
  const glm::dvec3 wanted =
      centre_of_mass_of(character, reference) + glm::dvec3(0.1, 0.3, -0.2);
  adapter.set_balance_target(wanted);
  Pose out;
  static_cast<void>(adapter.adapt(reference, 0.0, out));
  EXPECT_LT(glm::distance(centre_of_mass_of(character, out), wanted), 1.1e-4);
}

// Without CnRoot the groups balance (figure 5.5b): the root moves by the remainder only.
TEST(ThesisBalance, UsesFreeGroupsBeforeTheRoot) {
  const Character character = thesis_human();
  const Pose reference = standing_pose(character);
  ConstraintSet set{{support_of("leftFoot"), support_of("rightFoot")}, {}};
  const glm::dvec3 wanted =
      centre_of_mass_of(character, reference) + glm::dvec3(0.0, 0.0, 0.02);
  double moved_m[2];
  for (const double share : {0.0, 1.0}) {
    AdaptOptions options = by_the_thesis(BalanceMode::kHorizontal);
    options.root_for_balance = share;
    Adapter adapter = make_adapter(character, set, options);
    adapter.set_balance_target(wanted);
    Pose out;
    static_cast<void>(adapter.adapt(reference, 0.0, out));
    moved_m[share > 0.5] = out.root_in_world.z - reference.root_in_world.z;
    EXPECT_NEAR(centre_of_mass_of(character, out).z, wanted.z, 1.1e-4);
  }
  EXPECT_LT(std::abs(moved_m[0]), 0.005);
  EXPECT_GT(moved_m[1], 0.015);
}

// Thesis 7.2.1: the heavier the load of the hand, the farther back the pelvis.
TEST(ThesisBalance, LeansBackUnderALoad) {
  const Character unloaded = thesis_human();
  const Pose reference = standing_pose(unloaded);
  ConstraintSet set{{contact_of("leftHand",
                                place_in_world(unloaded, reference, "leftHand") +
                                    glm::dvec3(0.0, 0.3, 0.3)),
                     support_of("leftFoot"),
                     support_of("rightFoot")},
                    {}};
  double before_m = 1e9;
  for (const double load_kg : {0.0, 5.0, 10.0}) {
    Character character = unloaded;
    character.loads[0].mass.mass_kg = load_kg;
    Adapter adapter =
        make_adapter(character, set, by_the_thesis(BalanceMode::kHorizontal));
    EXPECT_TRUE(adapter.carry("bag", true));
    adapter.set_balance_target(centre_of_mass_of(unloaded, reference));
    Pose out;
    static_cast<void>(adapter.adapt(reference, 0.0, out));
    const double pelvis_m = out.root_in_world.z;
    EXPECT_LT(pelvis_m, before_m - 0.01);
    before_m = pelvis_m;
  }
}

// The mean of two results: a constraint fades in with the thesis' method, too.
TEST(ThesisAdapter, FadesConstraintsIn) {
  Standing scene;
  scene.want({0.0, 0.2, 0.2}, {0.0, 0.2, 0.2});
  for (std::size_t c = 0; c < 2; ++c) {
    scene.set.constraints[c].activation = {0.0, std::nullopt, 1.0, 0.0};
  }
  Adapter adapter = make_adapter(scene.character, scene.set, by_the_thesis());
  Pose before;
  static_cast<void>(adapter.adapt(scene.reference, 0.0, before));
  for (int k = 1; k <= 100; ++k) {
    Pose out;
    static_cast<void>(adapter.adapt(scene.reference, 0.01 * k, out));
    const double step_m =
        glm::distance(scene.at(before, "leftHand"), scene.at(out, "leftHand"));
    // Fastest in the middle: 1.875 times 0.28 m per s, on an arc.
    EXPECT_LT(step_m, 0.01);
    before = out;
  }
  EXPECT_LT(scene.worst_hand_m(before), kSinglePrecision_m);
}

}  // namespace
}  // namespace marey::retarget
