// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Laws that operations and recipes obey, over seeded random cases.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "edit/apply_op.h"
#include "edit/render.h"
#include "edit/state/resolve_moment.h"
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"
#include "tests/edit/varied_walk.h"
#include "tests/support/files/random_recipe.h"

namespace marey::edit {
namespace {

using testing::Dice;

EditState random_walk(unsigned seed) {
  VariedWalkOptions options = random_walk_options(seed);
  options.hz = 60.0;
  options.duration_s = 4.0;
  options.noise_rad = 0.005;
  options.noise_m = 0.001;
  return state_of(varied_walk(options).motion);
}

EditOp over(EditOpParameters parameters, double from_s, double to_s, double blend_s) {
  EditOp op{std::move(parameters)};
  op.span = {AtTime{from_s}, AtTime{to_s}};
  op.blend_s = blend_s;
  return op;
}

EditState applied(const EditOp& op, const EditState& state) {
  const EditInputs inputs;
  OpReport report;
  auto out = apply_op({op, 0, inputs}, state, report);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return out ? std::move(out->front()) : state;
}

double largest_difference_m(const EditState& a, const EditState& b) {
  EXPECT_EQ(a.frame_count(), b.frame_count());
  double largest = 0.0;
  for (int t = 0; t < std::min(a.frame_count(), b.frame_count()); ++t) {
    largest = std::max(largest, pose_distance_m(a.motion, b.motion, t));
  }
  return largest;
}

bool same_poses_to_the_bit(const EditState& a, const EditState& b) {
  return a.motion.poses.size() == b.motion.poses.size() &&
         std::equal(a.motion.poses.begin(),
                    a.motion.poses.end(),
                    b.motion.poses.begin(),
                    same_pose);
}

OffsetOp random_offset(Dice& dice) {
  constexpr HumanBone kBones[] = {HumanBone::kLeftUpperArm,
                                  HumanBone::kRightLowerArm,
                                  HumanBone::kHead,
                                  HumanBone::kSpine};
  OffsetOp out;
  out.bone = kBones[static_cast<std::size_t>(dice.between(0.0, 3.999))];
  out.rotation = rotation_from_vector(
      {dice.between(-0.4, 0.4), dice.between(-0.4, 0.4), dice.between(-0.4, 0.4)});
  return out;
}

/// An operation on part of the motion that does not look beyond it, with its fades.
EditOp local_op(Dice& dice, double from_s, double to_s) {
  const double blend_s = dice.between(0.0, 0.2);
  const double kind = dice.between(0.0, 4.0);
  if (kind < 1.0) return over(random_offset(dice), from_s, to_s, blend_s);
  if (kind < 2.0) {
    PoseOp pose;
    const OffsetOp offset = random_offset(dice);
    pose.at = AtTime{0.5 * (from_s + to_s)};
    pose.bone = offset.bone;
    pose.rotation = offset.rotation;
    pose.width_s = 0.5 * (to_s - from_s);
    return EditOp{pose};
  }
  if (kind < 3.0) {
    PoseOp pose;
    pose.at = AtTime{0.5 * (from_s + to_s)};
    pose.bone = HumanBone::kLeftHand;
    pose.moved_m = glm::dvec3(dice.between(-0.1, 0.1), dice.between(-0.1, 0.1), 0.05);
    pose.width_s = 0.5 * (to_s - from_s);
    return EditOp{pose};
  }
  return over(TagOp{"t" + std::to_string(dice.between(0.0, 1.0))}, from_s, to_s, 0.0);
}

std::vector<EditOp> wide_ops(Dice& dice, double from_s, double to_s) {
  const double blend_s = dice.between(0.02, 0.2);
  FilterOp butterworth;
  butterworth.method = FilterMethod::kButterworth;
  butterworth.cutoff = CutoffRule::kGiven;
  butterworth.cutoff_hz = dice.between(4.0, 10.0);
  FilterOp sliding;
  sliding.keep_contacts = false;
  std::vector<EditOp> out;
  out.push_back(over(FilterOp{}, from_s, to_s, blend_s));
  out.push_back(over(sliding, from_s, to_s, blend_s));
  out.push_back(over(butterworth, from_s, to_s, blend_s));
  out.push_back(over(ExaggerateOp{dice.between(0.5, 1.6)}, from_s, to_s, blend_s));
  out.push_back(over(PlantOp{}, from_s, to_s, blend_s));
  out.push_back(over(BalanceOp{}, from_s, to_s, blend_s));
  return out;
}

TEST(EditProperties, OperationsOnDisjointSpansCommuteToTheBit) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    Dice dice(seed);
    const EditState state = random_walk(seed % 4);
    const EditOp first = local_op(dice, dice.between(0.3, 0.6), dice.between(1.0, 1.6));
    const EditOp second = local_op(dice, dice.between(2.1, 2.4), dice.between(2.8, 3.6));
    const EditState a = applied(second, applied(first, state));
    const EditState b = applied(first, applied(second, state));
    EXPECT_TRUE(same_poses_to_the_bit(a, b)) << "seed " << seed;
    EXPECT_EQ(a.annotations.notes.size(), b.annotations.notes.size());
  }
}

