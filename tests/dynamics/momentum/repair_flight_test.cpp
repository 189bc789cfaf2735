// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/momentum/repair_flight.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "tests/dynamics/momentum/made_flight.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/truth/momentum_judge.h"

namespace marey::dynamics {
namespace {

using testing::Dice;
using testing::Differences;

constexpr MomentumOptions kAnyTurn{3.2};

MomentumRepair repair(MadeFlight& flight, const MomentumOptions& options = {}) {
  return keep_angular_momentum(
      flight.skeleton, flight.masses, flight.rate, flight.poses, options);
}

double judged_sd(const MadeFlight& flight,
                 Differences differences = Differences::kThreePoint) {
  return testing::largest_sd(testing::judged_momentum(
      flight.skeleton, flight.masses, flight.rate.hz, flight.poses, differences));
}

bool same(const Pose& a, const Pose& b) {
  return a.root_in_world == b.root_in_world && a.parent_from_joint == b.parent_from_joint;
}

// Angle between the roots of two poses, from the chord: exact also for small angles.
double root_turn_rad(const Pose& a, const Pose& b) {
  const glm::dquat& p = a.parent_from_joint[0];
  const glm::dquat q = glm::dot(p, b.parent_from_joint[0]) < 0.0 ? -b.parent_from_joint[0]
                                                                 : b.parent_from_joint[0];
  const glm::dquat d = p - q;
  return 4.0 * std::asin(std::min(0.5 * std::sqrt(glm::dot(d, d)), 1.0));
}

// Two joints at one place: a body and a wheel in it.
MadeFlight body_with_wheel(std::size_t frames,
                           const std::function<double(double)>& angle) {
  MadeFlight out;
  out.skeleton.joints.resize(2);
  out.skeleton.joints[0].name = "body";
  out.skeleton.joints[1].name = "wheel";
  out.skeleton.joints[1].parent = JointIndex{0};
  out.masses = {{JointIndex{0}, glm::dvec3(0.0), 60.0, glm::dmat3(0.05)},
                {JointIndex{1}, glm::dvec3(0.0), 10.0, glm::dmat3(0.06)}};
  out.rate = FrameRate{120.0};
  for (std::size_t k = 0; k < frames; ++k) {
    Pose pose = rest_pose(out.skeleton);
    const double t = static_cast<double>(k) / static_cast<double>(frames - 1);
    pose.parent_from_joint[1] = glm::angleAxis(angle(t), glm::dvec3(0, 0, 1));
    out.poses.push_back(pose);
  }
  return out;
}

// The bar of a repaired flight is 0.01 kg m^2/s. The judge differentiates on its own.
TEST(KeepAngularMomentum, MakesTheMomentumOfAnyMadeFlightConstant) {
  double largest_before = 0.0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Dice dice(seed);
    MadeFlightRule rule;
    rule.frames = 12 + seed % 90;
    rule.rate_hz = seed % 3 == 0 ? 60.0 : 120.0;
    MadeFlight flight = made_flight(dice, rule);
    const MadeFlight before = flight;
    const MomentumRepair report = repair(flight, kAnyTurn);
    ASSERT_TRUE(report.applied) << seed;
    EXPECT_LT(judged_sd(flight), 0.01) << seed;
    EXPECT_NEAR(report.sd_before_kg_m2_s, judged_sd(before), 1e-6) << seed;
    EXPECT_NEAR(report.sd_after_kg_m2_s, judged_sd(flight), 1e-6) << seed;
    EXPECT_EQ(report.landing_turn_rad, 0.0);
    largest_before = std::max(largest_before, report.sd_before_kg_m2_s);
    double largest_turn = 0.0;
    for (std::size_t k = 0; k < flight.poses.size(); ++k) {
      const auto com = [&](const MadeFlight& f) {
        return testing::judged_com(f.skeleton, f.masses, f.poses[k]);
      };
      EXPECT_LT(glm::distance(com(flight), com(before)), 1e-9 /* m */) << seed;
      largest_turn =
          std::max(largest_turn, root_turn_rad(flight.poses[k], before.poses[k]));
      for (std::size_t j = 1; j < flight.skeleton.joints.size(); ++j) {
        ASSERT_EQ(flight.poses[k].parent_from_joint[j],
                  before.poses[k].parent_from_joint[j])
            << "only roots change";
      }
    }
    EXPECT_NEAR(report.largest_turn_rad, largest_turn, 1e-6) << seed;
    EXPECT_TRUE(same(flight.poses.front(), before.poses.front())) << seed;
    EXPECT_TRUE(same(flight.poses.back(), before.poses.back())) << seed;
  }
  EXPECT_GT(largest_before, 2.0) << "the flights need a repair";
}

// Central differences of neighbouring frames use different frames. A repair that differs
// between even and odd frames would satisfy them and tremble.
TEST(KeepAngularMomentum, DoesNotTremble) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Dice dice(1000 + seed);
    MadeFlightRule rule;
    rule.frames = 40 + seed % 40;
    MadeFlight flight = made_flight(dice, rule);
    ASSERT_TRUE(repair(flight, kAnyTurn).applied);
    EXPECT_LT(judged_sd(flight, Differences::kFivePoint), 0.06) << seed;
  }
}

