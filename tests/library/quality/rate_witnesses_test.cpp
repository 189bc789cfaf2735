// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/rate_witnesses.h"

#include <gtest/gtest.h>

namespace marey::library {
namespace {

TEST(RateWitnesses, TheOptionGoesBeforeTheTableAndTheFile) {
  EXPECT_FALSE(choose_rate({}).has_value());
  EXPECT_EQ(choose_rate({30.0})->hz, 30.0);
  EXPECT_EQ(choose_rate({30.0})->basis, RateBasis::kFile);
  EXPECT_EQ(choose_rate({std::nullopt, 60.0})->basis, RateBasis::kTable);
  EXPECT_EQ(choose_rate({120.0, 60.0, 50.0})->hz, 50.0);
  EXPECT_EQ(choose_rate({120.0, 60.0, 50.0})->basis, RateBasis::kOption);
}

// CMU's table states 60 Hz for salsa, the files 120.
TEST(RateWitnesses, ATableContradictsAFile) {
  const auto salsa =
      choose_rate({1.0 / 0.00833333, 60.0, std::nullopt, std::nullopt, 2243});
  EXPECT_EQ(salsa->hz, 60.0);
  EXPECT_NEAR(salsa->figure.value, 2.0, 1e-5);
  EXPECT_EQ(choose_rate({1.0 / 0.00833333, 120.0})->figure.value, 1.0);
  EXPECT_EQ(choose_rate({29.97, 30.0})->figure.value, 1.0);
}

// CMU 02_01 was recorded at 120 Hz; a copy has each second frame.
TEST(RateWitnesses, AResampledCopyHasTheDurationOfTheTable) {
  const auto copy = choose_rate({60.0, 120.0, std::nullopt, 171 / 60.0, 171});
  EXPECT_EQ(copy->hz, 60.0);
  EXPECT_EQ(copy->basis, RateBasis::kFile);
  EXPECT_EQ(copy->figure.value, 1.0);
  const auto wrong = choose_rate({60.0, 120.0, std::nullopt, 171 / 60.0, 343});
  EXPECT_EQ(wrong->hz, 120.0);
  EXPECT_NEAR(wrong->figure.value, 2.0, 1e-12);
}

TEST(RateWitnesses, ASecondWitnessConfirmsTheOption) {
  EXPECT_NEAR(choose_rate({120.0, std::nullopt, 60.0})->figure.value, 2.0, 1e-12);
  EXPECT_EQ(choose_rate({120.0, 60.0, 60.0})->figure.value, 1.0);
}

}  // namespace
}  // namespace marey::library
