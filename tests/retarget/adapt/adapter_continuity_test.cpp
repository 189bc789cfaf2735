// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// Continuous inputs give continuous postures: no jump, no oscillation. This is a
/// property of the strict method with priority: a blend of targets that cannot all be
/// met, and the thesis' method, do jump.
namespace marey::retarget {
namespace {

constexpr double kStep_m = 5e-4;

/// A closed smooth curve about a point.
struct Path {
  glm::dvec3 centre_in_world{0.0};
  std::array<glm::dvec3, 3> waves_m{};
  std::array<double, 3> phases_rad{};

  [[nodiscard]] glm::dvec3 at(double u) const {
    glm::dvec3 p = centre_in_world;
    for (std::size_t i = 0; i < 3; ++i) {
      p += waves_m[i] * std::sin(static_cast<double>(i + 1) * u + phases_rad[i]);
    }
    return p;
  }
};

Path any_path(const glm::dvec3& centre_in_world, double radius_m, Dice& dice) {
  Path path{centre_in_world, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    path.waves_m[i] = radius_m / static_cast<double>(i + 1) * dice.direction();
    path.phases_rad[i] = dice.between(0, 6.28);
  }
  return path;
}

/// Maximum speeds of a posture.
struct Pace {
  double joints_rad_per_m = 0.0;
  double root_m_per_m = 0.0;
  /// Maximum of second differences: how suddenly the motion starts.
  double jerks_rad_per_m = 0.0;
};

struct Follower {
  Adapter adapter;
  Pose reference;
  Pose now;
  Pose before;
  Pose long_before;
  int steps = 0;
  Pace pace;