// The end of a whole turn hardly depends on the momentum in some directions, so that few
// somersaults have no repair: they stay as they are.
TEST(KeepAngularMomentum, KeepsSomersaults) {
  int applied = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Dice dice(2000 + seed);
    MadeFlightRule rule;
    rule.frames = 70 + seed % 30;
    rule.turns = dice.between(-2.0, 2.0);
    rule.max_swing_rad = 0.3;
    MadeFlight flight = made_flight(dice, rule);
    const MadeFlight before = flight;
    if (repair(flight, kAnyTurn).applied) {
      ++applied;
      EXPECT_LT(judged_sd(flight), 0.01) << seed << " turns " << rule.turns;
    } else {
      EXPECT_TRUE(same(flight.poses[20], before.poses[20])) << seed;
    }
  }
  EXPECT_GE(applied, 196);
}

// A rigid body without forces (Euler's equations, integrated here by Runge-Kutta 4 on a
// hundredth of a frame) is already right: what remains is the error of differences.
TEST(KeepAngularMomentum, LeavesATumblingRigidBodyAlone) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Dice dice(3000 + seed);
    MadeFlight flight;
    flight.skeleton.joints.resize(1);
    const glm::dmat3 axes = glm::mat3_cast(dice.turn(3.0));
    glm::dmat3 principal(0.0);
    principal[0][0] = 0.16;
    principal[1][1] = 0.14;
    principal[2][2] = 0.03;
    const glm::dmat3 inertia = axes * principal * glm::transpose(axes);
    flight.masses = {
        {JointIndex{0}, dice.between(0.0, 0.3) * dice.direction(), 70.0, inertia}};
    flight.rate = FrameRate{120.0};
    const glm::dmat3 inverse_inertia = glm::inverse(inertia);
    glm::dquat q = dice.turn(3.0);
    const glm::dvec3 momentum_per_kg = dice.between(0.05, 0.6) * dice.direction();
    const auto rate = [&](const glm::dquat& at) {
      const glm::dvec3 omega =
          at * (inverse_inertia * (glm::conjugate(at) * momentum_per_kg));
      return 0.5 * (glm::dquat(0.0, omega.x, omega.y, omega.z) * at);
    };
    for (int k = 0; k < 60; ++k) {
      Pose pose = rest_pose(flight.skeleton);
      pose.parent_from_joint[0] = q;
      // About its centre of mass.
      pose.root_in_world = -(q * flight.masses[0].p_in_joint);
      flight.poses.push_back(pose);
      for (int i = 0; i < 100; ++i) {
        const double h = 1.0 / 12000.0;
        const glm::dquat a = rate(q);
        const glm::dquat b = rate(q + a * (0.5 * h));
        const glm::dquat c = rate(q + b * (0.5 * h));
        const glm::dquat d = rate(q + c * h);
        q = glm::normalize(q + (a + b * 2.0 + c * 2.0 + d) * (h / 6.0));
      }
    }
    const MadeFlight before = flight;
    const MomentumRepair report = repair(flight);
    ASSERT_TRUE(report.applied);
    EXPECT_NEAR(glm::distance(report.momentum_kg_m2_s, 70.0 * momentum_per_kg) /
                    glm::length(70.0 * momentum_per_kg),
                0.0,
                0.01 /* error of central differences */);
    EXPECT_LT(report.largest_turn_rad, 0.01) << seed;
    EXPECT_LT(judged_sd(flight), 0.01);
  }
}

