// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/stage_session.h"

#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/stage/live/stage_live.h"
#include "tests/app/stage/live/live_scene.h"

namespace marey::app {
namespace {

using namespace std::chrono_literals;
using live::RunAction;

constexpr std::size_t kLeft = 0;  // Handles, in the order of the scene's targets.
constexpr std::size_t kCup = 1;

StageSession session_at(Timestamp now) {
  auto session = StageSession::make(live_scene(), now);
  EXPECT_TRUE(session) << session.error().message();
  return *std::move(session);
}

/// Plays for a time, step by step.
void play(StageSession& session, Timestamp& now, Timestamp lasts) {
  for (const Timestamp end = now + lasts; now < end; now += 5ms) session.update(now);
}

double wrist_error_m(const StageSession& session, std::size_t body) {
  const StageBody& one = session.run().body(body);
  const auto joints = world_from_joints(one.character.skeleton, session.run().pose(body));
  const glm::dvec3 wrist = joints[index(one.map.limbs[0]->end)].translation;
  return glm::distance(wrist, session.run().target_in_world(kLeft, body));
}

TEST(StageSession, FollowsTheClockThroughPauseAndRestart) {
  StageSession session = session_at(3s);
  EXPECT_EQ(session.update(3s + 50ms), 3);
  EXPECT_NEAR(session.run().time_s(), 0.05, 1e-9);
  ASSERT_TRUE(session.apply(RunAction::kPause, 3s + 50ms));
  EXPECT_EQ(session.update(9s), 0);
  EXPECT_FALSE(session.next_frame());
  ASSERT_TRUE(session.apply(RunAction::kPlay, 10s));
  EXPECT_EQ(session.update(10s + 50ms), 3);
  EXPECT_NEAR(session.run().time_s(), 0.1, 1e-9);
  ASSERT_TRUE(session.apply(RunAction::kPause, 11s));
  ASSERT_TRUE(session.apply(RunAction::kRestart, 12s));
  EXPECT_TRUE(session.is_playing());
  EXPECT_EQ(session.run().time_s(), 0.0);
  EXPECT_EQ(session.update(12s + 20ms), 1);
}

TEST(StageSession, GoesOnAfterTheDuration) {
  StageSession session = session_at(0s);
  Timestamp now = 0s;
  play(session, now, 4s);
  EXPECT_TRUE(session.run().is_over());
  EXPECT_NEAR(session.run().time_s(), 4.0, 0.02);
}

TEST(StageSession, MovesTheTargetsOfAllUsersInTheirFramesAndProportions) {
  StageSession session = session_at(0s);
  Timestamp now = 0s;
  play(session, now, 1s);
  const glm::dvec3 moved{0.02, 0.05, -0.04};
  std::vector<glm::dvec3> before;
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_LT(wrist_error_m(session, b), 0.002) << b;
    before.push_back(session.run().target_in_world(kLeft, b));
  }
  const glm::dvec3 to = session.targets()[kLeft].p_in_world + moved;
  ASSERT_TRUE(session.apply(MoveTarget{kLeft, to}, now));
  EXPECT_TRUE(session.targets()[kLeft].held);
  play(session, now, 1s);
  const double stature_m = session.run().body(0).stature_m;
  for (std::size_t b = 0; b < 3; ++b) {
    // All bodies have the same heading.
    const glm::dvec3 expected =
        before[b] + session.run().body(b).stature_m / stature_m * moved;
    EXPECT_LT(glm::distance(session.run().target_in_world(kLeft, b), expected), 1e-9)
        << b;
    EXPECT_LT(wrist_error_m(session, b), 0.002) << b;
  }
  ASSERT_TRUE(session.apply(ReleaseTarget{kLeft}, now));
  play(session, now, 1s);
  EXPECT_FALSE(session.targets()[kLeft].held);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_LT(glm::distance(session.run().target_in_world(kLeft, b), before[b]), 1e-9)
        << b;
  }
}

TEST(StageSession, HoldsATargetInTheWorldUntilItIsReleased) {
  StageSession session = session_at(0s);
  Timestamp now = 0s;
  play(session, now, 300ms);
  ASSERT_TRUE(session.apply(HoldTarget{kCup}, now));
  const glm::dvec3 held = session.targets()[kCup].p_in_world;
  play(session, now, 300ms);
  EXPECT_EQ(session.run().target_in_world(kCup, 0), held);
  ASSERT_TRUE(session.apply(ReleaseTarget{kCup}, now));
  play(session, now, 100ms);
  EXPECT_GT(glm::distance(session.targets()[kCup].p_in_world, held), 0.01);
}

