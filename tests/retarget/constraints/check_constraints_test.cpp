// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/check_constraints.h"

#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/humanoid.h"

namespace marey::retarget {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

JointIndex joint(HumanBone bone) {
  return JointIndex{static_cast<int>(bone)};
}

/// A humanoid with a tail, which stands on its feet and not on its hands.
Character person() {
  Character character;
  character.skeleton = make_humanoid(average_proportions(1.75));
  Joint tail;
  tail.name = "tail_01";
  tail.parent = joint(HumanBone::kHips);
  character.skeleton.joints.push_back(tail);
  for (const HumanLimb& limb : human_limbs()) {
    BodyGroup group;
    group.can_support =
        limb.end == HumanBone::kLeftFoot || limb.end == HumanBone::kRightFoot;
    BodyPart part;
    part.kind = PartKind::kLimb;
    part.joints = {joint(limb.upper), joint(limb.lower), joint(limb.end)};
    group.parts = {part};
    character.groups.push_back(group);
  }
  return character;
}

Constraint constraint(const std::string& id, const std::string& segment, Goal goal) {
  Constraint c;
  c.id = id;
  c.point.segment = segment;
  c.goal = std::move(goal);
  return c;
}

/// One of every type, all valid; reach is the first, and stands the last.
ConstraintSet sound() {
  ConstraintSet set;
  set.constraints = {
      constraint("reach", "rightHand", DistanceToPoint{0.1, {0, 1, 1}}),
      constraint("clap", "leftHand", DistanceToBody{0.0, {"rightHand", {}}}),
      constraint("near", "head", DistanceToConstraint{0.2, "reach"}),
      constraint("above", "leftLowerArm", AllowedSpace{{-1, 0.7, -1}, {1, 2, 1}}),
      constraint("table", "leftLowerArm", ForbiddenSpace{{-1, 0, -1}, {1, 0.7, 1}}),
      constraint("tray", "leftHand", SegmentOrientation{}),
      constraint("wag", "tail_01", DistanceToPoint{0.0, {0, 1, -1}}),
      constraint("stands", "leftFoot", Support{}),
  };
  return set;
}

std::string message(const ConstraintSet& set) {
  const Status status = check_constraints(set, person());
  return status ? "no refusal" : status.error().message();
}

std::string refusal_of(const std::function<void(ConstraintSet&)>& change) {
  ConstraintSet set = sound();
  change(set);
  return message(set);
}

/// Returns the error for a changed first constraint, reach.
std::string reach_with(const std::function<void(Constraint&)>& change) {
  return refusal_of([&](ConstraintSet& set) { change(set.constraints[0]); });
}

std::string with_goal(const std::string& segment, Goal goal) {
  return refusal_of([&](ConstraintSet& set) {
    set.constraints.push_back(constraint("odd", segment, std::move(goal)));
  });
}

TEST(CheckConstraints, AcceptsOneOfEveryType) {
  EXPECT_EQ(message(sound()), "no refusal");
  EXPECT_EQ(message({}), "no refusal");
}

TEST(CheckConstraints, RefusesIdsThatAreEmptyOrTwice) {
  EXPECT_EQ(refusal_of([](ConstraintSet& set) { set.constraints[1].id = ""; }),
            "constraint 2, counted from 1: it has no id. Next: give it a unique id.");
  EXPECT_EQ(refusal_of([](ConstraintSet& set) { set.constraints[4].id = "above"; }),
            "constraint \"above\": another constraint has the same id. Next: rename or "
            "remove one.");
}

// A solve is cubic in their number: 3000 of them occupied a processor for hours.
TEST(CheckConstraints, RefusesMoreThanCanBeSolvedFor) {
  const auto wrong = [](int count, double apart_s) {
    ConstraintSet set;
    for (int i = 0; i < count; ++i) {
      Constraint c =
          constraint("c" + std::to_string(i), "head", DistanceToPoint{0.1, {0, 1, 1}});
      if (apart_s > 0.0) {
        c.activation.start_s = apart_s * i;
        c.activation.stop_s = apart_s * (i + 1);
      }
      set.constraints.push_back(std::move(c));
    }
    const Status ok = check_constraints(set, person());
    return ok ? std::string() : ok.error().message();
  };
  EXPECT_NE(wrong(3000, 0.0).find("there are 3000, but at most 1000"), std::string::npos);
  EXPECT_NE(wrong(3000, 0.1).find("split the constraints and the motion by time"),
            std::string::npos);
  EXPECT_NE(wrong(65, 0.0).find("more than 64 are active from the start on"),
            std::string::npos);
  EXPECT_EQ(wrong(64, 0.0), "");
  // Each starts when the previous one stops.
  EXPECT_EQ(wrong(900, 0.1), "");
}

TEST(CheckConstraints, OffersTheNearestSegment) {
  EXPECT_EQ(reach_with([](Constraint& c) { c.point.segment = "rigthHand"; }),
            "constraint \"reach\": the character has no segment \"rigthHand\". Next: "
            "perhaps you mean \"rightHand\".");
  EXPECT_EQ(
      reach_with([](Constraint& c) { c.point.segment = "tail_1"; }),
      "constraint \"reach\": the character has no segment \"tail_1\". Next: perhaps "
      "you mean \"tail_01\".");
  EXPECT_EQ(
      with_goal("head", DistanceToBody{0.0, {"leftHnad", {}}}),
      "constraint \"odd\": the character has no segment \"leftHnad\". Next: perhaps "
      "you mean \"leftHand\".");
}

TEST(CheckConstraints, RefusesNonFiniteNumbersInEveryField) {
  const std::string next =
      ". Next: correct what computes it: it must be a finite number.";
  EXPECT_EQ(reach_with([](Constraint& c) { c.point.offset_in_t_pose.y = kNan; }),
            "constraint \"reach\": a coordinate of the offset is nan" + next);
  EXPECT_EQ(reach_with([](Constraint& c) { c.importance = kInf; }),
            "constraint \"reach\": the importance is inf" + next);
  EXPECT_EQ(reach_with([](Constraint& c) { c.precision_m = kNan; }),
            "constraint \"reach\": the precision is nan" + next);
  EXPECT_EQ(reach_with([](Constraint& c) { c.activation.start_s = -kInf; }),
            "constraint \"reach\": the start is -inf" + next);
  EXPECT_EQ(reach_with([](Constraint& c) { c.activation.stop_s = kNan; }),
            "constraint \"reach\": the stop is nan" + next);
  EXPECT_EQ(reach_with([](Constraint& c) { c.activation.start_duration_s = kNan; }),
            "constraint \"reach\": the start duration is nan" + next);
  EXPECT_EQ(reach_with([](Constraint& c) { c.activation.stop_duration_s = kInf; }),
            "constraint \"reach\": the stop duration is inf" + next);
  for (const Goal& goal : {Goal(DistanceToPoint{kNan, {}}),
                           Goal(DistanceToPoint{0.0, {0, kInf, 0}}),
                           Goal(DistanceToBody{kNan, {"leftHand", {}}}),
                           Goal(DistanceToBody{0.0, {"leftHand", {kNan, 0, 0}}}),
                           Goal(DistanceToConstraint{kInf, "reach"}),
                           Goal(AllowedSpace{{kNan, 0, 0}, {1, 1, 1}}),
                           Goal(ForbiddenSpace{{0, 0, 0}, {1, kInf, 1}}),
                           Goal(SegmentOrientation{{kNan, 0, 0, 0}}),
                           Goal(Support{glm::dvec3(0, 0, kNan), {}}),
                           Goal(Support{{}, glm::dquat(kNan, 0, 0, 0)})}) {
    const std::string said = with_goal("rightFoot", goal);
    EXPECT_TRUE(said.starts_with("constraint \"odd\": ")) << goal.index() << said;
  }
}

TEST(CheckConstraints, RefusesNumbersOutOfRange) {
  EXPECT_EQ(reach_with([](Constraint& c) { c.importance = 0.0; }),
            "constraint \"reach\": the importance is 0. Next: use a value from 1e-06 to "
            "1e+06.");
  EXPECT_EQ(reach_with([](Constraint& c) { c.precision_m = -0.001; }),
            "constraint \"reach\": the precision is -0.001. Next: use a value from 0 to "
            "10000.");
  EXPECT_EQ(reach_with([](Constraint& c) { c.range = 0; }),
            "constraint \"reach\": its range is 0. Next: use 1 for its own segment, "
            "or more to include segments above it.");
  EXPECT_EQ(reach_with([](Constraint& c) { c.activation.stop_duration_s = -1.0; }),
            "constraint \"reach\": the stop duration is -1. Next: use a value from 0 to "
            "1e+09.");
  EXPECT_EQ(reach_with([](Constraint& c) {
              c.activation = {2.0, 1.5, 0.0, 0.0};
            }),
            "constraint \"reach\": it stops at 1.5 s, before it starts at 2 s. Next: "
            "exchange the two.");
  EXPECT_EQ(
      with_goal("head", DistanceToPoint{-0.1, {}}),
      "constraint \"odd\": the distance is -0.1. Next: use a value from 0 to 10000.");
  EXPECT_EQ(with_goal("head", DistanceToPoint{0.0, {0, 0, 1e30}}),
            "constraint \"odd\": a coordinate of the target is 1e+30. Next: give it in "
            "metres; the maximum is 10 km.");
  EXPECT_EQ(
      with_goal("head", AllowedSpace{{0, 2, 0}, {1, 1, 1}}),
      "constraint \"odd\": the box has its min above its max in y. Next: exchange 2 "
      "and 1.");
  EXPECT_EQ(with_goal("head", SegmentOrientation{{2, 0, 0, 0}}),
            "constraint \"odd\": the orientation is a quaternion of length 2. Next: "
            "divide it by its length, which must be 1.");
}

TEST(CheckConstraints, AcceptsTheEndsOfTheRanges) {
  EXPECT_EQ(reach_with([](Constraint& c) {
              c.importance = 1e-6;
              c.precision_m = 0.0;
              c.range = 1;
              c.activation = {1.5, 1.5, 0.0, 0.0};
            }),
            "no refusal");
  EXPECT_EQ(with_goal("head", AllowedSpace{{1, 1, 1}, {1, 1, 1}}), "no refusal");
}

TEST(CheckConstraints, RefusesDistancesToConstraintsThatLeadNowhere) {
  EXPECT_EQ(
      with_goal("head", DistanceToConstraint{0.0, "odd"}),
      "constraint \"odd\": it should keep a distance from itself. Next: name another "
      "constraint, or a point of the body.");
  EXPECT_EQ(
      with_goal("head", DistanceToConstraint{0.0, "raech"}),
      "constraint \"odd\": there is no constraint \"raech\" to keep a distance from. "
      "Next: perhaps you mean \"reach\".");
  EXPECT_EQ(
      with_goal("rightHand", DistanceToConstraint{0.0, "reach"}),
      "constraint \"odd\": its point and the one to keep a distance from are both of "
      "\"rightHand\", and no posture changes it. Next: name a point of another "
      "segment.");
}

TEST(CheckConstraints, NamesTheCycleOfDistances) {
  const auto said = refusal_of([](ConstraintSet& set) {
    // "near" leads to the cycle and is not part of it.
    set.constraints[0].goal = DistanceToConstraint{0.0, "clap"};
    set.constraints[1].goal = DistanceToConstraint{0.0, "tray2"};
    set.constraints.push_back(
        constraint("tray2", "rightFoot", DistanceToConstraint{0.0, "reach"}));
    std::swap(set.constraints[0], set.constraints[2]);
  });
  EXPECT_EQ(said,
            "constraint \"reach\": the distances form a cycle: \"reach\" to \"clap\" "
            "to \"tray2\" to \"reach\". Next: let one of them keep its distance from a "
            "point of the body.");
}

TEST(CheckConstraints, AcceptsAChainOfDistances) {
  EXPECT_EQ(refusal_of([](ConstraintSet& set) {
              set.constraints.push_back(
                  constraint("a", "leftFoot", DistanceToConstraint{0.1, "near"}));
              set.constraints.push_back(
                  constraint("b", "rightFoot", DistanceToConstraint{0.1, "near"}));
            }),
            "no refusal");
}

TEST(CheckConstraints, RefusesAllowedBoxesWithoutACommonPoint) {
  const AllowedSpace below{{-1, 0, -1}, {1, 0.6, 1}};
  EXPECT_EQ(
      with_goal("leftLowerArm", below),
      "constraint \"odd\": it contradicts \"above\" on the same point: their allowed "
      "boxes have no point in common. Next: change one of them, or let one stop "
      "before the other starts.");
  EXPECT_EQ(with_goal("rightLowerArm", below), "no refusal");
  // They touch.
  EXPECT_EQ(with_goal("leftLowerArm", AllowedSpace{{-1, 0, -1}, {1, 0.7, 1}}),
            "no refusal");
}

TEST(CheckConstraints, LooksAtBoxesOnlyWhileBothAreFullyActive) {
  const auto said = [](const Activation& of_above, const Activation& of_odd) {
    return refusal_of([&](ConstraintSet& set) {
      set.constraints[3].activation = of_above;
      set.constraints.push_back(
          constraint("odd", "leftLowerArm", AllowedSpace{{-1, 0, -1}, {1, 0.6, 1}}));
      set.constraints.back().activation = of_odd;
    });
  };
  const Activation until_2{std::nullopt, 2.0, 0.0, 0.5};
  EXPECT_EQ(said(until_2, {2.0, std::nullopt, 0.5, 0.0}), "no refusal");
  EXPECT_EQ(said(until_2, {1.8, std::nullopt, 0.5, 0.0}), "no refusal");
  EXPECT_NE(said(until_2, {1.8, std::nullopt, 0.1, 0.0}), "no refusal");
  EXPECT_NE(said(until_2, {0.0, 1.0, 0.1, 0.0}), "no refusal");
}

TEST(CheckConstraints, RefusesAnAllowedBoxInsideAForbiddenOne) {
  const std::string said =
      with_goal("leftLowerArm", ForbiddenSpace{{-2, 0, -2}, {2, 3, 2}});
  EXPECT_EQ(said,
            "constraint \"above\": it contradicts \"odd\" on the same point: its allowed "
            "box lies inside the other's forbidden one. Next: change one of them, or let "
            "one stop before the other starts.");
  // The faces are permitted.
  EXPECT_EQ(with_goal("leftLowerArm", ForbiddenSpace{{-2, 0, -2}, {2, 2, 2}}),
            "no refusal");
}

TEST(CheckConstraints, RefusesSupportsThatAreNoFeet) {
  EXPECT_EQ(with_goal("leftHand", Support{}),
            "constraint \"odd\": a support stands on the end of a limb, and \"leftHand\" "
            "is not one that can support. Next: choose one of \"leftFoot\", "
            "\"rightFoot\".");
  EXPECT_NE(with_goal("rightLowerLeg", Support{}), "no refusal");
  EXPECT_EQ(with_goal("rightFoot", Support{}), "no refusal");
}

TEST(CheckConstraints, RefusesAFootOnTwoFootprints) {
  const auto said = [](const glm::dvec3& second) {
    return refusal_of([&](ConstraintSet& set) {
      set.constraints.back().goal = Support{glm::dvec3(0.1, 0.08, 0), {}};
      set.constraints.push_back(constraint("odd", "leftFoot", Support{second, {}}));
    });
  };
  EXPECT_NE(said({0.2, 0.08, 0}).find("a foot cannot stand on two footprints"),
            std::string::npos);
  EXPECT_EQ(said({0.1, 0.08, 0}), "no refusal");
}

/// Returns the error for two supports of the left foot: "stands" on the ankle, and "odd"
/// on a point 0.1 m from it.
std::string on_ball(const glm::dvec3& second, const Activation& of_second = {}) {
  return refusal_of([&](ConstraintSet& set) {
    set.constraints.back().goal = Support{glm::dvec3(0.1, 0.08, 0), {}};
    Constraint ball = constraint("odd", "leftFoot", Support{second, {}});
    ball.point.offset_in_t_pose = {0, -0.06, 0.08};
    ball.activation = of_second;
    set.constraints.push_back(ball);
  });
}

TEST(CheckConstraints, RefusesFootprintsThatNoFootIsLongEnoughFor) {
  EXPECT_EQ(
      on_ball({0.1, 0.08, 0.3}),
      "constraint \"odd\": it contradicts \"stands\" on the same foot: their points "
      "are 0.1 m apart and their footprints 0.3 m. Next: change one of them, or let "
      "one stop before the other starts.");
  EXPECT_NE(on_ball({0.1, 0.08, 0.05}), "no refusal");
  // For any rotation of the foot, within both precisions.
  EXPECT_EQ(on_ball({0.1, 0.08, 0.1}), "no refusal");
  EXPECT_EQ(on_ball({0.1, 0.08, 0.1019}), "no refusal");
  // A caller that starts it may place it, too.
  EXPECT_EQ(on_ball({0.1, 0.08, 0.3}, {1e8, std::nullopt, 0.0, 0.0}), "no refusal");
}

TEST(CheckConstraints, RefusesAFootprintWhereItsPointMustNotBe) {
  const auto said = [](Goal space, const Activation& of_support) {
    return refusal_of([&](ConstraintSet& set) {
      set.constraints.back().goal = Support{glm::dvec3(0.1, 0.08, 0), {}};
      set.constraints.back().activation = of_support;
      set.constraints.push_back(constraint("odd", "leftFoot", std::move(space)));
    });
  };
  EXPECT_EQ(
      said(ForbiddenSpace{{0, 0, -1}, {1, 1, 1}}, {}),
      "constraint \"stands\": it contradicts \"odd\" on the same point: its footprint "
      "lies inside the other's forbidden box. Next: change one of them, or let one stop "
      "before the other starts.");
  EXPECT_EQ(said(ForbiddenSpace{{0.099, 0, -1}, {1, 1, 1}}, {}), "no refusal");
  EXPECT_EQ(said(ForbiddenSpace{{0, 0, -1}, {1, 1, 1}}, {1e8, std::nullopt, 0.0, 0.0}),
            "no refusal");
  EXPECT_NE(said(AllowedSpace{{0.2, 0, -1}, {1, 1, 1}}, {})
                .find("its footprint lies outside the other's allowed box"),
            std::string::npos);
  EXPECT_EQ(said(AllowedSpace{{0.1, 0, -1}, {1, 1, 1}}, {}), "no refusal");
}

TEST(CheckConstraints, RefusesTwoDistancesBetweenTheSameTwoPoints) {
  // clap keeps the hands together, from the other side.
  EXPECT_EQ(
      with_goal("rightHand", DistanceToBody{0.3, {"leftHand", {}}}),
      "constraint \"odd\": it contradicts \"clap\" on the same two points: it keeps "
      "0.3 m between them and the other 0 m. Next: change one of them, or let one "
      "stop before the other starts.");
  // near keeps the head from reach's point, which is the right hand.
  EXPECT_NE(with_goal("head", DistanceToBody{0.3, {"rightHand", {}}})
                .find("it contradicts \"near\""),
            std::string::npos);
  EXPECT_EQ(with_goal("head", DistanceToBody{0.2, {"rightHand", {}}}), "no refusal");
  EXPECT_EQ(with_goal("rightHand", DistanceToBody{0.002, {"leftHand", {}}}),
            "no refusal");
  EXPECT_EQ(with_goal("rightHand", DistanceToBody{0.3, {"leftHand", {0, 0, 0.1}}}),
            "no refusal");
}

}  // namespace
}  // namespace marey::retarget
