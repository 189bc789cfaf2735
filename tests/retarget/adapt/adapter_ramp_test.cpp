// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// Constraints fade in and out without a jump.
namespace marey::retarget {
namespace {

constexpr double kFrame_s = 1e-3;
constexpr double kHalfTurn_rad = std::numbers::pi;

class AdapterRamps : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterRamps, both_methods(), name_of);

// A quintic ramp of 0.7 s is 2.7 per s at its steepest; the postures that it
// leads between differ by up to half a turn in a joint, and three may ramp at
// once: 25 mrad per ms. Means of quaternions turn a little faster in the
// middle.
constexpr double kMaxStep_rad = 0.03;

double fastest_rad(Adapter& adapter, const Pose& reference, double until_s) {
  Pose now;
  Pose before;
  double fastest = 0.0;
  static_cast<void>(adapter.adapt(reference, 0.0, before));
  for (int frame = 1; frame * kFrame_s < until_s; ++frame) {
    static_cast<void>(adapter.adapt(reference, frame * kFrame_s, now));
    fastest = std::max(fastest, max_turned_rad(now, before));
    std::swap(now, before);
  }
  return fastest;
}

TEST_P(AdapterRamps, LetASupportComeAndGo) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Constraint foot = standing("stands", "leftFoot");
  foot.goal =
      Support{place_of(body, reference, {"leftFoot"}) + glm::dvec3(0.05, 0.1, 0.2),
              std::nullopt,
              false};
  foot.activation = {0.1, 1.0, 0.7, 0.8};
  const Constraint hand =
      contact("hand",
              "rightHand",
              place_of(body, reference, {"rightHand"}) + glm::dvec3(0.0, 0.3, 0.3));
  Adapter adapter = make_adapter(body, {{foot, hand}, {}}, options());
  EXPECT_LT(fastest_rad(adapter, reference, 2.0), kMaxStep_rad);
}

TEST_P(AdapterRamps, MayBeStartedAndStoppedWhileTheyRun) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Constraint hand =
      contact("hand",
              "leftHand",
              place_of(body, reference, {"leftHand"}) + glm::dvec3(0.1, 0.2, 0.2));
  hand.activation = {std::nullopt, 0.0, 0.7, 0.7};
  Adapter adapter = make_adapter(body, {{hand}, {}}, options());
  Pose now;
  Pose before;
  static_cast<void>(adapter.adapt(reference, 1.0, before));
  for (int frame = 1; frame < 2500; ++frame) {
    const double t = 1.0 + kFrame_s * frame;
    // Also within ramps.
    if (frame == 100 || frame == 900) adapter.constraint("hand")->start(t);
    if (frame == 500 || frame == 1900) adapter.constraint("hand")->stop(t);
    static_cast<void>(adapter.adapt(reference, t, now));
    ASSERT_LT(max_turned_rad(now, before), kMaxStep_rad) << frame;
    std::swap(now, before);
  }
}

/// A leg captured beyond its range: abducted at the hip, the knee bent backwards.
Pose beyond_limits(const Character& body) {
  Pose pose = waiting(body);
  const auto turn = [&](const char* segment, double angle_rad, const glm::dvec3& axis) {
    glm::dquat& q = pose.parent_from_joint[joint_at(body, segment)];
    q = q * glm::angleAxis(angle_rad, axis);
  };
  turn("leftUpperLeg", 1.4, {0, 1, 0});
  turn("leftLowerLeg", -0.5, {1, 0, 0});
  turn("leftLowerLeg", 0.4, {0, 0, 1});
  return pose;
}

// Supports come before limits (Kulpa 2005, 3.1.1.1), also during other fades; joints
// without targets keep their captured rotation.
TEST_P(AdapterRamps, StandOnALegBeyondItsLimitsWhileAHandComes) {
  const Character body = human(true);
  const Pose reference = beyond_limits(body);
  ASSERT_GT(beyond_limits_rad(body, reference), 0.3);
  Constraint hand =
      contact("hand",
              "leftHand",
              place_of(body, reference, {"leftHand"}) + glm::dvec3(0.2, 0.3, 0.3));
  hand.activation = {0.0, {}, 1.0, 0.0};
  const Constraint foot = standing("foot", "leftFoot");
  const glm::dvec3 print = place_of(body, reference, {"leftFoot"});
  Adapter adapter = make_adapter(body, {{foot, hand}, {}}, options());
  Pose before;
  Pose out;
  static_cast<void>(adapter.adapt(reference, -1.0, before));
  for (int frame = 1; frame < 100; ++frame) {
    static_cast<void>(adapter.adapt(reference, 0.01 * frame, out));
    ASSERT_LT(glm::distance(place_of(body, out, {"leftFoot"}), print), 1e-5) << frame;
    // The steepest of a quintic, 1.9 a second, over some 0.5 m.
    ASSERT_LT(furthest_m(body, out, before), 0.03) << frame;
    std::swap(out, before);
  }
}

