// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include "core/base/degrees.h"
#include "recordings/edit/edit_key_list.h"
#include "recordings/edit/edit_recipe_file.h"
#include "recordings/edit/edit_rotation_keys.h"
#include "tests/support/files/random_recipe.h"

namespace marey::recordings {
namespace {

using marey::testing::random_edit_op;
using marey::testing::random_edit_recipe;

constexpr std::uint64_t kRecipeSeeds = 1000;

EditRecipe parsed_again(const EditRecipe& recipe, std::uint64_t seed) {
  const std::string text = edit_recipe_text(recipe);
  const Result<EditRecipe> read = parse_edit_recipe(text, "r.edit.toml");
  EXPECT_TRUE(read) << "seed " << seed << ": "
                    << (read ? "" : read.error().message() + "\n" + text);
  return read ? *read : EditRecipe{};
}

TEST(EditRecipeProperty, TextsAreReadBackAsTheSameText) {
  std::size_t ops = 0;
  for (std::uint64_t seed = 0; seed < kRecipeSeeds; ++seed) {
    const EditRecipe recipe = random_edit_recipe(seed);
    const EditRecipe read = parsed_again(recipe, seed);
    ASSERT_EQ(edit_recipe_text(read), edit_recipe_text(recipe)) << "seed " << seed;
    ASSERT_EQ(read.ops.size(), recipe.ops.size());
    EXPECT_EQ(read.name, recipe.name);
    EXPECT_EQ(read.limits, recipe.limits);
    for (std::size_t k = 0; k < read.ops.size(); ++k) {
      const EditOp& a = read.ops[k];
      const EditOp& b = recipe.ops[k];
      EXPECT_EQ(a.parameters.index(), b.parameters.index());
      EXPECT_EQ(a.span, b.span);
      EXPECT_EQ(a.groups, b.groups);
      EXPECT_EQ(a.blend_s, b.blend_s);
      EXPECT_EQ(std::make_pair(a.off, a.why), std::make_pair(b.off, b.why));
    }
    ops += read.ops.size();
  }
  EXPECT_GT(ops, 5000U);
}

TEST(EditRecipeProperty, AnOperationsTextIsReadBackAlone) {
  for (std::uint64_t seed = 0; seed < kRecipeSeeds; ++seed) {
    const EditOp op = random_edit_op(seed, seed);
    const std::string text = edit_op_text(op);
    const Result<EditOp> read = parse_edit_op(text, "page");
    ASSERT_TRUE(read) << read.error().message() << "\n" << text;
    EXPECT_EQ(edit_op_text(*read), text);
    EXPECT_EQ(read->line, 1);
  }
}

TEST(EditRecipeProperty, TheReasonIsNotPartOfAKey) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    EditOp op = random_edit_op(seed, seed);
    const std::string key = edit_op_text(op, WhyText::kLeftOut);
    op.why = "another reason";
    op.line += 7;
    EXPECT_EQ(edit_op_text(op, WhyText::kLeftOut), key);
    EXPECT_NE(edit_op_text(op), key);
    op.off = !op.off;
    EXPECT_NE(edit_op_text(op, WhyText::kLeftOut), key);
  }
}

// Each key of each operation is written for some values, so no value is lost.
TEST(EditRecipeProperty, EveryKeyIsWritten) {
  for (std::size_t kind = 0; kind < edit_op_names().size(); ++kind) {
    std::string all;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      all += edit_op_text(random_edit_op(seed, kind));
    }
    const EditOp op = random_edit_op(0, kind);
    for (const std::string& key : recipe::edit_op_keys(op.parameters)) {
      // Random rotations have no short form in degrees.
      if (key == "rotation_deg") continue;
      const bool is_written = all.find("\n" + key + " = ") != std::string::npos ||
                              all.find("[op." + key + "]") != std::string::npos;
      EXPECT_TRUE(is_written) << name(op.parameters) << ": " << key;
    }
  }
}

TEST(EditRecipeProperty, OrderOfGroupsDoesNotMatter) {
  EditOp op;
  op.groups = {EditGroup::kLeftLeg, EditGroup::kRoot, EditGroup::kLeftLeg};
  EditOp sorted;
  sorted.groups = {EditGroup::kRoot, EditGroup::kLeftLeg};
  EXPECT_EQ(edit_op_text(op), edit_op_text(sorted));
}

TEST(EditAngles, InDegreesAreReadBack) {
  std::mt19937_64 engine(7);
  int exact = 0;
  constexpr int kAngles = 100'000;
  for (int i = 0; i < kAngles; ++i) {
    const double angle_rad = (static_cast<double>(engine() >> 11U) * 0x1p-53 - 0.5) *
                             std::pow(10.0, static_cast<double>(engine() % 8) - 5.0);
    const double degrees = recipe::degrees_to_write(angle_rad);
    const double read_rad = degrees * kRadiansPerDegree;
    EXPECT_NEAR(read_rad, angle_rad, 1e-13 * std::abs(angle_rad));
    EXPECT_EQ(recipe::degrees_to_write(read_rad), degrees) << angle_rad;
    exact += read_rad == angle_rad ? 1 : 0;
  }
  EXPECT_GT(exact, kAngles / 2);
}

TEST(EditAngles, KeepTheFewDigitsOfAUser) {
  for (const double degrees : {0.0, 90.0, -90.0, 30.0, 12.5, 0.1, 359.99, 1e-3, 7200.0}) {
    EXPECT_EQ(recipe::degrees_to_write(degrees * kRadiansPerDegree), degrees);
  }
}

TEST(EditAngles, RotationsOfAUserKeepTheirForm) {
  for (const char* vector : {"[0.0, 90.0, 0.0]",
                             "[0.0, -45.5, 0.0]",
                             "[12.25, 0.0, 179.0]",
                             "[0.0, 0.0, 0.0]",
                             "[-0.001, 10.0, 33.333]"}) {
    const std::string text =
        std::string("[[op]]\ndo = \"offset@1\"\nbone = \"spine\"\nrotation_deg = ") +
        vector + "\n";
    const Result<EditOp> op = parse_edit_op(text, "t");
    ASSERT_TRUE(op) << op.error().message();
    EXPECT_EQ(edit_op_text(*op), text);
  }
}

}  // namespace
}  // namespace marey::recordings
