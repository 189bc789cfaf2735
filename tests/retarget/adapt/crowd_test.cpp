// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/crowd.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "tests/retarget/adapt/crowd_scenes.h"
#include "tests/retarget/adapter_bodies.h"
#include "tests/support/bodies/quadruped.h"
#include "tests/support/program/count_allocations.h"

/// The results of a crowd equal those of its members' adapters, to the bit. Reference:
/// each member's adapter by itself.
namespace marey::retarget {
namespace {

constexpr std::size_t kMoments = 3;

Adapter adapter_for(const CrowdMember& member, const AdaptOptions& options) {
  Adapter adapter = make_adapter(member.character, member.wishes, options);
  if (member.carries) adapter.carry(member.character.loads[0].name, true);
  return adapter;
}

/// [moment][member].
using Answers = std::vector<std::vector<CrowdAnswer>>;

Answers one_by_one(const std::vector<CrowdMember>& members, const AdaptOptions& options) {
  Answers out(kMoments);
  for (const CrowdMember& member : members) {
    Adapter adapter = adapter_for(member, options);
    Pose pose;
    for (std::size_t n = 0; n < kMoments; ++n) {
      const CrowdQuestion& question = member.questions[n];
      ask(question, adapter);
      const AdaptReport report =
          adapter.adapt(question.reference, static_cast<double>(n), pose);
      out[n].push_back(answer_of(adapter, member.wishes, pose, report));
    }
  }
  return out;
}

// Members are in the crowd in the order of `places`.
Answers all_at_once(const std::vector<CrowdMember>& members,
                    const std::vector<std::size_t>& places,
                    const AdaptOptions& options,
                    const CrowdOptions& how) {
  std::vector<Adapter> adapters;
  for (const std::size_t i : places) adapters.push_back(adapter_for(members[i], options));
  auto crowd = Crowd::make(std::move(adapters), how);
  EXPECT_TRUE(crowd) << (crowd ? "" : crowd.error().message());
  Answers out(kMoments, std::vector<CrowdAnswer>(members.size()));
  std::vector<Pose> references(members.size());
  std::vector<Pose> poses(members.size());
  std::vector<AdaptReport> reports(members.size());
  for (std::size_t n = 0; n < kMoments; ++n) {
    for (std::size_t p = 0; p < places.size(); ++p) {
      ask(members[places[p]].questions[n], (*crowd)[p]);
      references[p] = members[places[p]].questions[n].reference;
    }
    crowd->adapt(references, static_cast<double>(n), poses, reports);
    for (std::size_t p = 0; p < places.size(); ++p) {
      out[n][places[p]] =
          answer_of((*crowd)[p], members[places[p]].wishes, poses[p], reports[p]);
    }
  }
  return out;
}

// For every width and number of threads, each with another order of members.
void expect_own_answers(const std::vector<CrowdMember>& members,
                        const AdaptOptions& options,
                        Dice& dice) {
  const Answers truth = one_by_one(members, options);
  std::vector<std::size_t> places(members.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  for (const LaneWidth width : lane_widths()) {
    for (const int threads : {1, 2, 3}) {
      const Answers found = all_at_once(members, places, options, {width, threads});
      for (std::size_t n = 0; n < kMoments; ++n) {
        for (std::size_t p = 0; p < places.size(); ++p) {
          const std::size_t i = places[p];
          EXPECT_EQ(difference(truth[n][i], found[n][i]), "")
              << "member " << i << " at place " << p << " of " << members.size()
              << ", moment " << n << ", " << static_cast<int>(width) << " lanes, "
              << threads << " threads";
          if (::testing::Test::HasFailure()) return;
        }
      }
      for (std::size_t p = places.size(); p > 1; --p) {
        const auto other =
            static_cast<std::size_t>(dice.between(0.0, static_cast<double>(p) - 1e-6));
        std::swap(places[p - 1], places[other]);
      }
    }
  }
}

class CrowdOfMany
    : public ::testing::TestWithParam<std::tuple<Method, CrowdTargets, BalanceMode>> {
 protected:
  [[nodiscard]] static AdaptOptions options() {
    AdaptOptions out;
    out.method = std::get<0>(GetParam());
    out.balance = std::get<2>(GetParam());
    return out;
  }
  [[nodiscard]] static std::vector<CrowdMember> members(const Character& body,
                                                        std::size_t count,
                                                        Dice& dice) {
    return make_members(body, std::get<1>(GetParam()), count, kMoments, dice);
  }
};

std::string name_of_case(const ::testing::TestParamInfo<CrowdOfMany::ParamType>& info) {
  const auto [method, wishes, balance] = info.param;
  std::string name = method == Method::kStrict ? "strict" : "thesis";
  constexpr const char* kTargets[] = {
      "Hands", "Supports", "Relations", "Fading", "NobodyAsks"};
  name += kTargets[static_cast<std::size_t>(wishes)];
  constexpr const char* kBalance[] = {"", "Balanced", "Balanced3d"};
  return name + kBalance[static_cast<std::size_t>(balance)];
}

INSTANTIATE_TEST_SUITE_P(Crowd,
                         CrowdOfMany,
                         ::testing::Combine(::testing::Values(Method::kStrict,
                                                              Method::kThesis),
                                            ::testing::Values(CrowdTargets::kHands,
                                                              CrowdTargets::kSupports,
                                                              CrowdTargets::kRelations,
                                                              CrowdTargets::kFading,
                                                              CrowdTargets::kInactive),
                                            ::testing::Values(BalanceMode::kOff,
                                                              BalanceMode::kHorizontal,
                                                              BalanceMode::k3d)),
                         name_of_case);

// 37 is not a multiple of any width, and lanes are refilled.
TEST_P(CrowdOfMany, AnswersAsItsMembersDo) {
  Dice dice(2001);
  expect_own_answers(members(human(false), 37, dice), options(), dice);
}

TEST_P(CrowdOfMany, AnswersAsItsMembersDoWithinLimits) {
  Dice dice(2002);
  expect_own_answers(members(human(true), 21, dice), options(), dice);
}

TEST_P(CrowdOfMany, MatchesItsMembersForQuadrupeds) {
  Dice dice(2003);
  expect_own_answers(members(testing::make_quadruped(), 21, dice), options(), dice);
}

TEST_P(CrowdOfMany, AnswersAsItsMembersDoWhenTheyCompromise) {
  Dice dice(2004);
  AdaptOptions blend = options();
  blend.control = Control::kBlend;
  blend.extremities_keep_orientation = true;
  expect_own_answers(members(human(true), 21, dice), blend, dice);
}

TEST_P(CrowdOfMany, AnswersAsItsMembersDoWhenTheyMayNotFinish) {
  for (const int maximum : {1, 6}) {
    Dice dice(2005);
    AdaptOptions few = options();
    few.max_iterations = maximum;
    expect_own_answers(members(human(false), 21, dice), few, dice);
  }
}

// A body for which single precision finds no step does not affect its neighbours.
TEST_P(CrowdOfMany, MatchesItsMembersWhenSomeHaveFarTargets) {
  Dice dice(2008);
  auto some = members(human(false), 21, dice);
  for (std::size_t i = 0; i < some.size(); i += 2) {
    for (CrowdQuestion& question : some[i].questions) {
      for (Constraint& wish : question.wishes.constraints) {
        const glm::dvec3 place = std::pow(10.0, dice.between(1, 4)) * dice.direction();
        if (auto* support = std::get_if<Support>(&wish.goal)) {
          if (support->footprint_in_world) support->footprint_in_world = place;
        } else if (auto* point = std::get_if<DistanceToPoint>(&wish.goal)) {
          point->p_in_world = place;
        }
      }
    }
  }
  expect_own_answers(some, options(), dice);
}

// Fewer members than lanes, and equally many.
TEST_P(CrowdOfMany, MayBeFew) {
  Dice dice(2006);
  const auto all = members(human(false), 16, dice);
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{16}}) {
    const std::vector<CrowdMember> few(all.begin(),
                                       all.begin() + static_cast<std::ptrdiff_t>(count));
    expect_own_answers(few, options(), dice);
  }
}

TEST_P(CrowdOfMany, AllocatesNothingAfterTheFirstPostures) {
  Dice dice(2007);
  const auto crowd_members = members(human(true), 21, dice);
  for (const LaneWidth width : lane_widths()) {
    std::vector<Adapter> adapters;
    std::vector<Pose> references;
    for (const CrowdMember& member : crowd_members) {
      adapters.push_back(adapter_for(member, options()));
      references.push_back(member.questions[0].reference);
    }
    auto crowd = Crowd::make(std::move(adapters), {width, 1});
    ASSERT_TRUE(crowd);
    std::vector<Pose> out(crowd->size());
    std::vector<AdaptReport> reports(crowd->size());
    crowd->adapt(references, 0.0, out, reports);
    const long before = testing::allocations();
    for (int i = 1; i < 10; ++i) crowd->adapt(references, 0.2 * i, out, reports);
    EXPECT_EQ(testing::allocations() - before, 0) << static_cast<int>(width);
  }
}

}  // namespace
}  // namespace marey::retarget