// Two targets for nearly the same half turn from opposite sides: their quaternions are
// nearly opposite, and their mean is that half turn, not zero.
TEST_P(AdapterRamps, NearlyEqualHalfTurnsDoNotCancel) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  const glm::dquat hand = rotation_of(body, reference, "leftHand");
  const auto turned = [&](const std::string& id, double angle_rad) {
    Constraint out;
    out.id = id;
    out.point.segment = "leftHand";
    out.goal = SegmentOrientation{glm::angleAxis(angle_rad, glm::dvec3(0, 1, 0)) * hand};
    return out;
  };
  Constraint early = turned("early", kHalfTurn_rad - 0.01);
  Constraint late = turned("late", kHalfTurn_rad + 0.01);
  late.importance = 2.0;
  early.activation = {0.0, {}, 1.0, 0.0};
  late.activation = {0.1, {}, 1.0, 0.0};
  Adapter adapter = make_adapter(body, {{early, late}, {}}, options());
  Pose out;
  static_cast<void>(adapter.adapt(reference, 0.6, out));
  const double share = adapter.constraint("early")->outcome().activation;
  ASSERT_LT(share, 0.8) << "nothing is closed on the mean";
  ASSERT_NEAR(adapter.constraint("late")->outcome().activation, 0.5, 1e-9);
  // The mean of the reference's quaternion and of one at a right angle to it.
  EXPECT_NEAR(angle_between_rad(rotation_of(body, out, "leftHand"), hand),
              2.0 * std::atan2(share, 1.0 - share),
              0.02);
}

/// Returns the maximum rotation of a joint between consecutive times, divided by the
/// change of the constraint's activation, from its start to its end.
double fastest_rad_per_activation(Adapter& adapter,
                                  const Pose& reference,
                                  const std::string& id) {
  constexpr int kSteps = 2000;
  // Steps are compared where rounding errors of single precision are negligible.
  constexpr double kMinChange = 1e-5;
  Pose now;
  Pose before;
  double fastest = 0.0;
  double active = 0.0;
  static_cast<void>(adapter.adapt(reference, 0.0, before));
  for (int step = 1; step <= kSteps; ++step) {
    static_cast<void>(adapter.adapt(reference, static_cast<double>(step) / kSteps, now));
    const double next = adapter.constraint(id)->outcome().activation;
    const double change = std::max(next - active, kMinChange);
    fastest = std::max(fastest, (max_turned_rad(now, before) - 1e-3) / change);
    active = next;
    std::swap(now, before);
  }
  return fastest;
}

// Continuously, not in one step where the closing of limbs starts.
TEST_P(AdapterRamps, TurnAnExtremityAsTheyRise) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  constexpr double kTurn_rad = 1.0;
  for (const char* segment : {"leftHand", "leftFoot"}) {
    for (const bool keeps : {false, true}) {
      Constraint turned;
      turned.id = "turned";
      turned.point.segment = segment;
      turned.goal = SegmentOrientation{glm::angleAxis(kTurn_rad, glm::dvec3(0, 0, 1)) *
                                       rotation_of(body, reference, segment)};
      turned.activation = {0.0, {}, 1.0, 0.0};
      AdaptOptions changed = options();
      changed.extremities_keep_orientation = keeps;
      Adapter adapter = make_adapter(body, {{turned}, {}}, changed);
      // Along the chord, not the arc.
      EXPECT_LT(fastest_rad_per_activation(adapter, reference, "turned"), 1.1 * kTurn_rad)
          << segment << (keeps ? ", kept" : "");
    }
  }
}