// A body with a wheel in it turns against the wheel: the closed form.
TEST(KeepAngularMomentum, TurnsABodyAgainstItsWheel) {
  const auto angle = [](double t) { return 0.6 * std::sin(std::numbers::pi * t); };
  MadeFlight flight = body_with_wheel(61, angle);
  const MomentumRepair report = repair(flight);
  ASSERT_TRUE(report.applied);
  const double share = 10.0 * 0.06 / (10.0 * 0.06 + 60.0 * 0.05);
  for (std::size_t k = 0; k < flight.poses.size(); ++k) {
    const double wanted = -share * angle(static_cast<double>(k) / 60.0);
    const glm::dquat& q = flight.poses[k].parent_from_joint[0];
    EXPECT_NEAR(2.0 * std::atan2(q.z, q.w), wanted, 2e-5) << k;
    EXPECT_NEAR(q.x, 0.0, 1e-12);
  }
  EXPECT_NEAR(glm::length(report.momentum_kg_m2_s), 0.0, 1e-3);
}

// A wheel that ends turned needs momentum so that the body lands as it started.
TEST(KeepAngularMomentum, FindsTheMomentumThatKeepsTheLanding) {
  const auto angle = [](double t) { return 0.8 * t * t * (3.0 - 2.0 * t); };
  MadeFlight flight = body_with_wheel(61, angle);
  const MomentumRepair report = repair(flight);
  ASSERT_TRUE(report.applied);
  EXPECT_NEAR(report.momentum_kg_m2_s.z, 10.0 * 0.06 * 0.8 / 0.5, 1e-3);
}

// A cat: two halves that bend and roll about their own axes, back to the first posture.
// Without momentum the whole has turned (a geometric phase), so that a landing as started
// needs some.
TEST(KeepAngularMomentum, BalancesTheCatTwist) {
  MadeFlight flight;
  flight.skeleton.joints.resize(2);
  flight.skeleton.joints[1].parent = JointIndex{0};
  flight.masses = {{JointIndex{0}, {-0.3, 0.0, 0.0}, 35.0, glm::dmat3(0.0)},
                   {JointIndex{1}, {0.3, 0.0, 0.0}, 35.0, glm::dmat3(0.0)}};
  for (PointMass& mass : flight.masses) {
    mass.inertia_per_kg_m2[0][0] = 0.02;
    mass.inertia_per_kg_m2[1][1] = 0.03;
    mass.inertia_per_kg_m2[2][2] = 0.03;
  }
  flight.rate = FrameRate{120.0};
  const glm::dvec3 along(1, 0, 0);
  for (int k = 0; k <= 90; ++k) {
    const double t = k / 90.0;
    const double roll = 2.0 * std::numbers::pi * t * t * (3.0 - 2.0 * t);
    Pose pose = rest_pose(flight.skeleton);
    const glm::dquat rolled = glm::angleAxis(roll, along);
    // Both halves roll alike about their own axes while the bend stays in the world.
    const glm::dquat front = glm::angleAxis(0.5, glm::dvec3(0, 0, 1)) * rolled;
    const glm::dquat rear = glm::angleAxis(-0.5, glm::dvec3(0, 0, 1)) * rolled;
    pose.parent_from_joint[0] = rear;
    pose.parent_from_joint[1] = glm::conjugate(rear) * front;
    flight.poses.push_back(pose);
  }
  const MomentumRepair report = repair(flight, kAnyTurn);
  ASSERT_TRUE(report.applied);
  EXPECT_LT(judged_sd(flight), 0.01);
  EXPECT_GT(std::abs(report.momentum_kg_m2_s.x), 5.0);
}

