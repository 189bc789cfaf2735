// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/throw_figures.h"

#include <gtest/gtest.h>

namespace marey::app {
namespace {

StageThrow made_throw() {
  StageThrow out;
  out.asked = {0.1, 1.5, 0.4, 0.2, 0.3, 8.0, 0.5};
  out.measured = out.asked;
  return out;
}

TEST(ThrowFigures, AThrowAsAskedDeviatesByNothing) {
  const StageThrow thrown = made_throw();
  for (const SceneFigureKind kind : {SceneFigureKind::kThrowPlace,
                                     SceneFigureKind::kThrowDirection,
                                     SceneFigureKind::kThrowSpeed,
                                     SceneFigureKind::kReleaseTime}) {
    EXPECT_NEAR(throw_figure(kind, thrown), 0.0, 1e-9);
  }
}

TEST(ThrowFigures, DeviationsAreInTheUnitsOfTheirKinds) {
  StageThrow thrown = made_throw();
  thrown.measured[0] += 0.003;
  thrown.measured[2] -= 0.004;
  thrown.measured[4] += 0.01;
  thrown.measured[5] = 7.6;
  thrown.measured[6] += 0.002;
  EXPECT_NEAR(throw_figure(SceneFigureKind::kThrowPlace, thrown), 5.0, 1e-9);
  EXPECT_NEAR(throw_figure(SceneFigureKind::kThrowDirection, thrown), 0.572958, 1e-5);
  EXPECT_NEAR(throw_figure(SceneFigureKind::kThrowSpeed, thrown), 5.0, 1e-9);
  EXPECT_NEAR(throw_figure(SceneFigureKind::kReleaseTime, thrown), 2.0, 1e-9);
}

// A turn to the side counts by the angle between the directions: less if both are steep.
TEST(ThrowFigures, TheDirectionIsTheAngleBetweenBoth) {
  StageThrow thrown = made_throw();
  thrown.asked[4] = 1.2;
  thrown.measured[4] = 1.2;
  thrown.measured[3] = thrown.asked[3] + 0.1;
  const double steep = throw_figure(SceneFigureKind::kThrowDirection, thrown);
  EXPECT_GT(steep, 1.5);
  EXPECT_LT(steep, 2.5);  // 0.1 rad are 5.7 degrees.
}

TEST(ThrowFigures, RowsNameTheTrialOfEachThrow) {
  StageRecord record;
  SceneThrow deed;
  deed.trials = "trials.toml";
  SceneAction action;
  action.deed = deed;
  record.scene.script.push_back(action);
  TrialList list;
  list.order = TrialOrder::kListed;
  list.trials = {{ThrowParameter::kCaptured, 0.0, 1}, {ThrowParameter::kSpeed, 9.0, 2}};
  record.trials["trials.toml"] = list;
  for (const std::size_t trial : {std::size_t{0}, std::size_t{2}}) {
    StageThrow thrown = made_throw();
    thrown.trial = trial;
    record.throws.push_back(thrown);
  }
  record.throws.push_back(made_throw());  // It has no list.
  const auto rows = trial_rows(record);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].number, 1);
  EXPECT_EQ(rows[0].parameter, "captured");
  EXPECT_EQ(rows[1].number, 3);
  EXPECT_EQ(rows[1].parameter, "speed_m_s");
  EXPECT_EQ(rows[1].value, 9.0);
  EXPECT_EQ(rows[1].repetition, 2);
  EXPECT_NEAR(rows[1].measured.elevation_deg, 17.188734, 1e-6);
}

}  // namespace
}  // namespace marey::app
