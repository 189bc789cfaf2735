// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey doctor` on the machine of the tests. Its report on cameras has tests with
// cameras: tests/capture/v4l2/probe_camera_test.cpp, v4l2_guest.cpp.
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"

namespace marey::testing {
namespace {

using Json = nlohmann::json;

class Doctor : public ::testing::Test {
 protected:
  ProgramRun run_ = run_program(marey::testing::program(), {"doctor", "--json"});
  Json said_ = Json::parse(run_.out, nullptr, false);
};

TEST_F(Doctor, FindsWhatThisMachineHas) {
  ASSERT_TRUE(said_.is_object()) << run_.out;
  for (const Json& check : said_.at("checks")) {
    EXPECT_FALSE(check.at("finding").get<std::string>().empty());
    EXPECT_EQ(check.contains("advice"), !check.at("good").get<bool>());
  }
}

TEST_F(Doctor, EndsWithFiveOnlyForCamerasAndTheFolder) {
  ASSERT_TRUE(said_.is_object()) << run_.out;
  bool device_trouble = false;
  for (const Json& check : said_.at("checks")) {
    const std::string name = check.at("check");
    device_trouble |=
        !check.at("good").get<bool>() && (name == "camera" || name == "working folder");
  }
  EXPECT_EQ(run_.exit_code, device_trouble ? 5 : 0) << run_.out;
}

TEST_F(Doctor, ReportsWhenThereIsNoCamera) {
  ASSERT_TRUE(said_.is_object()) << run_.out;
  ASSERT_TRUE(said_.at("cameras").is_array());
  const bool says_none = run_.out.find("none is plugged in") != std::string::npos;
  EXPECT_TRUE(!says_none || said_.at("cameras").empty());
  for (const Json& camera : said_.at("cameras")) {
    EXPECT_FALSE(camera.at("offers").empty());
    EXPECT_NE(camera.at("chosen").is_null(), camera.at("trouble").is_null());
  }
}

TEST_F(Doctor, ReportsTheSameChecksAsText) {
  ASSERT_TRUE(said_.is_object()) << run_.out;
  const ProgramRun words = run_program(marey::testing::program(), {"doctor"});
  EXPECT_EQ(words.exit_code, run_.exit_code);
  for (const Json& check : said_.at("checks")) {
    EXPECT_NE(words.out.find(check.at("check").get<std::string>()), std::string::npos);
  }
}

TEST_F(Doctor, NamesTheVersionThatTheProgramNames) {
  ASSERT_TRUE(said_.is_object()) << run_.out;
  EXPECT_EQ("marey " + said_.at("version").get<std::string>() + "\n",
            run_program(marey::testing::program(), {"--version"}).out);
}

}  // namespace
}  // namespace marey::testing