TEST(KeepAngularMomentum, FollowsATurnAndADisplacementOfTheWorld) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Dice dice(4000 + seed);
    MadeFlight plain = made_flight(dice, {.frames = 40 + seed % 7});
    const RigidTransform moved{dice.turn(3.0), 10.0 * dice.direction()};
    MadeFlight other = plain;
    for (Pose& pose : other.poses) {
      pose.root_in_world = moved * pose.root_in_world;
      pose.parent_from_joint[0] = moved.rotation * pose.parent_from_joint[0];
    }
    const MomentumRepair a = repair(plain, kAnyTurn);
    const MomentumRepair b = repair(other, kAnyTurn);
    EXPECT_LT(glm::distance(moved.rotation * a.momentum_kg_m2_s, b.momentum_kg_m2_s),
              1e-6);
    for (std::size_t k = 0; k < plain.poses.size(); ++k) {
      EXPECT_LT(glm::distance(moved * plain.poses[k].root_in_world,
                              other.poses[k].root_in_world),
                1e-7);
      Pose turned = plain.poses[k];
      turned.parent_from_joint[0] = moved.rotation * turned.parent_from_joint[0];
      EXPECT_LT(root_turn_rad(turned, other.poses[k]), 1e-7);
    }
  }
}

// Mirrored in the plane x = 0: (w, x, y, z) becomes (w, x, -y, -z).
TEST(KeepAngularMomentum, RepairsAMirroredFlightAlike) {
  const glm::dvec3 mirror(-1.0, 1.0, 1.0);
  const auto mirrored = [](const glm::dquat& q) {
    return glm::dquat(q.w, q.x, -q.y, -q.z);
  };
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Dice dice(5000 + seed);
    MadeFlight plain = made_flight(dice, {.frames = 41});
    MadeFlight other = plain;
    for (Joint& joint : other.skeleton.joints) {
      joint.parent_from_joint.translation *= mirror;
      joint.parent_from_joint.rotation = mirrored(joint.parent_from_joint.rotation);
    }
    for (PointMass& mass : other.masses) {
      mass.p_in_joint *= mirror;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) mass.inertia_per_kg_m2[i][j] *= mirror[i] * mirror[j];
      }
    }
    for (Pose& pose : other.poses) {
      pose.root_in_world *= mirror;
      for (glm::dquat& q : pose.parent_from_joint) q = mirrored(q);
    }
    repair(plain, kAnyTurn);
    repair(other, kAnyTurn);
    for (std::size_t k = 0; k < plain.poses.size(); ++k) {
      EXPECT_LT(glm::distance(plain.poses[k].root_in_world * mirror,
                              other.poses[k].root_in_world),
                1e-8);
      Pose image = plain.poses[k];
      image.parent_from_joint[0] = mirrored(image.parent_from_joint[0]);
      EXPECT_LT(root_turn_rad(image, other.poses[k]), 1e-7);
    }
  }
}

TEST(KeepAngularMomentum, DeclinesALargeTurnAndReportsIt) {
  Dice dice(6001);
  MadeFlight flight = made_flight(dice, {.frames = 60, .max_swing_rad = 1.5});
  const MadeFlight before = flight;
  const MomentumRepair report = repair(flight, {0.01});
  EXPECT_FALSE(report.applied);
  EXPECT_GT(report.largest_turn_rad, 0.01);
  EXPECT_EQ(report.sd_after_kg_m2_s, report.sd_before_kg_m2_s);
  for (std::size_t k = 0; k < flight.poses.size(); ++k) {
    EXPECT_TRUE(same(flight.poses[k], before.poses[k]));
  }
}

TEST(KeepAngularMomentum, LeavesFewerThanFourPosesUnchanged) {
  Dice dice(6002);
  const MadeFlight whole = made_flight(dice, {.frames = 60});
  for (std::size_t count = 0; count < 4; ++count) {
    MadeFlight flight = whole;
    flight.poses.resize(count);
    EXPECT_FALSE(repair(flight).applied);
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_TRUE(same(flight.poses[k], whole.poses[k]));
    }
  }
  MadeFlight four = whole;
  four.poses.resize(4);
  EXPECT_TRUE(repair(four).applied);
  EXPECT_LT(judged_sd(four), 1e-6);
}

TEST(KeepAngularMomentum, AllocatesNothingPerFrame) {
  Dice dice(6003);
  const MadeFlight whole = made_flight(dice, {.frames = 200, .max_swing_rad = 0.1});
  const auto count = [&](std::size_t frames) {
    MadeFlight flight = whole;
    flight.poses.resize(frames);
    const long before = testing::allocations();
    repair(flight, kAnyTurn);
    return testing::allocations() - before;
  };
  EXPECT_EQ(count(20), count(200));
}

}  // namespace
}  // namespace marey::dynamics
