// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/cyclify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "edit/ops/close_cycle.h"
#include "edit/state/plant_feet.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "tests/edit/varied_walk.h"

namespace marey::edit {
namespace {

struct Looped {
  Result<EditState> state;
  OpReport report;
  [[nodiscard]] double figure(const std::string& name) const {
    for (const auto& [key, value] : report.figures) {
      if (key == name) return value;
    }
    ADD_FAILURE() << "no figure " << name;
    return 0.0;
  }
};

EditState walk_state(const VariedWalkOptions& options) {
  auto state = make_edit_state(varied_walk(options).motion);
  EXPECT_TRUE(state);
  return std::move(*state);
}

Looped looped(const EditState& state, const CyclifyOp& op, EditOp common = {}) {
  common.parameters = op;
  const EditInputs inputs;
  OpReport report;
  auto made = apply_cyclify(op, {common, 4, inputs}, state, report);
  return {std::move(made), std::move(report)};
}

std::vector<glm::dvec3> joints_of(const Motion& motion, std::size_t frame) {
  std::vector<glm::dvec3> out;
  for (const auto& joint : world_from_joints(motion.skeleton, motion.poses[frame])) {
    out.push_back(joint.translation);
  }
  return out;
}

double largest_distance(const std::vector<glm::dvec3>& a,
                        const std::vector<glm::dvec3>& b,
                        const PlanarMove& b_move = {}) {
  double largest = 0.0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    largest = std::max(largest, glm::distance(a[j], b_move(b[j])));
  }
  return largest;
}

// Largest difference of the velocities before and after a frame, by cubics through four
// frames on either side. [m/s]
double velocity_jump(const Motion& motion, std::size_t frame) {
  constexpr std::array<double, 4> kSlope{-11.0 / 6.0, 3.0, -1.5, 1.0 / 3.0};
  std::vector<glm::dvec3> jump(motion.skeleton.joints.size(), glm::dvec3(0.0));
  for (std::size_t k = 0; k < 4; ++k) {
    const auto after = joints_of(motion, frame + k);
    const auto before = joints_of(motion, frame - k);
    for (std::size_t j = 0; j < jump.size(); ++j) {
      jump[j] += kSlope[k] * motion.rate.hz * (after[j] + before[j]);
    }
  }
  double largest = 0.0;
  for (const glm::dvec3& v : jump) largest = std::max(largest, glm::length(v));
  return largest;
}

int count_of(const EditState& state, const std::string& text) {
  return static_cast<int>(
      std::count_if(state.annotations.notes.begin(),
                    state.annotations.notes.end(),
                    [&](const Annotation& note) { return note.text == text; }));
}

TEST(Cyclify, RecoversThePeriodAndHasNoDriftButTheTravel) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    VariedWalkOptions options = random_walk_options(seed);
    options.noise_rad = 0.003;
    options.noise_m = 0.001;
    const VariedWalk walk = varied_walk(options);
    const auto state = make_edit_state(walk.motion);
    ASSERT_TRUE(state);
    CyclifyOp op;
    op.cycles = 10;
    op.drift = CycleDrift::kKeep;
    const Looped loop = looped(*state, op);
    ASSERT_TRUE(loop.state) << loop.state.error().message();
    const int frames = static_cast<int>(loop.figure("frames"));
    EXPECT_EQ(loop.state->frame_count(), 10 * frames);
    // Half a frame for the grid, and the noise.
    EXPECT_NEAR(frames, walk.period_s * options.hz, 0.5 + 0.015 * frames) << seed;
    EXPECT_NEAR(loop.figure("turn_deg") / 57.29578, walk.travel.turn_rad, 0.02) << seed;
    // Only the first and the second copy are needed to know where the tenth is.
    const Motion& motion = loop.state->motion;
    const MatchPoints points = match_points(motion, state->map);
    const PlanarMove step =
        match_windows(points, frames, points, 0, {.half_window = 0}).a_from_b;
    EXPECT_LT(largest_distance(joints_of(motion, static_cast<std::size_t>(9 * frames)),
                               joints_of(motion, 0),
                               power(step, 9)),
              1e-9)
        << seed;
  }
}

