// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "tests/recordings/edit/recipe_fault.h"

namespace marey::recordings {
namespace {

using testing::expect_refusal;
using testing::kAddIt;
using testing::kSeeThePage;
using testing::RecipeFault;

/// Checks operations in a recipe whose first line of [[op]] has the number 4.
template <std::size_t kCount>
void expect_op_refusals(const RecipeFault (&faults)[kCount]) {  // NOLINT
  for (const RecipeFault& fault : faults) {
    expect_refusal(
        std::string("format = 1\n[source]\npath = \"a\"\n[[op]]\ndo = ") + fault.text,
        fault);
  }
}

TEST(EditOpRefusal, NamesAnUnknownOperation) {
  expect_op_refusals({
      {"\"cot@1\"\n", 5, "there is no operation \"cot\"", "perhaps you mean \"cut@1\""},
      {"\"cut\"\n", 5, "\"cut\" has no version", "write do = \"cut@1\""},
      {"\"cut@2\"\n",
       5,
       "this marey has no \"cut@2\", only \"cut@1\"",
       "update marey, or write do = \"cut@1\""},
      {"\"cut@\"\n", 5, "\"cut@\" has no valid version", "write do = \"cut@1\""},
      {"\"cut@0\"\n", 5, "\"cut@0\" has no valid version", "write do = \"cut@1\""},
      {"\"cut@1x\"\n", 5, "\"cut@1x\" has no valid version", "write do = \"cut@1\""},
      {"1\n", 5, "\"do\" must be text in quotes", kSeeThePage},
  });
  expect_refusal("format = 1\n[source]\npath = \"a\"\n[[op]]\noff = true\n",
                 {"", 4, "the key \"do\" is missing in [[op]]", kAddIt});
}

TEST(EditOpRefusal, NamesAnUnknownKey) {
  expect_op_refusals({
      {"\"filter@1\"\nkeep_contact = true\n",
       6,
       "unknown key \"keep_contact\" in filter@1",
       "perhaps you mean \"keep_contacts\""},
      {"\"plant@1\"\nfrom_m = 1\n",
       6,
       "unknown key \"from_m\" in plant@1",
       "perhaps you mean \"from_s\""},
      {"\"keep@1\"\nspans = [\n{form_s = 1}]\n",
       7,
       "unknown key \"form_s\" in spans",
       "perhaps you mean \"from_s\""},
      {"\"constrain@1\"\n[op.constraint]\ntype = \"Distance\"\npositon_m = 1\n",
       8,
       "unknown key \"positon_m\" in the constraint",
       "perhaps you mean \"position_m\""},
      {"\"cut@1\"\n\"from s\\n\" = 1\n",
       6,
       "unknown key \"from s?\" in cut@1",
       "perhaps you mean \"from_s\""},
  });
}

TEST(EditOpRefusal, NamesAMistakeInACommonKey) {
  expect_op_refusals({
      {"\"cut@1\"\nfrom_s = 2\nto_s = 1\n",
       7,
       "the span ends before it starts",
       "exchange its two ends"},
      {"\"cut@1\"\nfrom_s = 2\nfrom_frame = 1\n",
       7,
       "both \"from_s\" and \"from_frame\" are given",
       "remove one: they have the same meaning"},
      {"\"cut@1\"\nfrom = 1.5\n",
       6,
       "\"from\" must be the name of an annotation in quotes",
       "write from_s for seconds, or from_frame for a frame"},
      {"\"cut@1\"\nfrom = \"[2]\"\n",
       6,
       "\"from\" does not name an annotation",
       "give a name, as in \"left.strike[2]\": the third strike"},
      {"\"cut@1\"\nfrom = \"a[99999999999]\"\n",
       6,
       "\"from\" has a number above 1000000 in brackets",
       "give the number of the occurrence, counted from 0"},
      {"\"cut@1\"\nfrom_s = -1\n",
       6,
       "\"from_s\" is -1, not between 0 and 1e+06 s",
       "give it in s"},
      {"\"cut@1\"\nfrom_s = inf\n",
       6,
       "\"from_s\" must be a number that is finite",
       kSeeThePage},
      {"\"cut@1\"\noff = 1\n", 6, "\"off\" must be true or false", kSeeThePage},
      {"\"plant@1\"\ngroups = [\"left_arms\"]\n",
       6,
       "there is no group \"left_arms\"",
       "perhaps you mean \"left_arm\""},
      {"\"plant@1\"\ngroups = [\"root\", \"root\"]\n",
       6,
       "\"root\" is listed twice",
       "remove one"},
      {"\"plant@1\"\ngroups = []\n",
       6,
       "\"groups\" is empty",
       "name a group, or remove the key"},
      {"\"plant@1\"\ngroups = \"root\"\n",
       6,
       "\"groups\" must be a list of texts in quotes",
       kSeeThePage},
      {"\"plant@1\"\nblend_s = -0.1\n",
       6,
       "\"blend_s\" is -0.1, not between 0 and 1000 s",
       "give it in s"},
  });
}

TEST(EditOpRefusal, NamesAMissingKey) {
  expect_op_refusals({
      {"\"splice@1\"\n", 4, "the key \"source\" is missing in splice@1", kAddIt},
      {"\"keep@1\"\n", 4, "a key is missing: spans", "add it"},
      {"\"split@1\"\ninstants = [{}]\n",
       6,
       "the key \"at_s\" is missing",
       "add at_s (seconds), at_frame or at (an annotation)"},
      {"\"event@1\"\ntext = \"a\"\n",
       4,
       "the key \"at_s\" is missing",
       "add at_s (seconds), at_frame or at (an annotation)"},
      {"\"pose@1\"\nat_s = 1\nbone = \"head\"\n",
       4,
       "a key is missing: moved_m, rotation_deg, rotation_wxyz",
       "add one of them"},
      {"\"place@1\"\n",
       4,
       "a key is missing: position_xz_m, heading_deg",
       "add one of them"},
      {"\"retime@1\"\n",
       4,
       "a key is missing: knots, speed, duration_s, rate_hz",
       "add one of them"},
      {"\"contacts@1\"\nedits = [{do = \"set\"}]\n",
       6,
       "the key \"foot\" is missing in edits",
       kAddIt},
      {"\"constrain@1\"\n",
       4,
       "a key is missing: constraint, detect, changes, adapt",
       "add one of them"},
      {"\"constrain@1\"\ndetect = \"touches\"\n",
       4,
       "a key is missing: objects",
       "add it"},
      {"\"constrain@1\"\nchanges = [{start_s = 1}]\n",
       6,
       "the key \"name\" is missing in changes",
       kAddIt},
      {"\"constrain@1\"\nchanges = [{name = \"a\"}]\n",
       6,
       "the change of \"a\" changes nothing",
       "give start, stop, start_duration_s, stop_duration_s or position_m"},
      {"\"constrain@1\"\n[op.constraint]\ntype = \"Orientation\"\nname = \"a\"\n"
       "segment = \"head\"\n",
       6,
       "the key \"orientation_deg\" is missing in the constraint",
       "add orientation_deg, or orientation_wxyz for a quaternion"},
  });
}

TEST(EditOpRefusal, NamesAWrongValue) {
  expect_op_refusals({
      {"\"filter@1\"\nmethod = \"gvc\"\n",
       6,
       "\"method\" cannot be \"gvc\"",
       "choose one of \"gcv\", \"butterworth\""},
      {"\"filter@1\"\norder = 4\n",
       6,
       "\"order\" is 4, not between 2 and 3",
       "correct the number"},
      {"\"filter@1\"\norder = 2.5\n",
       6,
       "\"order\" must be a whole number",
       "correct the number"},
      {"\"pose@1\"\nat_s = 1\nbone = \"leftHnd\"\nmoved_m = [0, 0, 0]\n",
       7,
       "there is no bone \"leftHnd\"",
       "perhaps you mean \"leftHand\""},
      {"\"offset@1\"\nbone = \"head\"\nmoved_m = [0, 1]\n",
       7,
       "\"moved_m\" must be an array of 3 numbers",
       kSeeThePage},
      {"\"offset@1\"\nbone = \"head\"\nmoved_m = [0, 1e5, 0]\n",
       7,
       "\"moved_m\" contains 1e+05, not between -10000 and 10000 m",
       "give it in m"},
      {"\"offset@1\"\nbone = \"head\"\nrotation_wxyz = [1, 1, 0, 0]\n",
       7,
       "\"rotation_wxyz\" is not a unit quaternion",
       "divide it by its length"},
      {"\"offset@1\"\nbone = \"head\"\nrotation_deg = [0, 400, 0]\n",
       7,
       "\"rotation_deg\" contains 400, not between -360 and 360 degrees",
       "give it in degrees"},
      {"\"path@1\"\npoints_xz_m = [[0, 0, 0]]\n",
       6,
       "\"points_xz_m\" must be an array of 2 numbers",
       kSeeThePage},
      {"\"constrain@1\"\n[op.constraint]\ntype = \"Distanse\"\n",
       7,
       "there is no type of constraint \"Distanse\"",
       "perhaps you mean \"Distance\""},
      {"\"tag@1\"\ntext = \"a\\nb\"\n",
       6,
       "\"text\" contains a line end or a control character",
       "write one line of text"},
  });
}

TEST(EditOpRefusal, NamesKeysThatContradictEachOther) {
  expect_op_refusals({
      {"\"filter@1\"\ncutoff_hz = 6\n",
       6,
       "\"cutoff_hz\" is for the Butterworth filter only",
       "add method = \"butterworth\", or remove it"},
      {"\"filter@1\"\nmethod = \"butterworth\"\norder = 2\n",
       7,
       "\"order\" is for the spline only",
       "remove it"},
      {"\"filter@1\"\nmethod = \"butterworth\"\ncutoff = \"yu\"\ncutoff_hz = 6\n",
       8,
       "\"cutoff\" and \"cutoff_hz\" exclude each other",
       "remove one"},
      {"\"path@1\"\npoints_xz_m = [[0, 0], [1, 0]]\nturn_deg = 9\n",
       7,
       "\"points_xz_m\" and \"turn_deg\" exclude each other",
       "remove one"},
      {"\"path@1\"\npoints_xz_m = [[0, 0]]\n",
       6,
       "the path has one point",
       "give two or more"},
      {"\"retime@1\"\nspeed = 2\nduration_s = 1\n",
       7,
       "\"speed\" and \"duration_s\" exclude each other",
       "remove one"},
      {"\"retime@1\"\nknots = [{at_s = 1, time_s = 1}, {at_s = 2, time_s = 1}]\n",
       6,
       "\"knots\" does not ascend",
       "give each instant once, the earlier one first"},
      {"\"curve@1\"\nname = \"a\"\nkeys = [{at_s = 1, value = 1}, {at_s = 0, value = "
       "1}]\n",
       7,
       "\"keys\" does not ascend",
       "give each instant once, the earlier one first"},
      {"\"cyclify@1\"\nmin_period_s = 2\nmax_period_s = 1\n",
       7,
       "\"max_period_s\" is less than \"min_period_s\"",
       "exchange them"},
      {"\"exaggerate@1\"\nlow_hz = 3\nhigh_hz = 2\n",
       7,
       "\"high_hz\" is not above \"low_hz\"",
       "give the lower frequency as low_hz, or leave high_hz out"},
      {"\"constrain@1\"\ndetect = \"touches\"\nobjects = [\n"
       "{name = \"t\", min_m = [0, 1, 0], max_m = [1, 0, 1]}]\n",
       7,
       "\"t\" has a min_m above its max_m",
       "give the lesser coordinates first"},
      {"\"jump@1\"\nblend = 1\n",
       6,
       "unknown key \"blend\" in jump@1",
       "perhaps you mean \"blend_s\""},
  });
}

}  // namespace
}  // namespace marey::recordings