// A held hand does not rotate because of a target of its upper arm.
TEST_P(AdapterRamps, TurnNoHandThatIsKept) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Constraint arm;
  arm.id = "arm";
  arm.point.segment = "leftUpperArm";
  const double apart_m = glm::distance(place_of(body, reference, arm.point),
                                       place_of(body, reference, {"head"}));
  arm.goal = DistanceToBody{apart_m - 0.1, {"head", {}}};
  arm.activation = {0.0, {}, 1.0, 0.0};
  AdaptOptions changed = options();
  changed.extremities_keep_orientation = true;
  Adapter adapter =
      make_adapter(body, {{arm, standing("foot", "rightFoot")}, {}}, changed);
  EXPECT_LT(fastest_rad(adapter, reference, 1.1), kMaxStep_rad);
}

/// A hand whose target is out of reach with balance, another one that fades in; feet with
/// supports.
ConstraintSet hand_that_comes(const Character& body, const Pose& reference) {
  const auto from = [&](const char* segment, const glm::dvec3& by) {
    return place_of(body, reference, {segment}) + by;
  };
  const glm::dvec3 away = 0.6 * glm::normalize(glm::dvec3(0.2, 0.3, 1.0));
  Constraint comes = contact("comes", "rightHand", from("rightHand", {0.0, 0.05, 0.05}));
  comes.activation = {0.0, {}, 1.0, 0.0};
  return {{contact("first", "leftHand", from("leftHand", away), {}, 2.0),
           comes,
           standing("left", "leftFoot"),
           standing("right", "rightFoot")},
          {}};
}

// A movement that the full result rejects because of balance does not occur in the ramp.
TEST_P(AdapterRamps, KeepBalanceAndEndWhereTheyLead) {
  for (const BalanceMode mode : {BalanceMode::kHorizontal, BalanceMode::k3d}) {
    // The thesis' method does not find balance at this height.
    if (mode == BalanceMode::k3d && GetParam() == Method::kThesis) continue;
    for (const bool limits : {false, true}) {
      const Character body = human(limits);
      const Pose reference = waiting(body);
      AdaptOptions changed = options();
      changed.balance = mode;
      Adapter adapter = make_adapter(body, hand_that_comes(body, reference), changed);
      const glm::dvec3 wanted = centre_of_mass(body, reference);
      Pose now;
      Pose before;
      static_cast<void>(adapter.adapt(reference, -1.0, before));
      for (int frame = 0; frame <= 1000; ++frame) {
        static_cast<void>(adapter.adapt(reference, kFrame_s * frame, now));
        glm::dvec3 off = centre_of_mass(body, now) - wanted;
        if (mode == BalanceMode::kHorizontal) off.y = 0.0;
        ASSERT_LT(glm::length(off), changed.balance_precision_m) << frame;
        for (const char* foot : {"leftFoot", "rightFoot"}) {
          ASSERT_LT(glm::distance(place_of(body, now, {foot}),
                                  place_of(body, reference, {foot})),
                    1e-5)
              << frame;
        }
        ASSERT_LT(max_turned_rad(now, before), kMaxStep_rad) << frame;
        std::swap(now, before);
      }
    }
  }
}

TEST_P(AdapterRamps, PassFromOneControlToTheOtherInBalance) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  const auto from = [&](const char* segment, const glm::dvec3& by) {
    return place_of(body, reference, {segment}) + by;
  };
  const ConstraintSet far = {
      {contact("first", "leftHand", from("leftHand", {0.3, 0.3, 0.5}), {}, 2.0),
       contact("next", "rightHand", from("rightHand", {-0.7, 0.2, 0.3})),
       standing("left", "leftFoot"),
       standing("right", "rightFoot")},
      {}};
  AdaptOptions changed = options();
  changed.balance = BalanceMode::kHorizontal;
  changed.control_change_s = 0.7;
  Adapter adapter = make_adapter(body, far, changed);
  Pose before;
  Pose now;
  static_cast<void>(adapter.adapt(reference, 0.0, before));
  changed.control = Control::kBlend;
  adapter.set_options(changed);
  for (int frame = 1; frame <= 720; ++frame) {
    static_cast<void>(adapter.adapt(reference, kFrame_s * frame, now));
    ASSERT_LT(max_turned_rad(now, before), kMaxStep_rad) << frame;
    std::swap(now, before);
  }
}

}  // namespace
}  // namespace marey::retarget
