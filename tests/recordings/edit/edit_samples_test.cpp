// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The sample recipes and the documentation of the format.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/edit/annotations_file.h"
#include "recordings/edit/edit_constraint_keys.h"
#include "recordings/edit/edit_key_list.h"
#include "recordings/edit/edit_recipe_file.h"
#include "tests/support/program/paths.h"

namespace marey::recordings {
namespace {

std::vector<std::filesystem::path> sample_recipes() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(
           testing::source_dir() / "recordings/samples/edits")) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

TEST(EditSamples, AreReadAndNamedAfterTheirFiles) {
  const auto paths = sample_recipes();
  EXPECT_EQ(paths.size(), 10U);
  for (const auto& path : paths) {
    const Result<EditRecipe> recipe = read_edit_recipe(path);
    ASSERT_TRUE(recipe) << recipe.error().message();
    EXPECT_EQ(recipe->name + ".edit.toml", path.filename().string());
    EXPECT_FALSE(recipe->ops.empty());
    const std::string text = edit_recipe_text(*recipe);
    const Result<EditRecipe> again = parse_edit_recipe(text, path);
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_EQ(edit_recipe_text(*again), text);
  }
}

TEST(EditRecipePage, ItsExamplesAreRead) {
  const Result<EditRecipe> recipe =
      parse_edit_recipe(testing::formats_example("edit_recipe"), "page");
  ASSERT_TRUE(recipe) << recipe.error().message();
  EXPECT_EQ(recipe->ops.size(), 4U);
  const std::string page = testing::formats_page("edit_recipe");
  const std::string fence = "```json\n";
  const std::size_t begin = page.find(fence) + fence.size();
  const Result<Annotations> annotations =
      parse_annotations(page.substr(begin, page.find("```", begin) - begin), "page");
  ASSERT_TRUE(annotations) << annotations.error().message();
  EXPECT_EQ(annotations->notes.size(), 2U);
}

/// Returns the key of an instant without the ending of its unit, any other key unchanged.
std::string documented_key(const std::string& key, const std::vector<std::string>& keys) {
  for (const std::string ending : {"_s", "_frame"}) {
    if (!key.ends_with(ending)) continue;
    const std::string instant = key.substr(0, key.size() - ending.size());
    if (std::find(keys.begin(), keys.end(), instant) != keys.end()) return instant;
  }
  return key;
}

TEST(EditRecipePage, NamesEveryOperationAndKey) {
  const std::string page = testing::formats_page("edit_recipe");
  ASSERT_FALSE(page.empty());
  const auto names_keys = [&](const std::vector<std::string>& keys) {
    for (const std::string& key : keys) {
      const std::string word = "`" + documented_key(key, keys) + "`";
      EXPECT_NE(page.find(word), std::string::npos) << key;
    }
  };
  for (const std::string_view op : edit_op_names()) {
    EXPECT_NE(page.find("| `" + std::string(op) + "` |"), std::string::npos) << op;
    names_keys(recipe::edit_op_keys(*edit_op(op)));
  }
  for (std::size_t type = 0; type < std::variant_size_v<Goal>; ++type) {
    names_keys(recipe::constraint_keys(type));
  }
}

}  // namespace
}  // namespace marey::recordings
