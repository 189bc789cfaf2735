// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "tests/recordings/body/constraint_text.h"

namespace marey::recordings {
namespace {

using namespace testing;

TEST(ConstraintsFile, RefusesWithLineCauseAndNextStep) {
  EXPECT_EQ(
      refusal(annex_with("0.13", "0,13")),
      "c.xml:17: <Z> is \"0,13\", which is not a number. Next: write a number, with a "
      "decimal point.");
  EXPECT_EQ(
      refusal(annex_with("0.13", "nan")),
      "c.xml:17: <Z> is \"nan\", which is not a number. Next: write a number, with a "
      "decimal point.");
  EXPECT_EQ(
      refusal(annex_with("0.04", "40000")),
      "c.xml:16: <Y> is 40000, not between -10000 and 10000 m. Next: give it in m.");
  EXPECT_EQ(refusal(annex_with("<range>6", "<range>2.5")),
            "c.xml:11: <range> is not a whole number. Next: correct the number.");
  EXPECT_EQ(refusal(annex_with("<priority>3", "<priority>-3")),
            "c.xml:5: <priority> is -3, not between 1e-06 and 1e+06. Next: correct the "
            "number.");
  EXPECT_EQ(refusal(annex_with("<name>ctrParade</name>", "")),
            "c.xml:3: <Distance> has no <name>. Next: add it.");
  EXPECT_EQ(refusal(annex_with("ctrParade", " ")),
            "c.xml:4: <name> is empty. Next: give it a value.");
  EXPECT_EQ(refusal(annex_with("ctrParade", "ctr&#10;Parade")),
            "c.xml:4: <name> is not one line of text. Next: correct it.");
  EXPECT_EQ(refusal(annex_with("<range>6</range>", "<name>again</name>")),
            "c.xml:11: <name> is given twice, first on line 4. Next: remove one.");
  EXPECT_EQ(refusal(annex_with("<segment>", "<segment><a/>")),
            "c.xml:13: <segment> holds <a> instead of a value. Next: write the value "
            "alone.");
  EXPECT_EQ(
      refusal(annex_with("<localOffset>", "here <localOffset>")),
      "c.xml:12: <bodyPoint> holds text between its elements. Next: remove the text, "
      "or put it into an element.");
  std::string without_point = annex();
  const std::size_t from = without_point.find("    <bodyPoint>");
  const std::size_t to = without_point.find("    <specif>");
  EXPECT_EQ(refusal(without_point.erase(from, to - from)),
            "c.xml:3: <Distance> has no <bodyPoint>. Next: add it.");
}

TEST(ConstraintsFile, RefusesAnotherFileAndABrokenOne) {
  EXPECT_EQ(refusal("<COLLADA/>"),
            "c.xml:1: this is a file of <COLLADA>, not of <ConstraintsSet>. Next: name "
            "another file.");
  EXPECT_EQ(refusal("<ConstraintsSet/>\n<ConstraintsSet/>"),
            "c.xml:2: <ConstraintsSet> is after the end of <ConstraintsSet>. Next: move "
            "it inside, or remove it.");
  EXPECT_EQ(
      refusal(annex().substr(0, 300)),
      "c.xml:9: the file ends before its elements do. Next: copy the file again, or "
      "close what is open.");
  EXPECT_EQ(
      refusal(annex_with("</start_time>", "</start>")),
      "c.xml:7: not valid XML: Start-end tags mismatch. Next: correct this line, or copy "
      "the file again.");
  EXPECT_EQ(refusal(""), "c.xml:1: the file is empty. Next: copy or export it again.");
  EXPECT_EQ(refusal("notes\n"),
            "c.xml:1: this is not an XML file. Next: name an XML file.");
  EXPECT_EQ(refusal(std::string("<\0C", 3)),
            "c.xml:1: this is not UTF-8 text. Next: name an XML file, or save it as "
            "UTF-8.");
  EXPECT_EQ(refusal(annex_with("ctrParade", "par\xe9")),
            "c.xml:1: this is not UTF-8 text. Next: name an XML file, or save it as "
            "UTF-8.");
  EXPECT_EQ(refusal(annex_with("xmlns", "up=\"X\" xmlns")),
            "c.xml:2: up is \"X\" and may be \"Y\" or \"Z\". Next: write up=\"Y\" or "
            "up=\"Z\".");
  EXPECT_EQ(
      refusal(std::string((std::size_t{16} << 20) + 1, ' ')),
      "c.xml: the file has more than 16 MiB, which constraints never need. Next: name "
      "a file of constraints, or split it.");
}

TEST(ConstraintsFile, RefusesTwoConstraintsOfOneName) {
  std::string text = annex();
  const std::size_t begin = text.find("  <Distance>");
  const std::size_t end = text.find("</ConstraintsSet>");
  text.insert(end, text.substr(begin, end - begin));
  EXPECT_EQ(
      refusal(text),
      "c.xml:29: a constraint named \"ctrParade\" is on line 3 already. Next: give it "
      "another name, or remove it.");
}

}  // namespace
}  // namespace marey::recordings
