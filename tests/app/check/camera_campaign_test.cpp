// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A small part of measure_rigs.cpp: calibrations that are simulated at the
// level of corners, some with a fault, judged as the program does.
#include <string>

#include <gtest/gtest.h>

#include "tests/app/check/judged_calibration.h"

namespace marey::testing {
namespace {

std::string words_of(const JudgedCalibration& judged) {
  std::string text;
  for (const std::string& word : judged.words) text += word + "\n";
  return text;
}

SimulationOptions short_one(RigFault fault) {
  SimulationOptions options;
  options.fault = fault;
  options.seconds = 7.0;
  return options;
}

TEST(CameraCampaign, LetsGoodCalibrationsPass) {
  for (const std::uint64_t seed : {1U, 4U}) {
    const auto judged = judge(simulate_calibration(seed, short_one(RigFault::kNone)));
    EXPECT_EQ(judged.exit_code, 0) << seed << "\n" << words_of(judged);
    EXPECT_FALSE(judged.is_silently_wrong()) << seed;
  }
}

TEST(CameraCampaign, NamesCamerasThatAreNudged) {
  for (const std::uint64_t seed : {1U, 4U}) {
    const auto judged = judge(simulate_calibration(seed, short_one(RigFault::kNudged)));
    EXPECT_EQ(judged.exit_code, 4) << seed << "\n" << words_of(judged);
    EXPECT_TRUE(judged.names_fault) << seed << "\n" << words_of(judged);
  }
}

TEST(CameraCampaign, NamesLineDelaysOfRollingShutters) {
  SimulationOptions options = short_one(RigFault::kRollingShutter);
  options.picture_s = 0.030;
  const auto judged = judge(simulate_calibration(1, options));
  EXPECT_EQ(judged.exit_code, 4) << words_of(judged);
  EXPECT_TRUE(judged.names_fault) << words_of(judged);
  EXPECT_FALSE(judged.is_silently_wrong());
}

TEST(CameraCampaign, NamesAVideoThatStatesItsRateWrongly) {
  const auto judged = judge(simulate_calibration(4, short_one(RigFault::kWrongRate)));
  EXPECT_EQ(judged.exit_code, 3) << words_of(judged);
  EXPECT_TRUE(judged.names_fault) << words_of(judged);
}

}  // namespace
}  // namespace marey::testing