  void step() {
    long_before = before;
    before = now;
    static_cast<void>(adapter.adapt(reference, 1e3, now));
    ++steps;
    if (steps < 2) return;
    pace.joints_rad_per_m =
        std::max(pace.joints_rad_per_m, max_turned_rad(now, before) / kStep_m);
    pace.root_m_per_m =
        std::max(pace.root_m_per_m,
                 glm::distance(now.root_in_world, before.root_in_world) / kStep_m);
    if (steps < 3) return;
    for (std::size_t j = 0; j < now.parent_from_joint.size(); ++j) {
      const auto turned = [j](const Pose& a, const Pose& b) {
        return rotation_vector(glm::normalize(glm::conjugate(a.parent_from_joint[j]) *
                                              b.parent_from_joint[j]));
      };
      pace.jerks_rad_per_m = std::max(
          pace.jerks_rad_per_m,
          glm::length(turned(before, now) - turned(long_before, before)) / kStep_m);
    }
  }
};

Follower follower(const Character& body,
                  const ConstraintSet& asked,
                  const AdaptOptions& options) {
  return {make_adapter(body, asked, options), waiting(body), {}, {}, {}, 0, {}};
}

// Follows `paths` (ids "0", "1", ...) for half of the loop, the fastest by kStep_m at a
// time. The other half is another path of the same kind, so half the cost is sufficient.
void follow(Follower& body, const std::vector<Path>& paths) {
  double u = 0.0;
  while (u < 3.1) {
    double speed = 0.05;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const auto handle = body.adapter.constraint(std::to_string(i));
      auto moved = *handle;
      moved.set_target(paths[i].at(u));
      speed =
          std::max(speed, glm::distance(paths[i].at(u + 1e-4), paths[i].at(u)) / 1e-4);
    }
    body.step();
    u += kStep_m / speed;
  }
}

struct Case {
  std::string name;
  std::vector<BodyPoint> points;
  double radius_m = 0.4;
  bool stands = false;
  bool with_limits = false;
  BalanceMode balance = BalanceMode::kOff;
  /// Relative to a hand's: speeds are larger for a point that is nearer to the elbow.
  double times_as_fast = 1.0;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

class AdapterFollows : public ::testing::TestWithParam<Case> {};

// Reason for the bounds: a bone of length l that points at a target at distance d rotates
// by 1/d rad per m, and the target passes the shoulder at no less than about 3 cm here:
// 33. An elbow opens by 1 / (l sin(bend/2)): 35 for 0.29 m of forearm at 0.2 rad, and the
// body takes over before limbs are straighter. Where two joints of one chain both rotate,
// their rates add; other joints compensate a joint at its limit. A leg that becomes
// straight stops the hips at once.
constexpr double kMaxTurn_rad_per_m = 80.0;
constexpr double kMaxRootPath_m_per_m = 16.0;

TEST_P(AdapterFollows, WithoutJumps) {
  const Case& asked = GetParam();
  const Character body = human(asked.with_limits);
  Dice dice(71);
  for (int round = 0; round < 4; ++round) {
    ConstraintSet set;
    std::vector<Path> paths;
    if (asked.stands) {
      set.constraints.push_back(standing("left", "leftFoot"));
      set.constraints.push_back(standing("right", "rightFoot"));
    }
    for (std::size_t i = 0; i < asked.points.size(); ++i) {
      const BodyPoint& point = asked.points[i];
      const glm::dvec3 here = place_of(body, waiting(body), point);
      paths.push_back(
          any_path(here + 0.5 * asked.radius_m * dice.direction(), asked.radius_m, dice));
      Constraint wish = contact(std::to_string(i),
                                point.segment,
                                here,
                                point.offset_in_t_pose,
                                3.0 - static_cast<double>(i));
      set.constraints.push_back(wish);
    }
    AdaptOptions options;
    options.balance = asked.balance;
    Follower out = follower(body, set, options);
    follow(out, paths);
    const double fastest = asked.times_as_fast * kMaxTurn_rad_per_m;
    EXPECT_LT(out.pace.joints_rad_per_m, fastest) << "round " << round;
    EXPECT_LT(out.pace.root_m_per_m, asked.times_as_fast * kMaxRootPath_m_per_m)
        << "round " << round;
    EXPECT_LT(out.pace.jerks_rad_per_m, (asked.stands ? 1.0 : 0.5) * fastest)
        << "round " << round;
  }
}

Case within_limits(Case out, double times_as_fast = 1.0) {
  out.with_limits = true;
  out.times_as_fast *= times_as_fast;
  return out;
}

// For a point at this distance from the elbow or knee.
Case nearer(Case out, double lever_m) {
  constexpr double kForearm_m = 0.26;
  out.times_as_fast *= kForearm_m / lever_m;
  return out;
}

Case balanced(Case out) {
  out.balance = BalanceMode::kHorizontal;
  return out;
}

std::vector<Case> cases() {
  const BodyPoint hand{"leftHand", {}};
  const BodyPoint elbow{"leftLowerArm", {}};
  const BodyPoint forearm{"leftLowerArm", {0.12, 0.0, 0.0}};
  const BodyPoint knee{"rightLowerLeg", {}};
  const BodyPoint calf{"rightLowerLeg", {0.0, -0.25, -0.03}};
  const BodyPoint brow{"head", {0.0, 0.1, 0.1}};
  return {
      {"hand_near", {hand}, 0.25},
      {"hand_near_within_limits", {hand}, 0.25, false, true},
      {"hand", {hand}, 0.6},
      {"hand_with_offset", {{"leftHand", {0.08, 0.0, 0.02}}}, 0.6},
      {"head", {brow}, 0.3},
      {"head_within_limits", {brow}, 0.3, false, true},
      {"hand_standing", {hand}, 0.5, true},
      within_limits({"hand_within_limits", {hand}, 0.5}, 1.5),
      {"upper_arm", {{"leftUpperArm", {0.25, 0.03, -0.02}}}, 0.3},
      {"elbow", {elbow}, 0.3},
      within_limits({"elbow_within_limits", {elbow}, 0.3}),
      nearer({"forearm", {forearm}, 0.4}, 0.12),
      within_limits(nearer({"forearm_within_limits", {forearm}, 0.4}, 0.12)),
      nearer({"skin_of_forearm", {{"leftLowerArm", {0.15, 0.03, 0.02}}}, 0.4}, 0.15),
      {"thigh", {{"rightUpperLeg", {0.02, -0.3, 0.05}}}, 0.3},
      {"knee", {knee}, 0.3},
      within_limits({"knee_within_limits", {knee}, 0.3}),
      nearer({"shin", {calf}, 0.4}, 0.25),
      within_limits(nearer({"shin_within_limits", {calf}, 0.4}, 0.25)),
      balanced({"hand_balanced", {hand}, 0.3, true}),
  };
}
INSTANTIATE_TEST_SUITE_P(Adapter,
                         AdapterFollows,
                         ::testing::ValuesIn(cases()),
                         [](const auto& each) { return each.param.name; });

// The help of the body for each of two targets begins smoothly, also with the other
// active.
TEST(AdapterFollows, AWishOfTheHeadBeginsToMoveWithoutAJump) {
  const Character body = human(false);
  const glm::dvec3 brow_in_world = place_of(body, waiting(body), {"head"});
  const glm::dvec3 shoulder_in_world = place_of(body, waiting(body), {"leftUpperArm"});
  const glm::dvec3 reach_m =
      place_of(body, waiting(body), {"leftHand"}) - shoulder_in_world;
  Constraint hand =
      contact("hand", "leftHand", shoulder_in_world + 1.04 * reach_m, {}, 1.0);
  Constraint brow = contact("0", "head", brow_in_world, {}, 1.0);
  Follower out = follower(body, {{hand, brow}, {}}, {});
  for (int step = 0; step < 200; ++step) {
    out.adapter.constraint("0")->set_target(
        brow_in_world + step * kStep_m * glm::normalize(glm::dvec3(0.2, 0.1, 1.0)));
    out.step();
  }
  EXPECT_LT(out.pace.joints_rad_per_m, 0.5 * kMaxTurn_rad_per_m);
  EXPECT_LT(out.pace.root_m_per_m, 0.5 * kMaxRootPath_m_per_m);
}

}  // namespace
}  // namespace marey::retarget
