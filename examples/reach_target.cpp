// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Adapts a posture so that a hand reaches a point while the feet stay where they stand.
//
//     reach_target X Y Z
//
// in metres: Y is up, the body faces +Z and its left hand is towards +X.
#include <cstdio>
#include <cstdlib>

#include <glm/geometric.hpp>

#include "core/constraint.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "retarget/adapt/adapter.h"
#include "retarget/body/body_map.h"
#include "retarget/character/make_character.h"

using namespace marey;

namespace {

int fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.message().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return fail(bad_input("", "there is no target", "give X Y Z in metres"));
  const glm::dvec3 target(std::atof(argv[1]), std::atof(argv[2]), std::atof(argv[3]));

  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const auto map = retarget::map_body(skeleton);
  if (!map) return fail(map.error());
  const auto character = retarget::make_character("person", skeleton, *map);
  if (!character) return fail(character.error());

  ConstraintSet constraints;
  for (const char* foot : {"leftFoot", "rightFoot"}) {
    Constraint stand;
    stand.id = foot;
    stand.point.segment = foot;
    stand.goal = Support{};
    constraints.constraints.push_back(stand);
  }
  Constraint reach;
  reach.id = "reach";
  reach.point.segment = "leftHand";
  reach.goal = DistanceToPoint{.distance_m = 0.0, .p_in_world = target};
  constraints.constraints.push_back(reach);

  auto adapter = retarget::Adapter::make(*character, constraints, {});
  if (!adapter) return fail(adapter.error());
  const Pose standing = rest_pose(skeleton);
  Pose adapted;
  const retarget::AdaptReport report = adapter->adapt(standing, 0.0, adapted);

  // The result, measured by forward kinematics.
  const auto before = world_from_joints(skeleton, standing);
  const auto after = world_from_joints(skeleton, adapted);
  const auto joint = [&](HumanBone bone) { return index(*skeleton.find(bone)); };
  const std::size_t hand = joint(HumanBone::kLeftHand);
  const std::size_t foot = joint(HumanBone::kLeftFoot);
  std::printf("iterations %d\n", report.iterations);
  std::printf("distance_before_mm %.3f\n",
              1000.0 * glm::distance(before[hand].translation, target));
  std::printf("distance_after_mm %.3f\n",
              1000.0 * glm::distance(after[hand].translation, target));
  std::printf("foot_moved_mm %.3f\n",
              1000.0 * glm::distance(before[foot].translation, after[foot].translation));
  return 0;
}
