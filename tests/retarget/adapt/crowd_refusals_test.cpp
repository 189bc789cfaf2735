// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "retarget/adapt/crowd.h"
#include "tests/retarget/adapt/crowd_scenes.h"
#include "tests/retarget/adapter_bodies.h"
#include "tests/support/bodies/quadruped.h"

/// Members that do not fit into a crowd, and their errors.
namespace marey::retarget {
namespace {

ConstraintSet one_hand() {
  return {{contact("hand", "leftHand", {0.3, 1.2, 0.3})}, {}};
}

Adapter somebody(const ConstraintSet& wishes = one_hand(),
                 const AdaptOptions& options = {}) {
  return make_adapter(human(false), wishes, options);
}

// Returns the error for a crowd of two ordinary members and `odd`; empty: no error.
std::string refused(Adapter odd) {
  std::vector<Adapter> members;
  members.push_back(somebody());
  members.push_back(somebody());
  members.push_back(std::move(odd));
  const auto crowd = Crowd::make(std::move(members));
  return crowd ? "" : crowd.error().message();
}

Character named(Character body) {
  body.name = "odd one";
  return body;
}

void expect_named(const std::string& message, const std::string& reason) {
  EXPECT_NE(message.find("odd one (member 2)"), std::string::npos) << message;
  EXPECT_NE(message.find(reason), std::string::npos) << message;
}

TEST(CrowdRefusals, IncludeACrowdWithoutMembers) {
  const auto crowd = Crowd::make({});
  ASSERT_FALSE(crowd);
  EXPECT_NE(crowd.error().message().find("no members"), std::string::npos);
}

TEST(CrowdRefusals, IncludeFewerThanOneThread) {
  for (const int threads : {0, -1}) {
    std::vector<Adapter> members;
    members.push_back(somebody());
    const auto crowd = Crowd::make(std::move(members), {LaneWidth::kOne, threads});
    ASSERT_FALSE(crowd);
    EXPECT_NE(crowd.error().message().find("thread"), std::string::npos);
  }
}

TEST(CrowdRefusals, IncludeAWidthThatTheProcessorDoesNotHave) {
  for (const int width : {0, 2, 8, 16, 32}) {
    const auto lanes = static_cast<LaneWidth>(width);
    bool exists = false;
    for (const LaneWidth own : lane_widths()) exists = exists || own == lanes;
    if (exists) continue;
    std::vector<Adapter> members;
    members.push_back(somebody());
    const auto crowd = Crowd::make(std::move(members), {lanes, 1});
    ASSERT_FALSE(crowd) << width;
    EXPECT_NE(crowd.error().message().find(std::to_string(width) + " lanes"),
              std::string::npos)
        << crowd.error().message();
  }
}

TEST(CrowdRefusals, IncludeAnotherSkeleton) {
  const Character animal = named(testing::make_quadruped());
  expect_named(
      refused(make_adapter(animal, {{contact("paw", "front left paw", {})}, {}})),
      "differ in structure");
  const Character longer =
      named(human_of(testing::with_vertebrae(testing::giant(), 7), false));
  expect_named(refused(make_adapter(longer, one_hand())), "differ in structure");
}

TEST(CrowdRefusals, IncludeLimitsThatOthersDoNotHave) {
  expect_named(refused(make_adapter(named(human(true)), one_hand())),
               "differ in structure");
}

TEST(CrowdRefusals, IncludeOtherGroups) {
  Character body = named(human(false));
  body.groups.front().balances = !body.groups.front().balances;
  expect_named(refused(make_adapter(body, one_hand())), "differ in structure");
}

TEST(CrowdRefusals, IncludeOtherConstraints) {
  const Character body = named(human(false));
  const auto expect_refused = [&](const ConstraintSet& wishes) {
    expect_named(refused(make_adapter(body, wishes)), "differ in structure");
  };
  expect_refused({{contact("hand", "rightHand", {})}, {}});
  expect_refused({{standing("hand", "leftFoot")}, {}});
  ConstraintSet more = one_hand();
  more.constraints.push_back(contact("foot", "leftFoot", {}));
  expect_refused(more);
  ConstraintSet shorter = one_hand();
  shorter.constraints[0].range = 3;
  expect_refused(shorter);
  expect_refused({});
}

TEST(CrowdRefusals, IncludeOtherOptions) {
  const auto expect_refused = [](const AdaptOptions& options) {
    expect_named(refused(make_adapter(named(human(false)), one_hand(), options)),
                 "options");
  };
  AdaptOptions options;
  options.method = Method::kThesis;
  expect_refused(options);
  options = {};
  options.control = Control::kBlend;
  expect_refused(options);
  options = {};
  options.max_iterations = 49;
  expect_refused(options);
  options = {};
  options.extremities_keep_orientation = true;
  expect_refused(options);
  // Horizontal and three-dimensional balance differ in numbers alone; with and without
  // balance differ in the rotating joints.
  options = {};
  options.balance = BalanceMode::kHorizontal;
  expect_named(refused(make_adapter(named(human(false)), one_hand(), options)),
               "member 2");
}

// Numbers may differ between members.
TEST(CrowdRefusals, ExcludeOtherValuesOfOptions) {
  AdaptOptions options;
  options.root_for_constraints = 0.3;
  options.root_for_balance = 0.2;
  options.constraint_threshold_m = 1e-3;
  options.balance_threshold_m = 1e-4;
  options.balance_precision_m = 2e-3;
  ConstraintSet wishes = one_hand();
  wishes.constraints[0].importance = 7.0;
  wishes.constraints[0].precision_m = 0.01;
  wishes.constraints[0].activation.start_s = 3.0;
  EXPECT_EQ(refused(make_adapter(named(human(false, 1.2)), wishes, options)), "");
}

// Lanes use one plan and one set of options, so a member must not change its own.
TEST(CrowdRefusals, IncludeChangesOfAMembersOptionsOrPlan) {
  std::vector<Adapter> members;
  members.push_back(make_adapter(human(false), one_hand()));
  auto crowd = Crowd::make(std::move(members), {LaneWidth::kOne, 1});
  ASSERT_TRUE(crowd);
  Adapter& member = (*crowd)[0];
  EXPECT_DEATH(member.set_options({}), "contract broken");
  auto hand = member.constraint("hand");
  ASSERT_TRUE(hand);
  EXPECT_DEATH(hand->set_offset({0.0, 0.0, 0.1}), "contract broken");
}

}  // namespace
}  // namespace marey::retarget
