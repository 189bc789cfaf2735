// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/edit/edit_recipe_file.h"
#include "recordings/session/file_kind.h"
#include "recordings/session/plan_file.h"
#include "tests/recordings/edit/recipe_fault.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::expect_refusal;
using testing::kAddIt;
using testing::kSeeThePage;
using testing::RecipeFault;

TEST(EditRecipeRefusal, NamesTheMistakeInTheHead) {
  for (const RecipeFault& fault : {
           RecipeFault{"format = 2\nfoo = 1\n[source]\npath = \"a\"\n",
                       1,
                       "the recipe was made by a newer marey: its format is 2, and this "
                       "marey reads 1",
                       "update marey"},
           RecipeFault{
               "format = 0\n[source]\n", 1, "its format is 0", "write format = 1"},
           RecipeFault{
               "[source]\npath = \"a\"\n", 1, "the key \"format\" is missing", kAddIt},
           RecipeFault{"format = 1\nnam = \"a\"\n[source]\n",
                       2,
                       "unknown key \"nam\"",
                       "perhaps you mean \"name\""},
           RecipeFault{"format = 1\nname = \"a/b\"\n[source]\n",
                       2,
                       "\"a/b\" cannot be a part of a file name",
                       "write a name without slashes that does not begin with a dot"},
           RecipeFault{"format = 1\nname = 3\n[source]\n",
                       2,
                       "\"name\" must be text in quotes",
                       kSeeThePage},
           RecipeFault{"format = 1\n[limits]\nslide_mm = nan\n[source]\npath = \"a\"\n",
                       3,
                       "\"slide_mm\" must be a number that is finite",
                       kSeeThePage},
           RecipeFault{"format = 1\n[limits]\nslide = 1\n[source]\npath = \"a\"\n",
                       3,
                       "unknown key \"slide\" in [limits]",
                       "perhaps you mean \"slide_mm\""},
           RecipeFault{"format = 1\n[source]\npath = \"a\"\n[op]\ndo = \"cut@1\"\n",
                       4,
                       "\"op\" must be a list of tables, each under [[...]]",
                       kSeeThePage},
       }) {
    expect_refusal(fault.text, fault);
  }
}

TEST(EditRecipeRefusal, NamesTheMistakeInASource) {
  constexpr const char* kAddId = "add id = \"NAME\", which splice@1 names";
  for (const RecipeFault& fault : {
           RecipeFault{"format = 1\n[[op]]\ndo = \"plant@1\"\n",
                       1,
                       "no [source] in it",
                       "add [source] with path = \"MOTION\""},
           RecipeFault{"format = 1\n[source]\nid = \"a\"\n",
                       2,
                       "the key \"path\" is missing in [source]",
                       kAddIt},
           RecipeFault{"format = 1\n[source]\npath = \"\"\n",
                       3,
                       "\"path\" is empty",
                       "write its text"},
           RecipeFault{"format = 1\n[source]\npath = \"a\\u0000b\"\n",
                       3,
                       "\"path\" contains a line end or a control character",
                       "write one line of text"},
           RecipeFault{"format = 1\n[source]\npath = \"a\"\nsha256 = \"12\"\n",
                       4,
                       "\"sha256\" is not a SHA-256 sum of 64 digits",
                       "remove the key; marey edit writes it again"},
           RecipeFault{"format = 1\n[source]\npath = \"a\"\nsha = \"12\"\n",
                       4,
                       "unknown key \"sha\" in [source]",
                       "choose one of \"id\", \"path\", \"sha256\""},
           RecipeFault{"format = 1\n[[source]]\npath = \"a\"\n[[source]]\npath = \"b\"\n",
                       4,
                       "the source has no id",
                       kAddId},
           RecipeFault{"format = 1\n[[source]]\nid = \"x\"\npath = \"a\"\n"
                       "[[source]]\nid = \"x\"\npath = \"b\"\n",
                       6,
                       "another source has the id \"x\"",
                       "give each an id of its own"},
           RecipeFault{"format = 1\n[source]\npath = \"a\"\n"
                       "[[op]]\ndo = \"splice@1\"\nsource = \"b\"\n",
                       6,
                       "there is no source with the id \"b\"",
                       "list each motion under [[source]] with id and path"},
           RecipeFault{"format = 1\n[[source]]\npath = \"a\"\n"
                       "[[source]]\nid = \"stop\"\npath = \"b\"\n"
                       "[[op]]\ndo = \"splice@1\"\nsource = \"stopp\"\n",
                       9,
                       "there is no source with the id \"stopp\"",
                       "perhaps you mean \"stop\""},
       }) {
    expect_refusal(fault.text, fault);
  }
}

TEST(EditRecipeRefusal, RefusesMoreOperationsThanAllowed) {
  const std::string head = "format = 1\n[source]\npath = \"a\"\n";
  std::string text = head;
  for (int i = 0; i < 10'000; ++i) text += "[[op]]\ndo = \"mirror@1\"\n";
  const Result<EditRecipe> all = parse_edit_recipe(text, "r.edit.toml");
  ASSERT_TRUE(all) << all.error().message();
  EXPECT_EQ(all->ops.size(), 10'000U);
  text += "[[op]]\ndo = \"mirror@1\"\n";
  expect_refusal(text,
                 {"",
                  4,
                  "it has 10001 operations, more than 10000",
                  "divide it: the result of one recipe can be the source of another"});
}

TEST(EditRecipeRefusal, RefusesWhatIsNoRecipe) {
  const auto cause_of = [](const std::string& text) {
    const Result<EditRecipe> recipe = parse_edit_recipe(text, "r.edit.toml");
    return recipe ? "no refusal" : recipe.error().cause;
  };
  EXPECT_EQ(cause_of(""), "the file is empty");
  EXPECT_EQ(cause_of("format = 1\nbase_m = 0.5\n"),
            "this is a floor, not a recipe of edits");
  EXPECT_EQ(cause_of("HIERARCHY\nROOT a\n"), "this is a BVH motion, not a TOML file");
  EXPECT_EQ(cause_of(std::string(std::size_t{17} << 20, '\n')),
            "the recipe is larger than 16 MiB");
  EXPECT_TRUE(cause_of("format = 1\n[source\n").starts_with("not valid TOML: "));
  EXPECT_EQ(parse_plan("format = 1\n[source]\npath = \"a\"\n", "p.toml").error().cause,
            "this is a recipe of edits, not a plan");
}

TEST(EditRecipeRefusal, ASingleOperationIsOne) {
  for (const char* text :
       {"", "[[op]]\ndo = \"plant@1\"\n[[op]]\ndo = \"plant@1\"\n", "op = []\n"}) {
    const Result<EditOp> op = parse_edit_op(text, "page");
    ASSERT_FALSE(op) << text;
    EXPECT_EQ(op.error().cause, "there is not exactly one [[op]]");
    EXPECT_EQ(op.error().next, "give one operation");
  }
}

TEST(EditRecipeRefusal, ARecipeIsRecognizedByItsKeys) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a.toml", "format = 1\n[source]\npath = \"a\"\n"));
  const Result<FileKind> kind = file_kind(folder / "a.toml");
  ASSERT_TRUE(kind);
  EXPECT_EQ(*kind, FileKind::kEditRecipe);
}

}  // namespace
}  // namespace marey::recordings
