// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Mistakes in the keys of the operations jump and balance.
#include <string>

#include <gtest/gtest.h>

#include "tests/recordings/edit/recipe_fault.h"

namespace marey::recordings {
namespace {

using testing::expect_refusal;
using testing::kAddIt;
using testing::kSeeThePage;
using testing::RecipeFault;

/// Checks keys of an operation in a recipe; the line of `do` has the number 5.
void expect_key_refusal(const std::string& op, const RecipeFault& fault) {
  expect_refusal(
      "format = 1\n[source]\npath = \"a\"\n[[op]]\ndo = \"" + op + "@1\"\n" + fault.text,
      fault);
}

TEST(JumpKeys, EachNumberHasARangeThatTheMessageStates) {
  const RecipeFault faults[] = {
      // NOLINT
      {"jump = 0\n", 6, "\"jump\" is 0, not between 1 and 10000", "correct the number"},
      {"jump = 1.5\n", 6, "\"jump\" must be a whole number", "correct the number"},
      {"apex_m = 0\n", 6, "\"apex_m\" is 0, not between 0.01 and 100 m", "give it in m"},
      {"apex_by_m = 1e4\n",
       6,
       "\"apex_by_m\" is 10000, not between -100 and 100 m",
       "give it in m"},
      {"airtime_s = 0\n",
       6,
       "\"airtime_s\" is 0, not between 0.02 and 20 s",
       "give it in s"},
      {"airtime_s = -0.5\n",
       6,
       "\"airtime_s\" is -0.5, not between 0.02 and 20 s",
       "give it in s"},
      {"length_m = -1\n",
       6,
       "\"length_m\" is -1, not between 0 and 100 m",
       "give it in m"},
      {"land_m = [0, 1e5, 0]\n",
       6,
       "\"land_m\" contains 1e+05, not between -10000 and 10000 m",
       "give it in m"},
      {"box_m = 2e3\n", 6, "\"box_m\" is 2000, not between -20 and 20 m", "give it in m"},
      {"push_s = 0\n", 6, "\"push_s\" is 0, not between 0.05 and 10 s", "give it in s"},
      {"strength_g = 0.4\n",
       6,
       "\"strength_g\" is 0.4, not between 0.5 and 100 g",
       "give it in g"},
      {"gravity_m_s2 = 0.4\n",
       6,
       "\"gravity_m_s2\" is 0.4, not between 0.5 and 30 m/s^2",
       "give it in m/s^2"},
      {"gravity_m_s2 = 31\n",
       6,
       "\"gravity_m_s2\" is 31, not between 0.5 and 30 m/s^2",
       "give it in m/s^2"},
      {"law = \"thesis\"\nlowest = {at = 1, height_m = 0.5}\n",
       7,
       "\"at\" is 1, not between 0.001 and 0.999",
       "correct the number"},
  };
  for (const RecipeFault& fault : faults) expect_key_refusal("jump", fault);
}

TEST(JumpKeys, NumbersThatAreNotFiniteAreRefused) {
  for (const std::string value : {"nan", "inf", "-inf"}) {
    for (const std::string key : {"apex_m",
                                  "apex_by_m",
                                  "airtime_s",
                                  "length_m",
                                  "box_m",
                                  "push_s",
                                  "push_start_s",
                                  "strength_g",
                                  "gravity_m_s2"}) {
      const std::string text = key + " = " + value + "\n";
      const std::string cause = "\"" + key + "\" must be a number that is finite";
      expect_key_refusal("jump", {text.c_str(), 6, cause.c_str(), kSeeThePage});
    }
    const std::string place = "land_m = [0, " + value + ", 0]\n";
    expect_key_refusal(
        "jump",
        {place.c_str(), 6, "\"land_m\" must be an array of 3 numbers", kSeeThePage});
  }
}

TEST(JumpKeys, KeysThatContradictEachOtherAreRefused) {
  const RecipeFault faults[] = {
      // NOLINT
      {"apex_m = 1.4\napex_by_m = 0.1\n",
       7,
       "\"apex_m\" and \"apex_by_m\" exclude each other",
       "remove one"},
      {"land_m = [0, 0, 1]\nlength_m = 1\n",
       7,
       "\"land_m\" and \"length_m\" exclude each other",
       "remove one"},
      {"box_m = 0.4\nland_m = [0, 0, 1]\n",
       6,
       "\"land_m\" and \"box_m\" exclude each other",
       "remove one"},
      {"lowest = {at = 0.5, height_m = 0.6}\n",
       6,
       "\"lowest\" is for the law \"thesis\" only",
       "add law = \"thesis\", or remove it"},
      {"push_start_s = 1\npush_start = \"a\"\n",
       7,
       "both \"push_start_s\" and \"push_start\" are given",
       "remove one: they have the same meaning"},
  };
  for (const RecipeFault& fault : faults) expect_key_refusal("jump", fault);
}

TEST(JumpKeys, UnknownWordsAndMissingKeysAreNamed) {
  const RecipeFault faults[] = {
      // NOLINT
      {"law = \"forse\"\n",
       6,
       "\"law\" cannot be \"forse\"",
       "perhaps you mean \"force\""},
      {"apex = 1\n", 6, "unknown key \"apex\" in jump@1", "perhaps you mean \"apex_m\""},
      {"law = \"thesis\"\nlowest = {at = 0.5}\n",
       7,
       "the key \"height_m\" is missing in lowest",
       kAddIt},
      {"law = \"thesis\"\nlowest = {at = 0.5, heigt_m = 1}\n",
       7,
       "unknown key \"heigt_m\" in lowest",
       "perhaps you mean \"height_m\""},
      {"law = \"thesis\"\nlowest = 0.5\n", 7, "\"lowest\" must be a table", kSeeThePage},
      {"ballistic = 1\n", 6, "\"ballistic\" must be true or false", kSeeThePage},
      {"land_m = [1, 2]\n", 6, "\"land_m\" must be an array of 3 numbers", kSeeThePage},
  };
  for (const RecipeFault& fault : faults) expect_key_refusal("jump", fault);
}

TEST(BalanceKeys, AnUnknownModeIsNamed) {
  expect_key_refusal("balance",
                     {"mode = \"zpm\"\n",
                      6,
                      "\"mode\" cannot be \"zpm\"",
                      "choose one of \"horizontal\", \"zmp\""});
}

}  // namespace
}  // namespace marey::recordings
