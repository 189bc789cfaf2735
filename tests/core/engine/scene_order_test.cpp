// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/engine/scene_order.h"

#include <algorithm>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace marey {
namespace {

std::vector<SceneDependency> random_links(std::mt19937_64& random, std::size_t bodies) {
  std::vector<SceneDependency> links(random() % (2 * bodies));
  for (SceneDependency& link : links) {
    link.body = random() % bodies;
    link.on = random() % bodies;
    link.start_s = static_cast<double>(random() % 10);
    link.end_s = link.start_s + static_cast<double>(random() % 4);
  }
  return links;
}

bool is_active(const SceneDependency& link, double time_s) {
  return link.start_s <= time_s && time_s <= link.end_s;
}

/// True if bodies depend on themselves by any path, by transitive closure.
bool has_cycle(const std::vector<SceneDependency>& links,
               std::size_t bodies,
               double time_s) {
  std::vector<std::vector<bool>> reaches(bodies, std::vector<bool>(bodies));
  for (const SceneDependency& link : links) {
    if (is_active(link, time_s)) reaches[link.body][link.on] = true;
  }
  for (std::size_t k = 0; k < bodies; ++k) {
    for (std::size_t a = 0; a < bodies; ++a) {
      for (std::size_t b = 0; b < bodies; ++b) {
        if (reaches[a][k] && reaches[k][b]) reaches[a][b] = true;
      }
    }
  }
  for (std::size_t k = 0; k < bodies; ++k) {
    if (reaches[k][k]) return true;
  }
  return false;
}

TEST(SceneOrder, FindsTheEarliestCycleAndOnlyCycles) {
  int cycles = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    std::mt19937_64 random(seed);
    const std::size_t bodies = 2 + random() % 8;
    const auto links = random_links(random, bodies);
    std::optional<double> first_s;
    for (double time_s = 0.0; time_s < 14.0 && !first_s; time_s += 0.5) {
      if (has_cycle(links, bodies, time_s)) first_s = time_s;
    }
    const auto cycle = find_cycle(links, bodies);
    ASSERT_EQ(cycle.has_value(), first_s.has_value()) << seed;
    if (!cycle) continue;
    ++cycles;
    EXPECT_EQ(cycle->time_s, *first_s);
    for (std::size_t k = 0; k < cycle->links.size(); ++k) {
      EXPECT_TRUE(is_active(cycle->links[k], cycle->time_s));
      EXPECT_EQ(cycle->links[k].on, cycle->links[(k + 1) % cycle->links.size()].body);
    }
  }
  EXPECT_GT(cycles, 200);
  EXPECT_LT(cycles, 1800);
}

TEST(SceneOrder, RoundsPutABodyAfterItsTargets) {
  std::vector<std::size_t> rounds;
  int checked = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    std::mt19937_64 random(seed);
    const std::size_t bodies = 2 + random() % 30;
    const auto links = random_links(random, bodies);
    if (find_cycle(links, bodies)) continue;
    for (double time_s = 0.0; time_s < 14.0; time_s += 0.5) {
      solve_rounds(links, time_s, bodies, rounds);
      std::vector<bool> depends(bodies);
      for (const SceneDependency& link : links) {
        if (!is_active(link, time_s)) continue;
        EXPECT_GT(rounds[link.body], rounds[link.on]);
        depends[link.body] = true;
        ++checked;
      }
      for (std::size_t k = 0; k < bodies; ++k) {
        if (!depends[k]) {
          EXPECT_EQ(rounds[k], 0U);
        }
      }
    }
  }
  EXPECT_GT(checked, 1000);
}

Scene made_scene(std::vector<SceneAction> script) {
  Scene scene;
  scene.duration_s = 20.0;
  scene.bodies.push_back({.id = "a"});
  scene.script = std::move(script);
  return scene;
}

TEST(SceneOrder, TimesFollowFromTheFileWhereTheyCan) {
  SceneAction first{.id = "first", .body = "a", .deed = ScenePlay{"walk"}};
  first.time_s = 2.0;
  first.for_s = 3.0;
  SceneAction next{.id = "next", .body = "a", .deed = ScenePlay{"run"}, .after = "first"};
  SceneAction at_event = next;
  at_event.id = "at_event";
  at_event.event = "left.strike";
  at_event.for_s = 1.0;
  at_event.fade_out_s = 0.5;
  SceneAction stop{.body = "a", .deed = SceneStop{.action = "next"}, .time_s = 8.0};
  // In any order in the file.
  const Scene scene = made_scene({at_event, next, first, stop});
  const std::vector<ActionTime> times = action_times(scene);
  EXPECT_EQ(times[2].start_s, 2.0);
  EXPECT_DOUBLE_EQ(times[2].end_s, 5.3);
  EXPECT_EQ(times[1].start_s, 5.0);
  EXPECT_EQ(times[1].latest_start_s, 5.0);
  EXPECT_DOUBLE_EQ(times[1].end_s, 8.3);
  EXPECT_EQ(times[0].start_s, 2.0);
  EXPECT_DOUBLE_EQ(times[0].latest_start_s, 5.3);
  EXPECT_DOUBLE_EQ(times[0].end_s, 6.8);
}

TEST(SceneOrder, TheEndOfAClipIsNotKnown) {
  SceneAction first{.id = "first", .body = "a", .deed = ScenePlay{"walk"}};
  SceneAction next{.id = "next", .body = "a", .deed = ScenePlay{"run"}, .after = "first"};
  const std::vector<ActionTime> times = action_times(made_scene({first, next}));
  EXPECT_EQ(times[0].end_s, 20.0);
  EXPECT_EQ(times[1].start_s, 0.0);
  EXPECT_EQ(times[1].end_s, 20.0);
}

TEST(SceneAction, OnlyTheseHaveNoEnd) {
  const auto endless = [](SceneDeed deed) {
    return is_endless({.body = "a", .deed = std::move(deed)});
  };
  EXPECT_TRUE(endless(ScenePlay{.clip = "c", .loops = true}));
  EXPECT_TRUE(endless(SceneFollow{}));
  EXPECT_TRUE(endless(SceneCarry{}));
  EXPECT_TRUE(endless(SceneConstrain{}));
  EXPECT_TRUE(endless(SceneReach{.holds = true}));
  EXPECT_TRUE(endless(SceneSteer{.keeps = true}));
  EXPECT_FALSE(endless(ScenePlay{.clip = "c", .cycles = 3}));
  EXPECT_FALSE(endless(SceneStop{}));
  EXPECT_FALSE(endless(SceneThrow{}));
  EXPECT_FALSE(endless(SceneJump{}));
  EXPECT_FALSE(is_endless({.body = "a", .deed = SceneFollow{}, .for_s = 1.0}));
}

}  // namespace
}  // namespace marey
