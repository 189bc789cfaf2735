// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures if a person with joint limits reaches reachable targets. Targets are the
// places of wrists and ankle in random postures within the limits, with the other foot
// planted. A posture further from standing is harder.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

#include <glm/common.hpp>

#include "benchmarks/adaptation/adapt_questions.h"
#include "benchmarks/adaptation/compare_solvers.h"
#include "benchmarks/adaptation/marey_posture_solver.h"
#include "benchmarks/adaptation/posture_measures.h"
#include "benchmarks/adaptation/standing_scene.h"
#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

constexpr int kPostures = 300;
constexpr std::uint64_t kSeed = 41;
// Axes are limited one by one: so near to the middle no mix of them is beyond.
constexpr double kShareOfRange = 0.6;
constexpr double kMaxAngle_rad = 1.7;  // Largest angle of free axes.

struct Reached {
  StandingScene::Targets targets_in_world{};
  glm::dvec3 com_in_world{0.0};
};

/// Every joint `share` of the way from standing to a random place within its limits, the
/// left foot as it stands. Precondition: joints rest with their axes in the T-pose's.
Reached random_reach(const StandingScene& scene, double share, testing::Dice& dice) {
  const Skeleton& skeleton = scene.character.skeleton;
  Pose pose = scene.reference;
  const auto go = [&](std::size_t joint, const glm::dvec3& to_rad) {
    glm::dquat& rotation = pose.parent_from_joint[joint];
    rotation = glm::slerp(rotation, rotation_from_vector(to_rad), share);
  };
  for (const JointLimit& limit : scene.character.limits) {
    const glm::dvec3 low = glm::max(limit.min_rad, -kMaxAngle_rad) * kShareOfRange;
    const glm::dvec3 high = glm::min(limit.max_rad, kMaxAngle_rad) * kShareOfRange;
    go(index(limit.joint),
       {dice.between(low.x, high.x),
        dice.between(low.y, high.y),
        dice.between(low.z, high.z)});
  }
  const std::size_t planted = index(scene.goals.back().joint);
  const RigidTransform stands = world_from_joints(skeleton, scene.reference)[planted];
  const RigidTransform strays = world_from_joints(skeleton, pose)[planted];
  const RigidTransform back = stands * inverse(strays);
  pose.root_in_world = back * pose.root_in_world;
  pose.parent_from_joint[0] = back.rotation * pose.parent_from_joint[0];
  Reached reached;
  const auto world_from_joint = world_from_joints(skeleton, pose);
  for (std::size_t k = 0; k < scene.goals.size(); ++k) {
    reached.targets_in_world[k] =
        world_from_joint[index(scene.goals[k].joint)].translation;
  }
  reached.com_in_world = centre_of_mass(scene.character, pose);
  return reached;
}

/// Returns all solvers, and marey's without limits to measure the cost of the limits.
std::vector<Contender> contenders_for(const PostureProblem& problem,
                                      const Character& without_limits) {
  auto contenders = all_contenders(problem);
  PostureProblem free = problem;
  free.character = &without_limits;
  for (const SolverKind& kind : marey_solvers()) {
    contenders.push_back({kind.name + ", no limits", kind.make(free)});
  }
  return contenders;
}

}  // namespace

std::vector<ResultTable> measure_reach() {
  const StandingScene scene = standing_scene();
  Character without_limits = scene.character;
  without_limits.limits.clear();
  struct Level {
    double share;
    std::string id;
    std::string title;
  };
  std::vector<ResultTable> tables;
  for (const Level& level : {Level{0.3, "reach_30", "0.3 of the way to a random posture"},
                             Level{0.6, "reach_60", "0.6 of the way to a random posture"},
                             Level{1.0, "reach_100", "random postures"}}) {
    testing::Dice dice(kSeed);
    std::vector<Reached> reached;
    for (int i = 0; i < kPostures; ++i) {
      reached.push_back(random_reach(scene, level.share, dice));
    }
    for (const bool with_balance : {false, true}) {
      Contest contest{
          level.id + (with_balance ? "_com" : ""),
          "within limits: " + level.title + (with_balance ? ", centre of mass" : ""),
          &scene.character,
          scene.goals,
          {}};
      for (const Reached& r : reached) {
        contest.tasks.push_back({&scene.reference, r.targets_in_world, r.com_in_world});
      }
      tables.push_back(compare_solvers(
          contest,
          contenders_for({&scene.character, scene.goals, with_balance}, without_limits)));
      tables.back().notes.emplace_back("Gauss-Newton knows no limits.");
      print_table(tables.back());
    }
  }
  return tables;
}

}  // namespace marey
