// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/index_table.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

SourceFile file_named(const std::string& name) {
  SourceFile file;
  file.name = name;
  return file;
}

std::string refusal_of(const std::string& text) {
  const auto table = IndexTable::parse(text, "data.csv");
  return table ? "read" : table.error().message();
}

TEST(IndexTable, ReadsRatesDescriptionsLabelsAndSubjectsByFile) {
  const auto table = IndexTable::parse(
      "\xEF\xBB\xBF"
      "File, Rate (Hz) ;,description,labels,Subject,other\r\n"
      "walk_1.bvh,60,\"slow, \"\"easy\"\" walk\",walk; slow,Ann,x\r\n"
      "\r\n"
      "b/run,,,run\r\n",
      "data.csv");
  ASSERT_TRUE(table) << table.error().message();
  EXPECT_EQ(table->size(), 2u);
  const auto walk = table->find(file_named("a/walk_1.bvh"));
  ASSERT_TRUE(walk);
  EXPECT_EQ(walk->rate_hz, 60.0);
  EXPECT_EQ(walk->description, "slow, \"easy\" walk");
  EXPECT_EQ(walk->labels, (std::vector<std::string>{"walk", "slow"}));
  EXPECT_EQ(walk->subject, "Ann");
  EXPECT_EQ(walk->evidence, "line 2 of data.csv");
  const auto run = table->find(file_named("b/run.amc"));
  ASSERT_TRUE(run);
  EXPECT_FALSE(run->rate_hz);
  EXPECT_EQ(run->line, 4);
  EXPECT_FALSE(table->find(file_named("c/run.amc")));
  const auto labels = labels_of_index(*walk, 3.0);
  ASSERT_EQ(labels.size(), 3u);
  EXPECT_EQ(labels[0].text, "slow");
  EXPECT_EQ(labels[1].text, "slow, \"easy\" walk");
  EXPECT_EQ(labels[0].by, "index");
  EXPECT_EQ(labels[0].end_s, 3.0);
}

TEST(IndexTable, FindsSubjectAndTrialWhateverTheirZeros) {
  const auto table =
      IndexTable::parse("subject;trial;fps\n2;1;120\nbob;07;60\n", "data.csv");
  ASSERT_TRUE(table) << table.error().message();
  for (const char* name : {"2_1.bvh", "02_01.amc", "x/002_01.bvh"}) {
    const auto found = table->find(file_named(name));
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->rate_hz, 120.0);
  }
  EXPECT_TRUE(table->find(file_named("bob_7.bvh")));
  EXPECT_FALSE(table->find(file_named("2_2.bvh")));
  EXPECT_FALSE(table->find(file_named("take_2_1.bvh")));
}

TEST(IndexTable, TakesARateFromWordsOnlyIfAllLinesAgree) {
  const auto table = IndexTable::parse(
      "subject,trial,description,rate\n1,1,salsa dance,60\n1,2,salsa - turn,60\n"
      "2,1,walk,60\n2,2,walk slow,120\n",
      "data.csv");
  ASSERT_TRUE(table) << table.error().message();
  const auto salsa = table->find(file_named("salsa_17.bvh"));
  ASSERT_TRUE(salsa);
  EXPECT_EQ(salsa->rate_hz, 60.0);
  EXPECT_EQ(salsa->evidence, "2 lines of data.csv with \"salsa\"");
  EXPECT_TRUE(salsa->description.empty());
  EXPECT_FALSE(table->find(file_named("walk_03.bvh"))) << "the lines differ";
  EXPECT_FALSE(table->find(file_named("jump_03.bvh")));
}

TEST(IndexTable, RefusesBadTablesWithLineAndColumn) {
  const auto expect_refused = [](const std::string& text, const std::string& part) {
    const std::string message = refusal_of(text);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find("Next: "), std::string::npos) << message;
  };
  expect_refused("", "data.csv:1: the table has no first line");
  expect_refused("file,colour\na,b\n", "data.csv:1: no column states anything");
  expect_refused("rate,labels\n1,b\n", "data.csv:1: no column names the files");
  expect_refused("file,rate,fps\na,1,1\n", "data.csv:1: column 3");
  expect_refused("file,rate\na,60\nb,fast\n",
                 "data.csv:3: column 2 (rate): \"fast\" is not a frame rate");
  expect_refused("file,rate\na,0\n", "data.csv:2: column 2");
  expect_refused("file,rate\na,nan\n", "data.csv:2: column 2");
  expect_refused("file,rate\na,60,7\n", "data.csv:2: column 3: the line has 3 cells");
  expect_refused("file,rate\n\"a,60\n", "data.csv:2: column 1: a quote is not closed");
  expect_refused("file,rate\na,60\na,30\n", "data.csv:3: column 1 (file): \"a\" is also");
  expect_refused("file,rate\n,60\n", "data.csv:2: column 1 (file) is empty");
  expect_refused("subject,trial,rate\n1,,60\n", "data.csv:2: column 2 (trial) is empty");
}

TEST(IndexTable, ReadsTheTableOfAPublicDatabase) {
  const std::filesystem::path archive =
      marey::testing::shared_data() / "library" / "cmu.tar.xz";
  if (!std::filesystem::exists(archive)) GTEST_SKIP() << archive << " is absent";
  const testing::ScratchFolder folder;
  const std::string command = "tar xJf '" + archive.string() + "' -C '" +
                              folder.path().string() + "' 'cmu/CMU data.csv'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto table = IndexTable::read(folder / "cmu/CMU data.csv");
  ASSERT_TRUE(table) << table.error().message();
  EXPECT_EQ(table->size(), 2435u);
  const auto walk = table->find(file_named("cmu/amc/02/02_01.amc"));
  ASSERT_TRUE(walk);
  EXPECT_EQ(walk->rate_hz, 120.0);
  EXPECT_EQ(walk->description, "walk");
  EXPECT_EQ(walk->subject, "2");
  for (const char* name : {"salsa_01.bvh", "salsa_02.bvh", "salsa_16.bvh", "60_01.bvh"}) {
    const auto salsa = table->find(file_named(name));
    ASSERT_TRUE(salsa) << name;
    EXPECT_EQ(salsa->rate_hz, 60.0) << name;
  }
  EXPECT_FALSE(table->find(file_named("martial_04.bvh")));
  EXPECT_FALSE(table->find(file_named("indian_07.bvh")));
}

}  // namespace
}  // namespace marey::app
