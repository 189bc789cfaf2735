// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Adapts a crowd: each member of another size, each with a hand target of its own.
//
//     crowd MEMBERS
#include "retarget/adapt/crowd.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/constraint.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/character/make_character.h"

using namespace marey;

namespace {

int fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.message().c_str());
  return 1;
}

/// Returns an adapter for a body whose right hand must be in front of its shoulder.
Result<retarget::Adapter> member(const Skeleton& skeleton) {
  const auto map = retarget::map_body(skeleton);
  if (!map) return map.error();
  const auto character = retarget::make_character("member", skeleton, *map);
  if (!character) return character.error();
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  const auto shoulder =
      rest[index(*skeleton.find(HumanBone::kRightUpperArm))].translation;
  Constraint reach;
  reach.id = "reach";
  reach.point.segment = "rightHand";
  reach.goal = DistanceToPoint{
      .distance_m = 0.0,
      .p_in_world = shoulder + 0.5 * map->arm_length_m * glm::dvec3(-0.4, 0.2, 1.4)};
  return retarget::Adapter::make(*character, {{reach}, {}}, {});
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc == 2 ? std::atoi(argv[1]) : 0;
  std::vector<retarget::Adapter> members;
  std::vector<Pose> standing;
  std::vector<Pose> alone(static_cast<std::size_t>(std::max(count, 0)));
  for (std::size_t i = 0; i < alone.size(); ++i) {
    const Skeleton skeleton =
        make_humanoid(average_proportions(1.2 + 0.01 * static_cast<double>(i % 80)));
    auto one = member(skeleton);
    if (!one) return fail(one.error());
    standing.push_back(rest_pose(skeleton));
    (void)one->adapt(standing.back(), 0.0, alone[i]);
    members.push_back(*std::move(one));
  }

  auto crowd = retarget::Crowd::make(std::move(members), {.threads = 2});
  if (!crowd) return fail(crowd.error());
  std::vector<Pose> together(crowd->size());
  std::vector<retarget::AdaptReport> reports(crowd->size());
  crowd->adapt(standing, 0.0, together, reports);

  double worst_m = 0.0;
  int same = 0;
  for (std::size_t i = 0; i < crowd->size(); ++i) {
    worst_m = std::max(worst_m, reports[i].worst_error_m);
    if (together[i].parent_from_joint == alone[i].parent_from_joint) ++same;
  }
  std::printf("members %zu\nworst_error_mm %.3f\nsame_as_alone %d\n",
              crowd->size(),
              1000.0 * worst_m,
              same);
  return 0;
}