TEST(Cyclify, GoesStraightByDefault) {
  VariedWalkOptions options;
  options.turn_rad = 0.3;
  const EditState state = walk_state(options);
  CyclifyOp op;
  op.cycles = 10;
  const Looped loop = looped(state, op);
  ASSERT_TRUE(loop.state);
  const Motion& motion = loop.state->motion;
  const auto frames = static_cast<std::size_t>(loop.figure("frames"));
  const glm::dvec3 first = motion.poses[0].root_in_world;
  const glm::dvec3 step = motion.poses[frames].root_in_world - first;
  // The arc of one metre becomes a line of one metre.
  EXPECT_NEAR(glm::length(step), 1.0, 0.004);
  const glm::dvec3 last = motion.poses[9 * frames].root_in_world;
  EXPECT_LT(glm::distance(last, first + 9.0 * step), 1e-9);
  EXPECT_LT(measure_slide(*loop.state).mean_cm_per_s, 0.3);
}

TEST(Cyclify, StaysInPlaceIfAsked) {
  const EditState state = walk_state({});
  CyclifyOp op;
  op.cycles = 3;
  op.drift = CycleDrift::kNone;
  const Looped loop = looped(state, op);
  ASSERT_TRUE(loop.state);
  const auto frames = static_cast<std::size_t>(loop.figure("frames"));
  EXPECT_LT(largest_distance(joints_of(loop.state->motion, 0),
                             joints_of(loop.state->motion, 2 * frames)),
            1e-12);
  for (const Pose& pose : loop.state->motion.poses) {
    EXPECT_LT(
        glm::distance(pose.root_in_world, loop.state->motion.poses[0].root_in_world),
        0.1);
  }
  EXPECT_TRUE(loop.state->contacts.feet[0].stance.empty());
  EXPECT_EQ(count_of(*loop.state, "left.strike"), 3);
  ASSERT_FALSE(loop.report.findings.empty());
  EXPECT_EQ(loop.report.findings.back().id, "in_place");
}

TEST(Cyclify, PlantsTheFeetOfTenCycles) {
  for (unsigned seed = 0; seed < 9; ++seed) {
    VariedWalkOptions options = random_walk_options(seed);
    options.noise_rad = 0.004;
    options.noise_m = 0.002;
    CyclifyOp op;
    op.cycles = 10;
    const Looped loop = looped(walk_state(options), op);
    ASSERT_TRUE(loop.state);
    EXPECT_LT(measure_slide(*loop.state).mean_cm_per_s, 0.3) << seed;
  }
}

TEST(Cyclify, JoinsAMotionThatGrows) {
  // As cut, places jump, by more than 1 m/s at any rate. In a smooth loop the estimate of
  // the jump is the error of the cubics, which falls with the rate.
  std::vector<double> jumps;
  for (const double hz : {120.0, 480.0}) {
    VariedWalkOptions options;
    options.hz = hz;
    options.growth_per_s = 0.3;
    CyclifyOp op;
    op.cycles = 2;
    const Looped loop = looped(walk_state(options), op);
    ASSERT_TRUE(loop.state);
    EXPECT_GT(loop.figure("gap_worst_mm"), 5.0);
    jumps.push_back(velocity_jump(loop.state->motion,
                                  static_cast<std::size_t>(loop.figure("frames"))));
  }
  EXPECT_LT(jumps[1], 0.25 * jumps[0]);
  EXPECT_LT(jumps[1], 0.02);
}

TEST(Cyclify, AcceleratesAtTheSeamAsInside) {
  int above = 0;
  constexpr int kSeeds = 20;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    VariedWalkOptions options = random_walk_options(seed);
    options.growth_per_s = 0.1;
    options.noise_rad = 0.002;
    const Looped loop = looped(walk_state(options), {});
    ASSERT_TRUE(loop.state);
    if (loop.figure("seam_acceleration_m_per_s2") >
        loop.figure("inside_acceleration_p95_m_per_s2")) {
      ++above;
    }
  }
  // One of two frames chosen at random is above the 95th percentile in 10 % of cases.
  EXPECT_LE(above, kSeeds / 5);
}

