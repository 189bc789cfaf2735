// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/floor_file.h"

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/program/paths.h"

namespace marey::recordings {
namespace {

// The example of docs/formats/floor.md: the first toml block after its heading.
std::string documented_floor() {
  return marey::testing::formats_example("floor");
}

Floor parsed_floor(const std::string& text) {
  const Result<Floor> floor = parse_floor(text, "f.toml");
  EXPECT_TRUE(floor) << (floor ? "" : floor.error().message());
  return floor ? *floor : Floor{};
}

TEST(FloorFile, ReadsTheExampleOfTheDocumentation) {
  const Floor floor = parsed_floor(documented_floor());
  EXPECT_EQ(floor.base_height_m, 0.0);
  ASSERT_EQ(floor.parts.size(), 3U);
  EXPECT_EQ(floor.parts[0].name, "step");
  EXPECT_EQ(floor.parts[0].min_xz_m, glm::dvec2(-1.0, 1.35));
  EXPECT_EQ(floor.parts[0].max_xz_m, glm::dvec2(1.0, 2.0));
  EXPECT_EQ(floor.parts[0].height_m, 0.15);
  EXPECT_TRUE(floor.parts[0].path.empty());
  EXPECT_DOUBLE_EQ(floor.parts[1].height_m, 0.375);
  EXPECT_EQ(floor.parts[1].slope.x, 0.0);
  EXPECT_DOUBLE_EQ(floor.parts[1].slope.y, 0.15);
  ASSERT_EQ(floor.parts[2].path.size(), 3U);
  EXPECT_EQ(floor.parts[2].path[2].time_s, 4.0);
  EXPECT_EQ(floor.parts[2].path[2].moved_m, glm::dvec3(0.3, 0.2, 0.0));
}

TEST(FloorFile, RoundTripsAFloor) {
  Floor floor{-1.0 / 3.0, {}};
  floor.parts.push_back({"a \"step\"", {-0.1, 0.2}, {1.0 / 7.0, 9.0}, 0.17, {0, 0}, {}});
  floor.parts.push_back({"é", {-4, -1}, {4, 7}, 0.1, {-0.25, 0}, {{-1.5, {1e-9, 2, 3}}}});
  floor.parts.push_back(
      {"c", {0, 0}, {1, 1}, -3.0, {0, 1.7}, {{0, {}}, {0.1, {1, 0, 0}}}});
  const Floor read = parsed_floor(floor_text(floor));
  EXPECT_EQ(read.base_height_m, floor.base_height_m);
  ASSERT_EQ(read.parts.size(), floor.parts.size());
  for (std::size_t i = 0; i < read.parts.size(); ++i) {
    const FloorPart& a = read.parts[i];
    const FloorPart& b = floor.parts[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.min_xz_m, b.min_xz_m);
    EXPECT_EQ(a.max_xz_m, b.max_xz_m);
    // Ramps go through the heights of their edges.
    EXPECT_NEAR(a.height_m, b.height_m, 1e-15);
    EXPECT_NEAR(a.slope.x, b.slope.x, 1e-15);
    EXPECT_NEAR(a.slope.y, b.slope.y, 2e-15);
    ASSERT_EQ(a.path.size(), b.path.size());
    for (std::size_t k = 0; k < a.path.size(); ++k) {
      EXPECT_EQ(a.path[k].time_s, b.path[k].time_s);
      EXPECT_EQ(a.path[k].moved_m, b.path[k].moved_m);
    }
  }
  EXPECT_EQ(read.parts[0].height_m, 0.17);
}

TEST(FloorFile, RefusesBrokenFilesWithTheirLine) {
  struct Fault {
    const char* from;
    const char* to;
    const char* line;
    const char* says;
  };
  for (const Fault& fault : {
           Fault{"format = 1", "format = 2", ":1", "format"},
           Fault{"base_m = 0.0", "base_m = nan", ":2", "base_m"},
           Fault{"base_m = 0.0", "base = 0.0", ":2", "perhaps you mean \"base_m\""},
           Fault{"base_m = 0.0", "base_m = 0.0.0", ":2", ""},
           Fault{"\"step\"", "\"\"", ":5", "empty"},
           Fault{"\"ramp\"", "\"step\"", ":11", "another part"},
           Fault{"x_m = [-1.0, 1.0]", "x_m = [1.0, -1.0]", ":6", "no length"},
           Fault{"x_m = [-1.0, 1.0]", "x_m = [1.0, 1.0]", ":6", "no length"},
           Fault{"x_m = [-1.0, 1.0]", "x_m = [-1.0, inf]", ":6", "x_m"},
           Fault{"x_m = [-1.0, 1.0]", "x_m = [-1.0, 1e9]", ":6", "10 km"},
           Fault{"x_m = [-1.0, 1.0]", "x_m = 2.0", ":6", "array of 2"},
           Fault{"x_m = [-1.0, 1.0]\n", "", ":4", "\"x_m\" is missing"},
           Fault{"top_m = 0.15", "top_m = nan", ":8", "top_m"},
           Fault{"top_m = 0.15", "", ":4", "no height"},
           Fault{
               "top_m = 0.15", "top_m = 0.15\nramp_x_m = [0, 1]", ":4", "more than one"},
           Fault{"[0.15, 0.6]", "[0.15, 6.0]", ":14", "60 degrees"},
           Fault{"[0.0, 2.0, 4.0]", "[0.0, 4.0, 4.0]", ":21", "ascend"},
           Fault{"[0.0, 2.0, 4.0]", "[0.0, nan, 4.0]", ":21", "times_s"},
           Fault{"[0.0, 2.0, 4.0]", "[0.0, 2.0]", ":22", "rows"},
           Fault{"times_s = [0.0, 2.0, 4.0]", "", ":16", "\"times_s\" is missing"},
           Fault{"[0.3, 0.2, 0.0]", "[0.3, 0.2]", ":22", "array of 3"},
       }) {
    std::string text = documented_floor();
    const std::size_t at = text.find(fault.from);
    ASSERT_NE(at, std::string::npos) << fault.from;
    text.replace(at, std::string(fault.from).size(), fault.to);
    const Result<Floor> floor = parse_floor(text, "f.toml");
    ASSERT_FALSE(floor) << fault.to;
    EXPECT_EQ(floor.error().code, Errc::kBadInput);
    const std::string message = floor.error().message();
    EXPECT_NE(message.find(std::string("f.toml") + fault.line), std::string::npos)
        << message << " for " << fault.to;
    EXPECT_NE(message.find(fault.says), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace marey::recordings
