// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/measure_contacts.h"

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "tests/retarget/mapped.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

constexpr double kRate_hz = 60.0;

/// One of the four points, at rest at a height of 8 cm for a second, then lifted.
ContactPaths one_step() {
  ContactPaths paths;
  for (int t = 0; t < 90; ++t) {
    const double lift_m = t < 60 ? 0.0 : 0.01 * (t - 59);
    paths[0].emplace_back(0.1, 0.08 + lift_m, 0.0);
  }
  return paths;
}

TEST(ContactFigures, LabelTheFramesInWhichAPointRests) {
  const ContactLabels labels = label_contacts(one_step(), kRate_hz);
  ASSERT_EQ(labels[0].size(), 90U);
  for (std::size_t t = 0; t < 90; ++t) EXPECT_EQ(labels[0][t] != 0, t < 59) << t;
  EXPECT_TRUE(labels[1].empty() && labels[2].empty());
}

TEST(ContactFigures, MeasureSlideDriftSinkingAndFloatThatAreKnown) {
  const ContactLabels labels = label_contacts(one_step(), kRate_hz);
  // A tenth of a millimetre per frame to the side; 3 mm into the floor, then 7 mm above.
  ContactPaths paths = one_step();
  for (std::size_t t = 0; t < 90; ++t) {
    paths[0][t].x += 1e-4 * static_cast<double>(t);
    paths[0][t].y += t < 30 ? -3e-3 : 7e-3;
  }
  const ContactFigures figures =
      measure_contacts(paths, labels, {0.08, 0.08, 0.0, 0.0}, kRate_hz);
  EXPECT_NEAR(figures.mean_slide_cm_per_s, 0.6, 1e-9);
  ASSERT_EQ(figures.drifts.size(), 1U);
  EXPECT_EQ(figures.drifts[0].point, 0);
  EXPECT_EQ(figures.drifts[0].frames.first, 0);
  EXPECT_EQ(figures.drifts[0].frames.last, 58);
  EXPECT_NEAR(figures.drifts[0].drift_mm, 5.8, 1e-9);
  EXPECT_NEAR(figures.worst_drift_mm, 5.8, 1e-9);
  EXPECT_NEAR(figures.sinking_mm, 3.0, 1e-9);
  EXPECT_NEAR(figures.float_mm, 7.0, 1e-9);
  EXPECT_EQ(figures.floating_frames, 29);
}

TEST(ContactFigures, AreZeroWithoutContacts) {
  ContactPaths falling;
  for (int t = 0; t < 60; ++t) falling[0].emplace_back(0.0, 0.05 * t, 0.0);
  const ContactFigures figures =
      measure_contacts(falling, label_contacts(falling, kRate_hz), {}, kRate_hz);
  EXPECT_EQ(figures.mean_slide_cm_per_s, 0.0);
  EXPECT_TRUE(figures.drifts.empty());
}

// Jerk is proportional to the body's size, and to the third power of the rate.
TEST(ContactFigures, JerkIsThatOfPlaces) {
  const testing::SyntheticWalk walk = testing::synthetic_walk(120, kRate_hz);
  const double jerk = mean_jerk(walk.motion);
  EXPECT_GT(jerk, 0.0);
  Motion faster = walk.motion;
  faster.rate.hz = 2.0 * kRate_hz;
  EXPECT_NEAR(mean_jerk(faster), 8.0 * jerk, 1e-9 * jerk);
  Motion shortest = walk.motion;
  shortest.poses.resize(3);
  EXPECT_EQ(mean_jerk(shortest), 0.0);
  const BodyMap map = mapped(walk.motion.skeleton);
  const auto hips = map.hips();
  EXPECT_GT(mean_jerk(walk.motion, {&hips, 1}), 0.0);
}

TEST(ContactFigures, HeightIsThatOfTheStandingHead) {
  for (const double stature_m : {0.6, 1.75, 2.5}) {
    const Skeleton skeleton = make_humanoid(average_proportions(stature_m));
    const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
    const double head_m = rest[index(*skeleton.find(HumanBone::kHead))].translation.y;
    EXPECT_NEAR(head_height_m(skeleton, mapped(skeleton)), head_m, 1e-9);
  }
}

}  // namespace
}  // namespace marey::retarget