TEST(CloseCycle, RepeatsPlantedCyclesExactly) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    VariedWalkOptions options = random_walk_options(seed);
    options.growth_per_s = 0.1;
    options.noise_rad = 0.004;
    options.noise_m = 0.002;
    const VariedWalk walk = varied_walk(options);
    const auto state = make_edit_state(walk.motion);
    ASSERT_TRUE(state);
    CycleSpec spec;
    spec.first = 0.6 * options.hz;
    spec.period_frames = walk.period_s * options.hz;
    spec.travel = walk.travel;
    spec.drift = seed % 2 == 0 ? CycleDrift::kStraight : CycleDrift::kKeep;
    const ClosedCycle closed = close_cycle(*state, spec);
    // The seam between the second and the third copy lies inside three planted copies:
    // the frames on both sides of it are those of the seam of the result.
    const auto n = static_cast<std::size_t>(cycle_frames(spec));
    for (std::size_t k = n; k < 2 * n; ++k) {
      EXPECT_LT(largest_distance(joints_of(closed.cycle.motion, k - n),
                                 joints_of(closed.three, k)),
                1e-12);
    }
    for (const std::size_t k : {n - 1, n, n + 1}) {
      EXPECT_LT(
          largest_distance(
              joints_of(closed.three, k + n), joints_of(closed.three, k), closed.travel),
          1e-9)
          << "seed " << seed << " frame " << k;
    }
  }
}

TEST(Cyclify, DoesNotMoveFeetThatStandThroughout) {
  // Hips turn to and fro and come back three degrees further, on standing feet.
  Motion motion = varied_walk({.duration_s = 3.0}).motion;
  const Pose rest = rest_pose(motion.skeleton);
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    const double cycles = static_cast<double>(t) / 66.0;
    const double turn = 0.1 * std::sin(6.283185307 * cycles) + 0.05 * cycles;
    motion.poses[t] = rest;
    motion.poses[t].root_in_world.y -= 0.03;
    motion.poses[t].parent_from_joint[0] = glm::angleAxis(turn, glm::dvec3(0, 1, 0));
  }
  auto state = make_edit_state(motion);
  ASSERT_TRUE(state);
  // The legs follow the hips: put the feet back to where they stood first.
  for (auto& foot : state->contacts.feet) {
    foot.heel = foot.ball = foot.stance = {{0, state->frame_count() - 1}};
  }
  plant_feet(*state);
  CyclifyOp op;
  op.from = AtFrame{40};
  op.to = AtFrame{106};
  op.cycles = 3;
  const Looped loop = looped(*state, op);
  ASSERT_TRUE(loop.state) << loop.state.error().message();
  EXPECT_EQ(loop.figure("turn_deg"), 0.0);
  EXPECT_EQ(loop.figure("travel_m"), 0.0);
  EXPECT_LT(measure_slide(*loop.state).mean_cm_per_s, 0.01);
  EXPECT_LT(largest_distance(joints_of(loop.state->motion, 0),
                             joints_of(loop.state->motion, 132)),
            1e-9);
}

TEST(Cyclify, RefusesHalfACycleWithItsFigures) {
  const EditState state = walk_state({});
  CyclifyOp op;
  op.from = AtFrame{60};
  op.to = AtFrame{93};
  const Looped refused = looped(state, op);
  ASSERT_FALSE(refused.state);
  const std::string text = refused.state.error().message();
  EXPECT_NE(text.find("not cyclic: frames 60 and 93 differ by"), std::string::npos)
      << text;
  EXPECT_NE(text.find("0.15 leg lengths"), std::string::npos) << text;
  op.force = true;
  const Looped forced = looped(state, op);
  ASSERT_TRUE(forced.state);
  EXPECT_EQ(forced.state->frame_count(), 33);
  ASSERT_FALSE(forced.report.findings.empty());
  EXPECT_EQ(forced.report.findings[0].id, "loop_gap");
}

TEST(Cyclify, RefusesABodyThatStands) {
  Motion motion = varied_walk({}).motion;
  motion.poses.assign(300, motion.poses.front());
  const auto state = make_edit_state(motion);
  ASSERT_TRUE(state);
  const Looped refused = looped(*state, {});
  ASSERT_FALSE(refused.state);
  EXPECT_NE(refused.state.error().message().find("do not repeat"), std::string::npos);
}

