// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// More iterations never give a worse result (Kulpa 2005, 4.2).
namespace marey::retarget {
namespace {

class AdapterMerit : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterMerit, thesis_method(), name_of);

void expect_no_rise(const Character& body, AdaptOptions options, bool stands) {
  constexpr std::array<const char*, 3> kSegments{"leftHand", "rightHand", "rightFoot"};
  Dice dice(61);
  for (int i = 0; i < 60; ++i) {
    const Pose reference = random_posture(body, dice, 0.4);
    ConstraintSet asked;
    if (stands) asked.constraints.push_back(standing("stands", "leftFoot"));
    const auto count = static_cast<std::size_t>(dice.between(1, 3.999));
    for (std::size_t k = 0; k < count; ++k) {
      asked.constraints.push_back(contact(kSegments[k],
                                          kSegments[k],
                                          place_of(body, reference, {kSegments[k]}) +
                                              dice.between(0, 1.2) * dice.direction()));
    }
    Adapter adapter = make_adapter(body, asked, options);
    Pose out;
    double before = 1e9;
    for (int maximum = 1; maximum <= 25; ++maximum) {
      options.max_iterations = maximum;
      adapter.set_options(options);
      const AdaptReport report = adapter.adapt(reference, 0.0, out);
      // Single precision over a few metres.
      ASSERT_LT(report.constraint_error_m, before + 1e-6) << i << " at " << maximum;
      before = report.constraint_error_m;
    }
  }
}

TEST_P(AdapterMerit, DoesNotFallWithMoreIterations) {
  expect_no_rise(human(false), options(), false);
}

TEST_P(AdapterMerit, DoesNotFallWithMoreIterationsOnAFoot) {
  expect_no_rise(human(false), options(), true);
}

TEST_P(AdapterMerit, DoesNotFallWithMoreIterationsWithinLimits) {
  expect_no_rise(human(true), options(), true);
}

TEST_P(AdapterMerit, DoesNotFallWithMoreIterationsWhenBlended) {
  AdaptOptions blended = options();
  blended.control = Control::kBlend;
  expect_no_rise(human(false), blended, true);
}

}  // namespace
}  // namespace marey::retarget