TEST(EditProperties, AnOperationLeavesFramesOutsideItsSpanAndFadesToTheBit) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    Dice dice(seed);
    const EditState state = random_walk(seed);
    const double from_s = dice.between(0.8, 1.4);
    const double to_s = dice.between(1.9, 2.8);
    std::vector<EditOp> ops = wide_ops(dice, from_s, to_s);
    for (int k = 0; k < 4; ++k) ops.push_back(local_op(dice, from_s, to_s));
    for (const EditOp& op : ops) {
      const EditState out = applied(op, state);
      ASSERT_EQ(out.frame_count(), state.frame_count());
      for (int t = 0; t < state.frame_count(); ++t) {
        const double time_s = t / 60.0;
        if (time_s > from_s - op.blend_s && time_s < to_s + op.blend_s) continue;
        const auto k = static_cast<std::size_t>(t);
        EXPECT_TRUE(same_pose(out.motion.poses[k], state.motion.poses[k]))
            << name(op.parameters) << ", seed " << seed << ", frame " << t;
      }
    }
  }
}

TEST(EditProperties, AnOperationThatIsOffIsAbsent) {
  EditInputs inputs;
  inputs.sources[""] = random_walk(1);
  for (std::size_t kind = 0; kind < edit_op_names().size(); ++kind) {
    Dice dice(kind);
    EditRecipe recipe;
    recipe.sources.emplace_back();
    recipe.ops = {local_op(dice, 0.5, 1.5), local_op(dice, 1.0, 2.0)};
    const auto without = render(recipe, inputs);
    ASSERT_TRUE(without);
    EditOp off = testing::random_edit_op(kind, kind);
    off.off = true;
    recipe.ops.insert(recipe.ops.begin() + static_cast<std::ptrdiff_t>(kind % 3), off);
    const auto with = render(recipe, inputs);
    ASSERT_TRUE(with) << name(off.parameters);
    EXPECT_TRUE(same_poses_to_the_bit(with->outputs[0], without->outputs[0]))
        << name(off.parameters);
    EXPECT_EQ(with->reports.size(), without->reports.size());
  }
}

TEST(EditProperties, PlacesAndFiltersCommute) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    Dice dice(seed);
    const EditState state = random_walk(seed);
    PlaceOp move;
    move.position_xz_m = glm::dvec2(dice.between(-5.0, 5.0), dice.between(-5.0, 5.0));
    FilterOp filter;
    if (seed % 2 == 1) filter.method = FilterMethod::kButterworth;
    // The place of the hips in the first frame, which a filter changes, is not used.
    const EditOp place{move};
    const EditState placed = applied(place, state);
    const glm::dvec3 way =
        placed.motion.poses[0].root_in_world - state.motion.poses[0].root_in_world;
    EditState a = applied(EditOp{filter}, state);
    for (Pose& pose : a.motion.poses) pose.root_in_world += way;
    const EditState b = applied(EditOp{filter}, placed);
    EXPECT_LT(largest_difference_m(a, b), 1e-9) << "seed " << seed;
  }
}