TEST(Cyclify, NamesTheKeyThatIsWrong) {
  const EditState state = walk_state({});
  const auto message = [&](const CyclifyOp& op, const EditOp& common = {}) {
    const Looped refused = looped(state, op, common);
    return refused.state ? "" : refused.state.error().message();
  };
  EditOp common;
  common.groups = {EditGroup::kTrunk};
  EXPECT_NE(message({}, common).find("groups"), std::string::npos);
  common = {};
  common.blend_s = 0.2;
  EXPECT_NE(message({}, common).find("blend_s"), std::string::npos);
  CyclifyOp op;
  op.cycles = 0;
  EXPECT_NE(message(op).find("cycles"), std::string::npos);
  op = {};
  op.from = AtFrame{10};
  EXPECT_NE(message(op).find("from"), std::string::npos);
  op.to = AtFrame{5};
  EXPECT_NE(message(op).find("after cycle_from"), std::string::npos);
  op = {};
  op.min_period_s = 20.0;
  EXPECT_NE(message(op).find("20.000"), std::string::npos);
}

TEST(Cyclify, CarriesAnnotationsLineageAndUncertainty) {
  EditState state = walk_state({.noise_m = 0.002});
  const auto frames = static_cast<std::size_t>(state.frame_count());
  state.uncertainty.assign(
      frames,
      std::vector<JointUncertainty>(state.motion.skeleton.joints.size(),
                                    {0.004, Source::kMeasured, Source::kMeasured}));
  state.annotations.notes = {{"walk", 0.0, state.duration_s()}};
  state.annotations.curves = {{"blend", std::vector<double>(frames, 0.5)}};
  CyclifyOp op;
  op.cycles = 4;
  const Looped loop = looped(state, op);
  ASSERT_TRUE(loop.state);
  const EditState& out = *loop.state;
  const auto count = static_cast<std::size_t>(out.frame_count());
  EXPECT_EQ(out.uncertainty.size(), count);
  EXPECT_EQ(out.lineage.frames.size(), count);
  ASSERT_EQ(out.annotations.curves.size(), 1U);
  EXPECT_EQ(out.annotations.curves[0].values.size(), count);
  EXPECT_EQ(out.contacts.frame_count, out.frame_count());
  EXPECT_EQ(count_of(out, "walk"), 4);
  EXPECT_EQ(count_of(out, "loops"), 1);
  for (const char* event : {"left.strike", "left.toe_off", "right.strike"}) {
    EXPECT_EQ(count_of(out, event), 4) << event;
  }
  EXPECT_EQ(ops_of(out.lineage, 3), std::vector<int>{4});
  const double start = loop.figure("first_frame");
  EXPECT_NEAR(out.lineage.frames[0].source_frame, start, 1e-9);
  EXPECT_NEAR(out.lineage.frames[count / 4].source_frame, start, 1e-9);
  EXPECT_EQ(out.uncertainty[0][0].sigma_m, 0.004);
}

TEST(Cyclify, SearchesTheSpanOnly) {
  const EditState state = walk_state({.duration_s = 8.0, .noise_m = 0.002});
  EditOp common;
  common.span.from = AtTime{4.0};
  common.span.to = AtTime{6.0};
  const Looped loop = looped(state, {}, common);
  ASSERT_TRUE(loop.state);
  EXPECT_GE(loop.figure("first_frame"), 240.0);
  EXPECT_LE(loop.figure("first_frame") + loop.figure("period_frames"), 360.0);
}

TEST(Cyclify, GivesTheSameBytesTwice) {
  const EditState state = walk_state({.noise_m = 0.002});
  const Looped a = looped(state, {});
  const Looped b = looped(state, {});
  ASSERT_TRUE(a.state && b.state);
  ASSERT_EQ(a.state->motion.poses.size(), b.state->motion.poses.size());
  for (std::size_t t = 0; t < a.state->motion.poses.size(); ++t) {
    EXPECT_EQ(a.state->motion.poses[t].root_in_world,
              b.state->motion.poses[t].root_in_world);
    EXPECT_EQ(a.state->motion.poses[t].parent_from_joint,
              b.state->motion.poses[t].parent_from_joint);
  }
}

}  // namespace
}  // namespace marey::edit
