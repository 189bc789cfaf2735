// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/humanoid.h"
#include "core/motion.h"
#include "core/pose.h"
#include "retarget/adapt/adapter.h"
#include "retarget/body/body_map.h"
#include "retarget/character/make_character.h"
#include "tests/support/program/paths.h"

namespace marey::retarget {
namespace {

// The example of docs/adaptation.md, verbatim.
// [example]
Result<Motion> reach_for(const Motion& walk, const glm::dvec3& cup_in_world) {
  const auto map = map_body(walk.skeleton);
  if (!map) return map.error();
  const auto ann = make_character("Ann", walk.skeleton, *map);
  if (!ann) return ann.error();

  Constraint cup;
  cup.id = "cup";
  cup.point.segment = "rightHand";  // Its joint, the wrist; or any point next to it.
  cup.goal = DistanceToPoint{0.0, cup_in_world};
  cup.activation.start_s = 0.5;  // Before this time the motion of the hand is unchanged.
  cup.activation.start_duration_s = 0.4;
  Constraint stands;
  stands.id = "stands";
  stands.point.segment = "leftFoot";
  stands.goal = Support{};

  AdaptOptions options;
  options.balance = BalanceMode::kHorizontal;
  auto adapter = Adapter::make(*ann, {{cup, stands}, {}}, options);
  if (!adapter) return adapter.error();

  Motion out = walk;
  for (std::size_t frame = 0; frame < walk.poses.size(); ++frame) {
    const double time_s = static_cast<double>(frame) / walk.rate.hz;
    // A cup that another person holds would move here:
    adapter->constraint("cup")->set_target(cup_in_world);
    adapter->adapt(walk.poses[frame], time_s, out.poses[frame]);
  }
  return out;
}
// [example]

std::string text_of(const char* path) {
  std::ifstream file(marey::testing::source_dir().string() + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string between(const std::string& text, const std::string& a, const std::string& b) {
  const std::size_t begin = text.find(a);
  if (begin == std::string::npos) return a + " is missing";
  const std::size_t from = begin + a.size();
  return text.substr(from, text.find(b, from) - from);
}

TEST(AdapterExample, StandsInTheDocument) {
  // In two pieces, so that this line is not found.
  const std::string mark = std::string("// [exa") + "mple]\n";
  EXPECT_EQ(
      between(text_of("/docs/adaptation.md"), "```cpp\n", "```"),
      between(text_of("/tests/retarget/adapt/adapter_example_test.cpp"), mark, mark));
}

TEST(AdapterExample, TakesTheCup) {
  Motion still;
  still.skeleton = make_humanoid(average_proportions(1.75));
  still.rate.hz = 30.0;
  still.poses.assign(60, rest_pose(still.skeleton));
  const glm::dvec3 cup_in_world(-0.3, 1.1, 0.6);
  const auto out = reach_for(still, cup_in_world);
  ASSERT_TRUE(out) << out.error().message();
  const auto at = [&](std::size_t frame, HumanBone bone) {
    const auto joint = still.skeleton.find(bone);
    return world_from_joints(still.skeleton, out->poses[frame])[index(*joint)]
        .translation;
  };
  // A constraint's precision.
  EXPECT_LT(glm::distance(at(59, HumanBone::kRightHand), cup_in_world), 1e-3);
  EXPECT_GT(glm::distance(at(14, HumanBone::kRightHand), cup_in_world), 0.5)
      << "not before its start";
  // Accuracy of single precision.
  EXPECT_LT(glm::distance(at(59, HumanBone::kLeftFoot), at(0, HumanBone::kLeftFoot)),
            1e-5);
}

}  // namespace
}  // namespace marey::retarget