TEST(EditProperties, TurnedMotionsAreFilteredAlike) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    Dice dice(seed);
    const EditState state = random_walk(seed);
    FilterOp filter;
    if (seed % 2 == 1) filter.method = FilterMethod::kButterworth;
    const PlanarMove move{dice.between(-3.0, 3.0),
                          {dice.between(-5.0, 5.0), dice.between(-5.0, 5.0)}};
    EditState moved = state;
    for (Pose& pose : moved.motion.poses) move_pose(move, pose);
    EditState a = applied(EditOp{filter}, state);
    for (Pose& pose : a.motion.poses) move_pose(move, pose);
    EXPECT_LT(largest_difference_m(a, applied(EditOp{filter}, moved)), 1e-9)
        << "seed " << seed;
  }
}

/// Angle of the head per frame, by which a frame is recognized after any chain.
constexpr double kHeadStep_rad = 0.003;

double frame_of_head(const Motion& motion, double frame) {
  const auto head = index(*motion.skeleton.find(HumanBone::kHead));
  const auto angle = [&](std::size_t t) {
    const glm::dquat& q = motion.poses[t].parent_from_joint[head];
    return 2.0 * std::atan2(q.x, q.w);
  };
  const auto before = static_cast<std::size_t>(std::floor(frame));
  const std::size_t after = std::min(before + 1, motion.poses.size() - 1);
  const double share = frame - static_cast<double>(before);
  return ((1.0 - share) * angle(before) + share * angle(after)) / kHeadStep_rad;
}

EditOp random_step(Dice& dice, const EditState& state, double marked) {
  const double last = state.frame_count() - 1.0;
  switch (static_cast<int>(dice.between(0.0, 7.999))) {
    case 0: {
      EditOp cut{CutOp{}};
      cut.span = {AtFrame{std::floor(dice.between(0.0, 0.5 * marked))},
                  AtFrame{std::ceil(dice.between(0.5 * (marked + last), last))}};
      return cut;
    }
    case 1: {
      RetimeOp speed;
      speed.speed = dice.between(0.6, 1.6);
      return EditOp{speed};
    }
    case 2: {
      RetimeOp knots;
      const double length_s = state.duration_s();
      knots.knots = {
          {AtTime{0.3 * length_s}, dice.between(0.2, 0.4) * length_s},
          {AtTime{0.7 * length_s}, dice.between(0.6, 0.9) * length_s},
      };
      return EditOp{knots};
    }
    case 3:
      return EditOp{ScaleTimeOp{dice.between(0.7, 1.4)}};
    case 4:
      return EditOp{MirrorOp{}};
    case 5: {
      PlaceOp place;
      place.heading_rad = dice.between(-3.0, 3.0);
      return EditOp{place};
    }
    case 6: {
      RetimeOp rate;
      rate.rate_hz = dice.between(40.0, 110.0);
      return EditOp{rate};
    }
    default:
      return EditOp{PlantOp{}};
  }
}

TEST(EditProperties, AMarkedFrameIsFoundAtItsImageAfterAnyChain) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Dice dice(seed);
    EditState state = random_walk(seed % 4);
    const auto head = index(*state.motion.skeleton.find(HumanBone::kHead));
    for (int t = 0; t < state.frame_count(); ++t) {
      state.motion.poses[static_cast<std::size_t>(t)].parent_from_joint[head] =
          glm::angleAxis(kHeadStep_rad * t, glm::dvec3(1.0, 0.0, 0.0));
    }
    const double marked = std::floor(dice.between(60.0, 180.0));
    state = applied(EditOp{EventOp{"here", AtFrame{marked}}}, state);
    std::string chain;
    for (int step = 0; step < 6; ++step) {
      const auto at = resolve_moment(state, AtAnnotation{"here", 0});
      ASSERT_TRUE(at) << chain;
      const EditOp op = random_step(dice, state, *at);
      chain += std::string(name(op.parameters)) + " ";
      state = applied(op, state);
    }
    const auto at = resolve_moment(state, AtAnnotation{"here", 0});
    ASSERT_TRUE(at) << chain;
    const double lower = std::clamp(*at - 0.5, 0.0, state.frame_count() - 1.0);
    const double upper = std::clamp(*at + 0.5, 0.0, state.frame_count() - 1.0);
    EXPECT_LE(frame_of_head(state.motion, lower), marked + 1e-6)
        << "seed " << seed << ": " << chain;
    EXPECT_GE(frame_of_head(state.motion, upper), marked - 1e-6)
        << "seed " << seed << ": " << chain;
  }
}

}  // namespace
}  // namespace marey::edit
