// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/measure_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "library/quality/quality_limits.h"
#include <gtest/gtest.h>

#include "tests/library/moved_motion.h"
#include "tests/library/quality/quality_scenes.h"

namespace marey::library {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::size_t joint(const LibraryMotion& clip, HumanBone bone) {
  return index(*clip.motion.skeleton.find(bone));
}

// A person at rest has no fault, and is still and in the T-pose.
TEST(MeasureQuality, AStandingAverageBodyPasses) {
  const QualityResult result = measured(standing_clip(90, 30.0));
  EXPECT_EQ(result.quality, Verdict::kPass);
  EXPECT_TRUE(result.problems.empty());
  EXPECT_EQ(result.main_kind, "");
  EXPECT_EQ(figure(result, "still_share").value, 1.0);
  EXPECT_EQ(figure(result, "tpose_share").value, 1.0);
  EXPECT_NEAR(figure(result, "scale_sigma").value, 0.0, 0.8);
  EXPECT_LT(figure(result, "slide_cm_s").value, 1e-9);
  EXPECT_FALSE(figure(result, "sparc").verdict.has_value());
}

TEST(MeasureQuality, AWalkPasses) {
  const QualityResult result = measured(walking_clip(200, 60.0));
  EXPECT_EQ(result.quality, Verdict::kPass) << result.main_kind;
}

// The score is the displacement over 16 mm if nothing else moves.
TEST(MeasureQuality, ASpikeHasItsScoreAndFrame) {
  LibraryMotion clip = standing_clip(60, 30.0);
  clip.motion.poses[30].root_in_world.x += 0.1;
  const ClipFigure spike = figure(measured(clip), "spike");
  EXPECT_NEAR(spike.value, 0.1 / 0.016, 1e-6);
  EXPECT_EQ(spike.frames->first, 30);
  EXPECT_EQ(spike.frames->last, 30);
  EXPECT_EQ(spike.verdict, Verdict::kFail);
}

TEST(MeasureQuality, ASlideHasItsSpeed) {
  LibraryMotion clip = standing_clip(60, 30.0);
  for (int t = 0; t < 60; ++t) {
    clip.motion.poses[static_cast<std::size_t>(t)].root_in_world.x += 0.1 * t / 30.0;
  }
  const QualityResult result = measured(clip);
  EXPECT_NEAR(figure(result, "slide_cm_s").value, 10.0, 1e-9);
  EXPECT_NEAR(figure(result, "drift_mm").value, 100.0 * 59 / 30.0, 1e-6);
  EXPECT_EQ(result.main_kind, "slide");
}

TEST(MeasureQuality, HeightsOverTheFloorAreExact) {
  LibraryMotion clip = standing_clip(60, 30.0);
  const double rest_mm = figure(measured(clip), "float_mm").value;
  for (Pose& pose : clip.motion.poses) pose.root_in_world.y += 0.03;
  EXPECT_NEAR(figure(measured(clip), "float_mm").value, 30.0 + rest_mm, 1e-6);
  EXPECT_EQ(measured(clip).main_kind, "float");
  for (Pose& pose : clip.motion.poses) pose.root_in_world.y -= 0.06;
  EXPECT_NEAR(figure(measured(clip), "sink_mm").value, 30.0 - rest_mm, 1e-6);
  EXPECT_EQ(measured(clip).main_kind, "sink");
}

// Real free fall is 1; a rate stated twice as high makes gravity four times as large.
TEST(MeasureQuality, FlightsProveTheRate) {
  LibraryMotion clip = jumping_clip(60.0);
  EXPECT_EQ(figure(measured(clip), "flights").value, 2.0);
  EXPECT_NEAR(figure(measured(clip), "rate_ratio").value, 1.0, 1e-6);
  clip.motion.rate.hz = 120.0;
  EXPECT_NEAR(figure(measured(clip), "rate_ratio").value, 4.0, 1e-6);
  EXPECT_EQ(measured(clip).main_kind, "rate");
  clip.motion.rate.hz = 30.0;
  EXPECT_NEAR(figure(measured(clip), "rate_ratio").value, 4.0, 1e-6);
}

// Legs of 1.63 m times e^0.6 are six standard deviations of 10 % off.
TEST(MeasureQuality, StatureIsInStandardDeviations) {
  const double tall =
      figure(measured(standing_clip(5, 30.0, 1.63 * std::exp(0.6))), "scale_sigma").value;
  EXPECT_NEAR(tall, 6.0, 1e-6);
}

TEST(MeasureQuality, AKneeBentForwardExceedsItsRange) {
  LibraryMotion clip = standing_clip(60, 30.0);
  for (Pose& pose : clip.motion.poses) {
    pose.parent_from_joint[joint(clip, HumanBone::kLeftLowerLeg)] =
        glm::angleAxis(-40.0 * kDegree, glm::dvec3(1.0, 0.0, 0.0));
  }
  const ClipFigure limits = figure(measured(clip), "limits_deg");
  EXPECT_NEAR(limits.value, 35.0, 1e-6);
  EXPECT_EQ(limits.joint, "leftLowerLeg");
}

TEST(MeasureQuality, GapsAndUncertaintyAreThoseOfTheSolver) {
  LibraryMotion clip = standing_clip(100, 50.0);
  const JointUncertainty seen{0.004, Source::kMeasured, Source::kMeasured};
  clip.uncertainty.assign(
      100, std::vector<JointUncertainty>(clip.motion.skeleton.joints.size(), seen));
  for (std::size_t t = 20; t < 60; ++t) {
    clip.uncertainty[t][joint(clip, HumanBone::kRightHand)].source = Source::kInferred;
  }
  const QualityResult result = measured(clip);
  EXPECT_NEAR(figure(result, "gap_share").value, 40.0 / 1200.0, 1e-12);
  EXPECT_NEAR(figure(result, "longest_gap_s").value, 0.8, 1e-12);
  EXPECT_EQ(figure(result, "longest_gap_s").joint, "rightHand");
  EXPECT_EQ(figure(result, "longest_gap_s").frames->first, 20);
  EXPECT_EQ(figure(result, "longest_gap_s").frames->last, 59);
  EXPECT_NEAR(figure(result, "sigma_p95_mm").value, 4.0, 1e-12);
}

TEST(MeasureQuality, OwnLimitsReplaceTheDefaults) {
  LibraryMotion clip = standing_clip(60, 30.0);
  for (Pose& pose : clip.motion.poses) pose.root_in_world.y += 0.03;
  const auto map = retarget::map_body(clip.motion.skeleton);
  ASSERT_TRUE(map.has_value());
  const QualityLimit loose[] = {{"float_mm", 40.0, 60.0}};
  EXPECT_EQ(measure_quality(clip, *map, loose).quality, Verdict::kPass);
  const QualityLimit strict[] = {{"float_mm", 5.0, 10.0}};
  EXPECT_EQ(measure_quality(clip, *map, strict).quality, Verdict::kFail);
}

// Figures of readers and solvers are judged by the same table.
TEST(MeasureQuality, OutsideFiguresHaveVerdictsAndProblems) {
  const LibraryMotion clip = standing_clip(60, 30.0);
  const auto map = retarget::map_body(clip.motion.skeleton);
  ASSERT_TRUE(map.has_value());
  std::vector<FoundFigure> outside{{"residual_mm", 20.0}, {"bones_mm", 1.0}};
  const QualityResult result = measure_quality(clip, *map, {}, outside);
  EXPECT_EQ(result.quality, Verdict::kWarn);
  EXPECT_EQ(result.main_kind, "residual");
  EXPECT_EQ(figure(result, "residual_mm").verdict, Verdict::kWarn);
  EXPECT_EQ(figure(result, "bones_mm").verdict, Verdict::kPass);
  ASSERT_EQ(result.problems.size(), 1U);
  EXPECT_EQ(result.problems[0].frames.first, 0);
  EXPECT_EQ(result.problems[0].frames.last, 59);
  outside[1].value = 16.0;
  outside[1].places.push_back({{3, 7}, HumanBone::kLeftHand, 16.0});
  const QualityResult broken = measure_quality(clip, *map, {}, outside);
  EXPECT_EQ(broken.quality, Verdict::kFail);
  EXPECT_EQ(broken.problems.size(), 2U);
}

TEST(MeasureQuality, ReportsSizeDurationAndSpeed) {
  LibraryMotion clip = standing_clip(61, 30.0, 1.8);
  for (int t = 0; t < 61; ++t) {
    clip.motion.poses[static_cast<std::size_t>(t)].root_in_world.z += 1.5 * t / 30.0;
  }
  const QualityResult result = measured(clip);
  EXPECT_NEAR(figure(result, "stature_m").value, 1.8, 1e-6);
  EXPECT_NEAR(figure(result, "seconds").value, 2.0, 1e-9);
  EXPECT_NEAR(figure(result, "speed_m_s").value, 1.5, 1e-9);
}

// The same person at another size has the same proportions.
TEST(MeasureQuality, ProportionsDoNotDependOnTheSize) {
  const LibraryMotion clip = walking_clip(30, 30.0);
  LibraryMotion large = clip;
  large.motion = scaled(clip.motion, 1.1);
  const QualityResult a = measured(clip);
  const QualityResult b = measured(large);
  EXPECT_NEAR(figure(a, "proportions").value, figure(b, "proportions").value, 1e-9);
  EXPECT_NE(figure(a, "proportions").value, 0.0);
  EXPECT_NEAR(figure(b, "stature_m").value, 1.1 * figure(a, "stature_m").value, 1e-9);
}

// Every figure exists and is finite, however short the motion.
TEST(MeasureQuality, ShortMotionsAndMotionsWithoutContacts) {
  for (const int frames : {1, 2, 3, 5, 8, 12, 20}) {
    LibraryMotion clip = walking_clip(frames, 30.0);
    clip.contacts.assign(clip.contacts.size(), FootParts{});
    const QualityResult result = measured(clip);
    const auto inside = std::count_if(figure_rules().begin(),
                                      figure_rules().end(),
                                      [](const auto& rule) { return !rule.is_outside; });
    EXPECT_EQ(static_cast<std::ptrdiff_t>(result.figures.size()), inside);
    for (const ClipFigure& one : result.figures) {
      EXPECT_TRUE(std::isfinite(one.value)) << one.name << " " << frames;
    }
    clip.contacts.clear();
    EXPECT_EQ(measured(clip).figures.size(), result.figures.size());
  }
}

void expect_alike(const QualityResult& a, const QualityResult& b) {
  ASSERT_EQ(a.figures.size(), b.figures.size());
  for (std::size_t k = 0; k < a.figures.size(); ++k) {
    EXPECT_NEAR(a.figures[k].value, b.figures[k].value, 1e-5 + 1e-6 * a.figures[k].value)
        << a.figures[k].name;
  }
  EXPECT_EQ(a.quality, b.quality);
  EXPECT_EQ(a.main_kind, b.main_kind);
}

TEST(MeasureQuality, DoesNotDependOnPlaceAndDirection) {
  const LibraryMotion clip = walking_clip(150, 30.0);
  LibraryMotion there = clip;
  there.motion = moved(clip.motion, 1.1, -3.0, 2.0);
  expect_alike(measured(clip), measured(there));
}

TEST(MeasureQuality, AMirroredMotionHasTheSameFigures) {
  const LibraryMotion clip = walking_clip(150, 30.0);
  LibraryMotion mirror{reflected(clip.motion), {}, {}};
  for (const FootParts& parts : clip.contacts) {
    mirror.contacts.push_back({parts[2], parts[3], parts[0], parts[1]});
  }
  expect_alike(measured(clip), measured(mirror));
}

// Angles and times do not depend on the size of a body.
TEST(MeasureQuality, AnglesAreThoseOfABodyOfAnySize) {
  const LibraryMotion clip = walking_clip(150, 30.0);
  LibraryMotion large = clip;
  large.motion = scaled(clip.motion, 1.15);
  const QualityResult a = measured(clip);
  const QualityResult b = measured(large);
  for (const char* name : {"limits_deg",
                           "frozen_s",
                           "flip_count",
                           "swap_frames",
                           "sides_share",
                           "tpose_share"}) {
    EXPECT_NEAR(figure(a, name).value, figure(b, name).value, 1e-6) << name;
  }
  EXPECT_EQ(b.quality, Verdict::kPass);
}

TEST(MeasureQuality, LimitsOfZeroAreLimits) {
  const std::vector<QualityLimit> own{{"swap_frames", 0.0, 0.0}};
  const QualityLimits limits(own);
  EXPECT_EQ(limits.verdict("swap_frames", 1.0), Verdict::kFail);
  EXPECT_EQ(limits.verdict("swap_frames", 0.0), Verdict::kPass);
  EXPECT_FALSE(limits.verdict("seconds", 1.0)) << "only reported";
}

TEST(MeasureQuality, RulesHaveDistinctNamesAndOrderedLimits) {
  std::set<std::string_view> names;
  for (const FigureRule& rule : figure_rules()) {
    EXPECT_TRUE(names.insert(rule.figure).second) << rule.figure;
    if (!rule.is_judged) continue;
    EXPECT_LT(rule.warn, rule.fail) << rule.figure;
  }
}

TEST(MeasureQuality, JointsThatAreNeverMeasuredHaveNoGaps) {
  LibraryMotion clip = walking_clip(90, 30.0);
  const JointUncertainty measured{0.002, Source::kMeasured, Source::kMeasured};
  const std::size_t joints = clip.motion.skeleton.joints.size();
  clip.uncertainty.assign(90, std::vector<JointUncertainty>(joints, measured));
  const auto set_inferred = [&](HumanBone bone, std::size_t from) {
    for (std::size_t j = 0; j < joints; ++j) {
      if (clip.motion.skeleton.joints[j].bone != bone) continue;
      for (std::size_t t = from; t < 90; ++t) {
        clip.uncertainty[t][j].source = Source::kInferred;
      }
    }
  };
  for (const HumanBone bone : {HumanBone::kLeftLowerArm, HumanBone::kRightHand}) {
    set_inferred(bone, 0);
  }
  EXPECT_EQ(figure(library::measured(clip), "gap_share").value, 0.0);
  set_inferred(HumanBone::kLeftLowerLeg, 45);
  const QualityResult result = library::measured(clip);
  EXPECT_NEAR(figure(result, "gap_share").value, 0.05, 1e-9) << "45 of 900";
  EXPECT_EQ(figure(result, "longest_gap_s").value, 1.5);
}

}  // namespace
}  // namespace marey::library