TEST(StageSession, ShowsADraggedTargetDuringAPause) {
  StageSession session = session_at(0s);
  ASSERT_TRUE(session.apply(RunAction::kPause, 0s));
  ASSERT_TRUE(session.apply(MoveTarget{kCup, {1.0, 2.0, 3.0}}, 0s));
  EXPECT_EQ(session.targets()[kCup].p_in_world, glm::dvec3(1.0, 2.0, 3.0));
  ASSERT_TRUE(session.apply(RunAction::kRestart, 0s));
  EXPECT_FALSE(session.targets()[kCup].held);
}

TEST(StageSession, OffersTheTargetsOfTheScene) {
  const StageSession session = session_at(0s);
  ASSERT_EQ(session.handles().size(), 3U);
  EXPECT_EQ(session.handles()[kLeft].id, "left");
  EXPECT_TRUE(session.handles()[kCup].draggable);
  EXPECT_FALSE(session.handles()[2].draggable);
}

TEST(StageSession, MeasuresTheFiguresOfTheSceneSinceTheLastReport) {
  StageSession session = session_at(0s);
  Timestamp now = 0s;
  play(session, now, 1s);
  (void)session.report_figures();
  play(session, now, 100ms);
  EXPECT_EQ(session.run().record().step_count(), 6U);
  const auto figures = session.report_figures();
  ASSERT_EQ(figures.size(), 2U);
  EXPECT_EQ(figures[0].name, "wrist_error leftHand");
  ASSERT_TRUE(figures[0].value);
  EXPECT_LT(*figures[0].value, 1.0);
  EXPECT_EQ(figures[0].passed, true);
  EXPECT_EQ(figures[1].name, "feet_slide");
  ASSERT_TRUE(figures[1].value);
  EXPECT_LT(*figures[1].value, 0.1);
  // Nothing new is measured: the values stay.
  EXPECT_EQ(session.report_figures()[0].value, figures[0].value);
}

TEST(StageSession, EmptiesTheRecordWithoutRequestsForReports) {
  StageSession session = session_at(0s);
  Timestamp now = 0s;
  for (int i = 0; i < 30; ++i) {
    play(session, now, 100ms);
    EXPECT_LE(session.run().record().step_count(), 61U);
  }
}

/// A clock that sleeps up to `late` longer than asked.
StageLoopClock late_clock(Timestamp& now, Timestamp late, std::mt19937& random) {
  return {[&now] { return now; },
          [&now, late, &random](Timestamp until) {
            const auto range = static_cast<std::uint32_t>(late.count()) + 1U;
            now = std::max(now, until) + Timestamp(random() % range);
          }};
}

TEST(StageLoop, MakesAllStepsOfALateClock) {
  for (const Timestamp late : {Timestamp(0), Timestamp(2ms), Timestamp(60ms)}) {
    Timestamp now = 100s;
    std::mt19937 random(1);
    StageSession session = session_at(now);
    StageVmc vmc;
    const auto figures =
        run_stage_loop({session, vmc, nullptr}, {5.0, {}}, late_clock(now, late, random));
    EXPECT_NEAR(static_cast<double>(figures.steps), 300.0, 6.0);
    EXPECT_NEAR(session.run().time_s(), seconds(now - 100s), 0.1);
    EXPECT_EQ(session.skipped(), 0);
    if (late == Timestamp(0)) {
      EXPECT_EQ(figures.frames, figures.steps);
    }
  }
}

TEST(StageLoop, EndsWhenItIsStopped) {
  Timestamp now = 0s;
  std::mt19937 random(1);
  StageSession session = session_at(now);
  StageVmc vmc;
  StageLoopOptions options;
  options.is_stopped = [&now] { return now >= 1s; };
  const auto figures =
      run_stage_loop({session, vmc, nullptr}, options, late_clock(now, 0ms, random));
  EXPECT_NEAR(static_cast<double>(figures.steps), 60.0, 1.0);
}

}  // namespace
}  // namespace marey::app
