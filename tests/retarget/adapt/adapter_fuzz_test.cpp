// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// For any targets the result is a valid posture within the body's limits.
namespace marey::retarget {
namespace {

// Limits in single precision, written as unit quaternions in double.
constexpr double kLimit_rad = 1e-4;

struct Question {
  ConstraintSet set;
  AdaptOptions options;
  /// Joints of supporting legs: supports come before limits (Kulpa 2005, 3.1.1.1).
  std::vector<std::size_t> standing;
};

const std::string& any_of(const std::vector<std::string>& names, Dice& dice) {
  const auto last = static_cast<double>(names.size()) - 1e-9;
  return names[static_cast<std::size_t>(dice.between(0, last))];
}

std::vector<std::string> segments_of(const Character& body) {
  std::vector<std::string> names;
  for (const Joint& joint : body.skeleton.joints) names.push_back(joint.name);
  return names;
}

Goal any_goal(const std::string& own, const std::vector<std::string>& names, Dice& dice) {
  const double kind = dice.between(0, 1);
  const glm::dvec3 p = 2.0 * dice.direction();
  if (kind < 0.1) return SegmentOrientation{dice.turn(3.1)};
  if (kind < 0.2) return AllowedSpace{p, p + glm::dvec3(dice.between(0, 0.5))};
  if (kind < 0.3) return ForbiddenSpace{p - 1.0, p + dice.between(-1.0, 1.0)};
  const std::string& other = any_of(names, dice);
  if (kind < 0.4 && other != own) return DistanceToBody{dice.between(0, 1), {other, {}}};
  return DistanceToPoint{kind < 0.5 ? dice.between(0, 1) : 0.0, p};
}

Question any_question(const Character& body, Method method, Dice& dice) {
  Question out;
  const std::vector<std::string> names = segments_of(body);
  const int count = static_cast<int>(dice.between(1, 5));
  for (int k = 0; k < count; ++k) {
    Constraint wish;
    wish.id = "wish " + std::to_string(k);
    wish.point.segment = any_of(names, dice);
    if (dice.between(0, 1) < 0.6) {
      wish.point.offset_in_t_pose = dice.between(0, 0.2) * dice.direction();
    }
    wish.goal = any_goal(wish.point.segment, names, dice);
    wish.importance = std::floor(dice.between(1, 4));
    if (dice.between(0, 1) < 0.3) wish.range = static_cast<int>(dice.between(1, 7));
    if (dice.between(0, 1) < 0.2) wish.activation.start_duration_s = 1.0;
    if (dice.between(0, 1) < 0.2) wish.activation.start_s = 0.0;
    out.set.constraints.push_back(wish);
  }
  for (const BodyGroup& group : body.groups) {
    if (!group.can_support || dice.between(0, 1) > 0.3) continue;
    const JointIndex foot = group.parts.back().joints.back();
    const Limb leg = limb_of(body, index(foot));
    out.standing.insert(out.standing.end(), {leg.upper, leg.lower, leg.end});
    out.set.constraints.push_back(standing("on " + group.name, body.skeleton[foot].name));
  }
  out.options.method = method;
  out.options.control = dice.between(0, 1) < 0.5 ? Control::kPriority : Control::kBlend;
  const double balance = dice.between(0, 1);
  if (balance < 0.5) out.options.balance = BalanceMode::kHorizontal;
  if (balance < 0.2) out.options.balance = BalanceMode::k3d;
  out.options.extremities_keep_orientation = dice.between(0, 1) < 0.2;
  if (dice.between(0, 1) < 0.2) out.options.root_for_constraints = 0.0;
  if (dice.between(0, 1) < 0.2) out.options.root_for_balance = 0.3;
  return out;
}

// Near or far, at joints, at roots of limbs: places where a direction has no length.
glm::dvec3 any_target(const std::vector<RigidTransform>& frames,
                      std::size_t own,
                      Dice& dice) {
  const glm::dvec3 here = frames[own].translation;
  const double kind = dice.between(0, 1);
  if (kind < 0.5) return here + dice.between(0, 0.8) * dice.direction();
  if (kind < 0.6) return here;
  if (kind < 0.75) {
    const auto last = static_cast<double>(frames.size()) - 1e-9;
    return frames[static_cast<std::size_t>(dice.between(0, last))].translation;
  }
  // check_constraints() permits 10 km; live targets may be anywhere.
  return here + std::pow(10.0, dice.between(-6, 6)) * dice.direction();
}

Pose any_posture(const Character& body, Dice& dice) {
  // Straight limbs, too: a limb without a plane.
  if (dice.between(0, 1) < 0.2) return rest_pose(body.skeleton);
  return random_posture(body, dice, 0.6);
}

bool has_numbers(const AdaptReport& report) {
  return std::isfinite(report.constraint_error_m) &&
         std::isfinite(report.worst_error_m) && std::isfinite(report.balance_error_m);
}

class AdapterFuzz : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterFuzz, both_methods(), name_of);

TEST_P(AdapterFuzz, ReturnsPosturesWithinTheLimitsForRandomConstraints) {
  constexpr int kQuestions = 700;
  constexpr int kPosturesPerBody = 10;
  int solved = 0;
  for (const Character& body : bodies()) {
    Dice dice(77);
    for (int q = 0; q < kQuestions; ++q) {
      const Question asked = any_question(body, GetParam(), dice);
      auto adapter = Adapter::make(body, asked.set, asked.options);
      if (!adapter)
        continue;  // Two targets may contradict each other; then there is no posture.
      Pose out;
      for (int t = 0; t < kPosturesPerBody; ++t) {
        const Pose reference = any_posture(body, dice);
        const auto frames = world_from_joints(body.skeleton, reference);
        for (const Constraint& wish : asked.set.constraints) {
          if (!std::holds_alternative<DistanceToPoint>(wish.goal)) continue;
          adapter->constraint(wish.id)->set_target(
              any_target(frames, joint_at(body, wish.point.segment), dice));
        }
        const AdaptReport report = adapter->adapt(reference, 0.11 * t, out);
        ++solved;
        ASSERT_TRUE(is_finite(out) && has_numbers(report))
            << "question " << q << " " << t;
        for (const glm::dquat& rotation : out.parent_from_joint) {
          ASSERT_NEAR(glm::length(rotation), 1.0, 1e-9) << "question " << q << " " << t;
        }
        ASSERT_LT(beyond_limits_rad(body, out, asked.standing), kLimit_rad)
            << "question " << q << " " << t;
      }
    }
  }
  EXPECT_GT(solved, 20000);
}

// Any position that constraints may have, uniform in the order of magnitude.
glm::dvec3 any_far_place(Dice& dice) {
  constexpr double kMaxDistance_m = 1e4;
  const double far_m = std::pow(10.0, dice.between(0, 4));
  return std::min(far_m, 0.999 * kMaxDistance_m) * dice.direction();
}

// Half of the targets and points have the largest permitted distance.
void go_far(ConstraintSet& set, Dice& dice) {
  for (Constraint& wish : set.constraints) {
    if (dice.between(0, 1) < 0.5) continue;
    const glm::dvec3 place = any_far_place(dice);
    if (auto* stands = std::get_if<Support>(&wish.goal)) {
      stands->footprint_in_world = place;
    } else if (auto* to_point = std::get_if<DistanceToPoint>(&wish.goal)) {
      to_point->p_in_world = place;
      if (to_point->distance_m > 0.0) to_point->distance_m = glm::length(place);
    } else if (auto* to_body = std::get_if<DistanceToBody>(&wish.goal)) {
      to_body->distance_m = glm::length(place);
    } else if (auto* allowed = std::get_if<AllowedSpace>(&wish.goal)) {
      *allowed = {place, glm::max(place, glm::dvec3(0.0))};
    }
    if (dice.between(0, 1) < 0.2) wish.point.offset_in_t_pose = any_far_place(dice);
  }
}

TEST_P(AdapterFuzz, ReturnsValidPosturesForFarTargets) {
  constexpr int kQuestions = 2500;
  int solved = 0;
  for (const Character& body : bodies()) {
    Dice dice(5);
    for (int q = 0; q < kQuestions; ++q) {
      Question asked = any_question(body, GetParam(), dice);
      go_far(asked.set, dice);
      auto adapter = Adapter::make(body, asked.set, asked.options);
      if (!adapter) continue;
      if (dice.between(0, 1) < 0.2) adapter->set_balance_target(any_far_place(dice));
      Pose out;
      const AdaptReport report = adapter->adapt(any_posture(body, dice), 2.0, out);
      ++solved;
      ASSERT_TRUE(is_finite(out) && has_numbers(report)) << "question " << q;
      for (const glm::dquat& rotation : out.parent_from_joint) {
        ASSERT_NEAR(glm::length(rotation), 1.0, 1e-9) << "question " << q;
      }
      ASSERT_LT(beyond_limits_rad(body, out, asked.standing), kLimit_rad)
          << "question " << q;
    }
  }
  EXPECT_GT(solved, 5000);
}

// A body that moves far to its footprint has the same posture there as at a near one.
TEST(AdapterFar, StandsOnAFarFootprintAsOnANearOne) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  const glm::dvec3 foot = place_of(body, reference, {"leftFoot", {}});
  for (const BalanceMode balance : {BalanceMode::kHorizontal, BalanceMode::k3d}) {
    for (double far_m = 10.0; far_m < 9000.0; far_m *= 1.3) {
      ConstraintSet set{{standing("stands", "leftFoot")}, {}};
      std::get<Support>(set.constraints[0].goal).footprint_in_world =
          foot + glm::dvec3(far_m, 0, 0);
      AdaptOptions options;
      options.balance = balance;
      Adapter adapter = make_adapter(body, set, options);
      Pose out;
      const AdaptReport report = adapter.adapt(reference, 1.0, out);
      // Resolution of single precision at that distance.
      const double min_m = 1e-3 + 1e-6 * far_m;
      EXPECT_LT(report.worst_error_m, min_m) << far_m;
      EXPECT_LT(report.balance_error_m, min_m) << far_m;
    }
  }
}

}  // namespace
}  // namespace marey::retarget
