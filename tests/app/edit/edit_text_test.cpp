// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A recipe and its text give the same result, for random recipes of all operations.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "edit/render.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "core/transform.h"
#include "recordings/edit/edit_recipe_file.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey {
namespace {

using testing::Dice;

edit::EditState walk_with_noise(std::uint64_t seed) {
  Motion motion = testing::synthetic_walk(150, 60.0).motion;
  Dice dice(seed);
  for (Pose& pose : motion.poses) {
    pose.root_in_world += glm::dvec3(dice.noise(0.002), 0.0, dice.noise(0.002));
  }
  auto state = edit::make_edit_state(std::move(motion));
  EXPECT_TRUE(state);
  return *std::move(state);
}

edit::EditInputs walk_inputs() {
  edit::EditInputs out;
  out.sources[""] = walk_with_noise(1);
  out.sources["other"] = walk_with_noise(2);
  out.avatars["child.vrm"] = testing::child();
  return out;
}

Moment instant(Dice& dice, double from_s, double to_s) {
  if (dice.between(0.0, 1.0) < 0.5) return AtTime{dice.between(from_s, to_s)};
  return AtFrame{60.0 * dice.between(from_s, to_s)};
}

glm::dquat small_turn(Dice& dice) {
  return rotation_from_vector(
      {dice.between(-0.3, 0.3), dice.between(-0.3, 0.3), dice.between(-0.3, 0.3)});
}

ConstrainOp random_constrain(Dice& dice) {
  ConstrainOp out;
  out.adapt = dice.between(0.0, 1.0) < 0.5;
  if (dice.between(0.0, 1.0) < 0.4) {
    out.detect = DetectConstraints::kSupports;
    ConstraintChange change{"found leftFoot flat 2"};
    change.stop_duration_s = dice.between(0.05, 0.2);
    if (dice.between(0.0, 1.0) < 0.5) out.changes = {change};
    return out;
  }
  Constraint& constraint = out.constraint.emplace();
  constraint.id = "hand";
  constraint.point.segment = "leftHand";
  constraint.goal = DistanceToPoint{dice.between(0.0, 0.1), {0.3, 1.1, 0.4}};
  constraint.importance = dice.between(0.5, 2.0);
  constraint.activation.start_duration_s = dice.between(0.1, 0.3);
  // Seconds in a text are those of the fade; frames are those of the full constraint.
  out.from = AtFrame{60.0 * dice.between(0.3, 0.8)};
  out.to = AtFrame{60.0 * dice.between(1.0, 1.5)};
  return out;
}

/// Parameters with random values for which most walks have a result.
EditOpParameters random_parameters(std::string_view op_name, Dice& dice) {
  if (op_name == "keep") {
    return KeepOp{{{instant(dice, 0.0, 0.4), instant(dice, 1.2, 2.0)}}};
  }
  if (op_name == "split") return SplitOp{{instant(dice, 0.8, 1.2)}};
  if (op_name == "splice") return SpliceOp{"other", {}, {}, dice.between(0.1, 0.4)};
  if (op_name == "filter") {
    FilterOp out;
    out.keep_contacts = dice.between(0.0, 1.0) < 0.5;
    if (dice.between(0.0, 1.0) < 0.5) return out;
    out.method = FilterMethod::kButterworth;
    out.cutoff = CutoffRule::kGiven;
    out.cutoff_hz = dice.between(4.0, 12.0);
    return out;
  }
  if (op_name == "level") return LevelOp{false, dice.between(-0.2, 0.2)};
  if (op_name == "place") {
    PlaceOp out;
    out.position_xz_m = glm::dvec2(dice.between(-2.0, 2.0), dice.between(-2.0, 2.0));
    out.heading_rad = dice.between(-3.0, 3.0);
    return out;
  }
  if (op_name == "path") return PathOp{{}, dice.between(-0.4, 0.4), 1.0, false};
  if (op_name == "retime") {
    return RetimeOp{{}, dice.between(0.7, 1.4), {}, dice.between(50.0, 70.0)};
  }
  if (op_name == "cyclify") {
    CyclifyOp out;
    out.max_period_s = dice.between(1.15, 1.3);
    out.min_period_s = dice.between(0.9, 1.05);
    out.cycles = 2;
    return out;
  }
  if (op_name == "contacts") {
    return ContactsOp{true,
                      {{ContactEdit::Kind::kClear,
                        1,
                        FootPart::kHeel,
                        dice.between(0.1, 0.3),
                        dice.between(0.5, 0.9)}}};
  }
  if (op_name == "constrain") return random_constrain(dice);
  if (op_name == "pose") {
    PoseOp out;
    out.at = instant(dice, 0.5, 1.5);
    out.bone = HumanBone::kRightUpperArm;
    out.rotation = small_turn(dice);
    out.width_s = dice.between(0.1, 0.5);
    return out;
  }
  if (op_name == "offset") return OffsetOp{HumanBone::kHead, small_turn(dice), {}};
  if (op_name == "scale_time") return ScaleTimeOp{dice.between(0.7, 1.4)};
  if (op_name == "exaggerate") {
    return ExaggerateOp{dice.between(0.7, 1.5), 0.0, dice.between(3.0, 9.0)};
  }
  if (op_name == "tag") return TagOp{"a \"tag\""};
  if (op_name == "event") return EventOp{"here", instant(dice, 0.2, 1.5)};
  if (op_name == "curve") {
    return CurveOp{"w",
                   {{AtTime{dice.between(0.0, 0.5)}, dice.between(-1.0, 1.0)},
                    {AtTime{dice.between(0.6, 1.5)}, dice.between(-1.0, 1.0)}}};
  }
  if (op_name == "retarget") return RetargetOp{"child.vrm", dice.between(0.0, 1.0) < 0.5};
  return *edit_op(op_name);
}

bool is_part_possible(std::string_view op_name) {
  const std::set<std::string_view> names{
      "cut", "filter", "plant", "offset", "exaggerate", "balance", "tag"};
  return names.contains(op_name);
}

bool has_fades(std::string_view op_name) {
  return is_part_possible(op_name) && op_name != "cut" && op_name != "tag";
}

EditOp random_op(std::string_view op_name, Dice& dice) {
  EditOp out{random_parameters(op_name, dice)};
  if (is_part_possible(op_name) && dice.between(0.0, 1.0) < 0.6) {
    out.span = {instant(dice, 0.0, 0.3), instant(dice, 1.4, 2.0)};
    if (has_fades(op_name)) out.blend_s = dice.between(0.0, 0.2);
  }
  return out;
}

bool same_bits(const edit::EditState& a, const edit::EditState& b) {
  if (a.motion.poses.size() != b.motion.poses.size()) return false;
  for (std::size_t t = 0; t < a.motion.poses.size(); ++t) {
    if (a.motion.poses[t].root_in_world != b.motion.poses[t].root_in_world ||
        a.motion.poses[t].parent_from_joint != b.motion.poses[t].parent_from_joint) {
      return false;
    }
  }
  return a.annotations == b.annotations &&
         a.constraints.constraints.size() == b.constraints.constraints.size();
}

double largest_distance_m(const edit::EditState& a, const edit::EditState& b) {
  EXPECT_EQ(a.motion.poses.size(), b.motion.poses.size());
  double largest = 0.0;
  for (std::size_t t = 0; t < std::min(a.motion.poses.size(), b.motion.poses.size());
       ++t) {
    const auto p = world_from_joints(a.motion.skeleton, a.motion.poses[t]);
    const auto q = world_from_joints(b.motion.skeleton, b.motion.poses[t]);
    for (std::size_t j = 0; j < p.size(); ++j) {
      largest = std::max(largest, glm::distance(p[j].translation, q[j].translation));
    }
  }
  return largest;
}

EditRecipe random_pair(std::string_view op_name, std::uint64_t seed) {
  Dice dice(seed);
  EditRecipe out;
  out.name = "r";
  out.sources = {{"", "walk.bvh", "", 0}, {"other", "other.bvh", "", 0}};
  // The operation in question and one before it that leaves most of the motion.
  const std::string_view earlier[] = {"place", "filter", "offset", "tag", "mirror"};
  const auto which = static_cast<std::size_t>(dice.between(0.0, 4.99));
  out.ops.push_back(random_op(earlier[which], dice));
  out.ops.push_back(random_op(op_name, dice));
  return out;
}

EditRecipe parsed_text(const EditRecipe& recipe) {
  const std::string text = recordings::edit_recipe_text(recipe);
  auto read = recordings::parse_edit_recipe(text, "r.edit.toml");
  EXPECT_TRUE(read) << (read ? "" : read.error().message()) << "\n" << text;
  return read ? *std::move(read) : recipe;
}

// Angles are written in degrees, so a recipe made in memory may differ from its text by
// rounding; one that was read is rendered to the bit from its own text.
TEST(EditText, GivesTheResultOfItsRecipe) {
  const edit::EditInputs inputs = walk_inputs();
  const std::vector<std::string_view> names = edit_op_names();
  std::set<std::string_view> rendered_names;
  for (std::uint64_t seed = 0; seed < 3 * names.size(); ++seed) {
    const std::string_view op_name = names[seed % names.size()];
    const EditRecipe recipe = random_pair(op_name, seed);
    const EditRecipe read = parsed_text(recipe);
    const auto original = edit::render(recipe, inputs);
    const auto first = edit::render(read, inputs);
    const auto second = edit::render(parsed_text(read), inputs);
    const std::string text = recordings::edit_recipe_text(recipe);
    ASSERT_EQ(original.has_value(), first.has_value()) << text;
    ASSERT_EQ(first.has_value(), second.has_value()) << text;
    if (!first) {
      EXPECT_EQ(original.error().cause, first.error().cause) << text;
      continue;
    }
    rendered_names.insert(op_name);
    ASSERT_EQ(first->outputs.size(), original->outputs.size());
    for (std::size_t k = 0; k < first->outputs.size(); ++k) {
      EXPECT_TRUE(same_bits(first->outputs[k], second->outputs[k])) << text;
      EXPECT_LT(largest_distance_m(first->outputs[k], original->outputs[k]), 1e-5)
          << text;
    }
  }
  // No version of marey applies a jump yet.
  EXPECT_EQ(rendered_names.size(), names.size() - 1);
}

}  // namespace
}  // namespace marey
