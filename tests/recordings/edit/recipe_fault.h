// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "recordings/edit/edit_recipe_file.h"

namespace marey::testing {

/// A mistake in a recipe, and the message about it.
struct RecipeFault {
  const char* text;
  int line;
  const char* cause;
  const char* next;
};

/// Expects that the recipe `text` is refused with the message of `fault`.
inline void expect_refusal(const std::string& text, const RecipeFault& fault) {
  const Result<EditRecipe> recipe = recordings::parse_edit_recipe(text, "r.edit.toml");
  ASSERT_FALSE(recipe) << text;
  const Error& error = recipe.error();
  EXPECT_EQ(error.code, Errc::kBadInput);
  EXPECT_EQ(error.where, "r.edit.toml:" + std::to_string(fault.line)) << text;
  EXPECT_EQ(error.cause, fault.cause) << text;
  EXPECT_EQ(error.next, fault.next) << text;
}

inline constexpr const char* kSeeThePage =
    "write it as docs/formats/edit_recipe.md shows";
inline constexpr const char* kAddIt = "add it; docs/formats/edit_recipe.md describes it";

}  // namespace marey::testing
