// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/add_sources.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "app/library/sources/licence.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/library_file.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

/// A library's folder next to two folders of files.
class AddSources : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name :
         {"in/02_01.bvh", "in/02_02.bvh", "other/a.glb", "text/a.txt"}) {
      ASSERT_TRUE(recordings::write_file(folder_ / name, "x"));
    }
  }

  [[nodiscard]] AddSourcesArguments arguments() const {
    AddSourcesArguments args;
    args.library = folder_ / "lib";
    args.paths = {folder_ / "in"};
    args.licence = "cc-by-4.0";
    args.origin = "example.org";
    return args;
  }

  [[nodiscard]] std::string text() const {
    return testing::read_text(folder_ / "lib/library.toml");
  }

  static std::string refusal(const AddSourcesArguments& args) {
    const Status added = add_sources(args);
    return added ? "added" : added.error().message();
  }

  testing::ScratchFolder folder_;
};

TEST_F(AddSources, MakesALibraryAndKeepsItsText) {
  AddSourcesArguments args = arguments();
  args.rate_hz = 60.0;
  args.subject = "{subject}_*";
  args.attribution = "The dancers";
  ASSERT_EQ(refusal(args), "added");
  const std::string first = text() + "# by hand\n[quality]\nspike = [1, 2]\n";
  ASSERT_TRUE(recordings::write_file(folder_ / "lib/library.toml", first));
  AddSourcesArguments more = arguments();
  more.paths = {folder_ / "other/a.glb"};
  more.licence = "unknown";
  ASSERT_EQ(refusal(more), "added");
  EXPECT_TRUE(text().starts_with(first)) << text();
  const auto library = recordings::read_library(folder_ / "lib/library.toml");
  ASSERT_TRUE(library) << library.error().message();
  EXPECT_EQ(library->name, "lib");
  ASSERT_EQ(library->sources.size(), 2u);
  EXPECT_EQ(library->sources[0].path, (folder_ / "in").string());
  EXPECT_EQ(library->sources[0].licence, "CC-BY-4.0");
  EXPECT_EQ(library->sources[0].origin, "example.org");
  EXPECT_EQ(library->sources[0].rate_hz, 60.0);
  EXPECT_EQ(library->sources[0].subject, "{subject}_*");
  EXPECT_EQ(library->sources[1].licence, "unknown");
}

TEST_F(AddSources, StoresPathsBelowTheLibraryRelativeToIt) {
  AddSourcesArguments args = arguments();
  args.library = folder_.path();
  args.paths = {folder_ / "in/", folder_ / "other/../other"};
  ASSERT_TRUE(recordings::write_file(folder_ / "table.csv", "file,rate\na,60\n"));
  ASSERT_TRUE(recordings::write_file(folder_ / "LICENCE.txt", "as you like"));
  args.index = folder_ / "table.csv";
  args.licence = folder_ / "LICENCE.txt";
  ASSERT_EQ(refusal(args), "added");
  const auto library = recordings::read_library(folder_ / "library.toml");
  ASSERT_TRUE(library) << library.error().message();
  ASSERT_EQ(library->sources.size(), 2u);
  EXPECT_EQ(library->sources[0].path, "in");
  EXPECT_EQ(library->sources[1].path, "other");
  EXPECT_EQ(library->sources[0].index, "table.csv");
  EXPECT_EQ(library->sources[0].licence, "LICENCE.txt");
}

TEST_F(AddSources, RefusesWhatItCannotAdd) {
  const auto expect_refused = [&](const auto& change, const std::string& part) {
    AddSourcesArguments args = arguments();
    change(args);
    const std::string message = refusal(args);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find("Next: "), std::string::npos) << message;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "lib/library.toml"));
  };
  using Args = AddSourcesArguments;
  expect_refused([](Args& a) { a.licence = "CC-BY-4"; }, "CC-BY-4.0");
  expect_refused([](Args& a) { a.licence = ""; }, "licence");
  expect_refused([&](Args& a) { a.paths = {folder_ / "text"}; },
                 "no file that a library");
  expect_refused([&](Args& a) { a.paths = {folder_ / "none"}; }, "does not exist");
  expect_refused([](Args& a) { a.paths.clear(); }, "no source is given");
  expect_refused([](Args& a) { a.rate_hz = 1e6; }, "--rate");
  expect_refused([](Args& a) { a.pattern = "x{n}"; }, "fits no file");
  expect_refused([](Args& a) { a.subject = "{subject}-"; }, "fits no file");
  expect_refused([&](Args& a) { a.index = folder_ / "text/a.txt"; }, "a.txt:1");
  expect_refused(
      [&](Args& a) {
        a.paths = {folder_ / "in", folder_ / "in"};
      },
      "stated already");
  expect_refused(
      [&](Args& a) {
        a.paths = {folder_ / "in", folder_ / "in/02_01.bvh"};
      },
      "belong to sources");
  expect_refused([&](Args& a) { a.kind = "obj"; }, "unknown kind \"obj\"");
}

TEST_F(AddSources, KeepsABrokenLibraryAsItIs) {
  ASSERT_TRUE(
      recordings::write_file(folder_ / "lib/library.toml", "format = 1\nnam = 2\n"));
  const std::string message = refusal(arguments());
  EXPECT_NE(message.find("library.toml:2"), std::string::npos) << message;
  EXPECT_EQ(text(), "format = 1\nnam = 2\n");
}

TEST(SpdxLicence, ReadsExpressions) {
  const auto expect_read = [](const std::string& text, const std::string& as) {
    const auto licence = spdx_licence(text);
    ASSERT_TRUE(licence) << licence.error().message();
    EXPECT_EQ(*licence, as);
  };
  expect_read("MIT", "MIT");
  expect_read("mit OR apache-2.0", "MIT OR Apache-2.0");
  expect_read("(MIT AND CC-BY-4.0) OR LicenseRef-CMU.1",
              "(MIT AND CC-BY-4.0) OR LicenseRef-CMU.1");
  expect_read("GPL-2.0-only WITH Classpath-exception-2.0",
              "GPL-2.0-only WITH Classpath-exception-2.0");
  expect_read("EPL-2.0+", "EPL-2.0+");
  expect_read("unknown", "unknown");
  for (const char* text : {"",
                           "MIT OR",
                           "MIT MIT",
                           "(MIT",
                           "MIT)",
                           "OR MIT",
                           "free",
                           "MIT WITH magic",
                           "LicenseRef-",
                           "LicenseRef-a_b",
                           "CC-BY"}) {
    const auto licence = spdx_licence(text);
    ASSERT_FALSE(licence) << text;
    EXPECT_FALSE(licence.error().next.empty());
  }
}

}  // namespace
}  // namespace marey::app
