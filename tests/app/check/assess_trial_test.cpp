// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Verdicts on solved trials: clocks, residuals and the floor.
#include "app/check/assess_trial.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/check/assess_body.h"
#include "app/check/assess_floor_height.h"
#include "app/check/assess_offsets.h"
#include "core/skeleton.h"
#include "reconstruct/tags/trial_residuals.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::app {
namespace {

using calib::ClockOffset;
using recordings::Session;
using recordings::Trial;
using recordings::TrialKind;
using testing::Movement;

constexpr double kHz = 30.0;
constexpr int kTrialFrames = 60;

bool says(const Finding& finding, const std::string& words) {
  return finding.message().find(words) != std::string::npos;
}

Session session_of(const std::vector<Camera>& cameras) {
  Session session;
  session.file = "session.toml";
  session.cameras = testing::names_of(cameras);
  return session;
}

/// A walk whose videos have these offsets in session.toml.
Trial walk_with(const std::vector<double>& offsets_s) {
  Trial trial;
  trial.name = "walk";
  trial.line = 7;
  for (std::size_t c = 0; c < offsets_s.size(); ++c) {
    trial.videos.push_back(
        {CameraId{static_cast<int>(c)}, "cam.mp4", from_seconds(offsets_s[c]), 0});
  }
  return trial;
}

/// Returns the offsets of four cameras as their tags determine them, with a sigma of
/// 0.2 ms.
std::vector<ClockOffset> seen(const std::vector<double>& offsets_s) {
  std::vector<ClockOffset> out;
  for (const double s : offsets_s) out.push_back({s, 2e-4});
  return out;
}

const std::vector<double> kTrue_s{0.0, 0.0073, -0.0111, 0.0049};

TEST(AssessOffsets, AcceptsOffsetsThatAgreeWithTheTags) {
  const Session session = session_of(testing::ring_of_cameras());
  EXPECT_FALSE(assess_offsets(session, walk_with(kTrue_s), seen(kTrue_s)));
  // Differences of two milliseconds are accepted, and clocks that tags do not determine.
  EXPECT_FALSE(
      assess_offsets(session, walk_with(kTrue_s), seen({0.0, 0.0093, -0.0091, 0.0049})));
  auto unknown = seen({0.0, 0.0, 0.0, 0.0});
  for (ClockOffset& clock : unknown) clock.sigma_s = 1.0;
  EXPECT_FALSE(assess_offsets(session, walk_with(kTrue_s), unknown));
}

TEST(AssessOffsets, NamesCameraAmountAndKey) {
  const Session session = session_of(testing::ring_of_cameras());
  const auto error =
      assess_offsets(session, walk_with({0.0, 0.0073, 0.0, 0.0049}), seen(kTrue_s));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->severity, Severity::kPoor);
  EXPECT_TRUE(says(*error, "session.toml:7: trial walk")) << error->message();
  EXPECT_TRUE(says(*error, session.cameras[2] + " is 0.0 ms")) << error->message();
  EXPECT_TRUE(says(*error, "-11.1 ms by its tags")) << error->message();
  EXPECT_TRUE(says(*error, "time_offset_s")) << error->message();
  EXPECT_FALSE(says(*error, session.cameras[1] + " is")) << error->message();
}

TEST(AssessOffsets, ReportsTheOtherSignAndTheFirstCamera) {
  const Session session = session_of(testing::ring_of_cameras());
  const auto sign =
      assess_offsets(session, walk_with({0.0, -0.0073, 0.0111, -0.0049}), seen(kTrue_s));
  ASSERT_TRUE(sign);
  EXPECT_TRUE(says(*sign, "with the other sign they would agree")) << sign->message();
  const auto first =
      assess_offsets(session, walk_with({0.02, 0.0073, -0.0111, 0.0049}), seen(kTrue_s));
  ASSERT_TRUE(first);
  EXPECT_TRUE(says(*first, "the offset of " + session.cameras[0] + " is wrong"))
      << first->message();
}

TEST(AssessTrialOffsets, FindsThemFromTheTagsOfAWalk) {
  const Body body = testing::tagged_person();
  const auto cameras = testing::ring_of_cameras();
  Session session = session_of(cameras);
  session.tags = testing::tags_of(body);
  testing::Film film;
  film.frames = kTrialFrames;
  film.hz = kHz;
  film.disturbance.noise_px = 0.1;
  film.offsets_s = kTrue_s;
  auto found = testing::film(body, testing::walking(body), cameras, film);
  const auto check = [&](const std::vector<double>& given_s) {
    for (std::size_t c = 0; c < found.size(); ++c) {
      found[c].offset = from_seconds(given_s[c]);
    }
    return assess_trial_offsets(session, walk_with(given_s), cameras, found, 1e-3);
  };
  EXPECT_FALSE(check(kTrue_s));
  const auto wrong = check({0.0, -0.0073, 0.0111, -0.0049});
  ASSERT_TRUE(wrong);
  EXPECT_TRUE(says(*wrong, "with the other sign")) << wrong->message();
}

/// A walk that is solved without an error, and its detections by cameras with these
/// clocks and this detector.
struct SolvedWalk {
  Body body = testing::tagged_person();
  std::vector<Camera> cameras = testing::ring_of_cameras();
  std::vector<CameraDetections> detections;
  reconstruct::SolvedTrial solved;

  explicit SolvedWalk(std::vector<double> offsets_s = {}) {
    testing::Film film;
    film.frames = kTrialFrames;
    film.hz = kHz;
    film.disturbance.noise_px = 0.1;
    film.offsets_s = std::move(offsets_s);
    const Movement movement = testing::walking(body);
    detections = testing::film(body, movement, cameras, film);
    Motion& motion = solved.estimate.motion;
    motion.skeleton = make_humanoid(body.proportions);
    motion.rate = FrameRate{kHz};
    for (int f = 0; f < kTrialFrames; ++f) motion.poses.push_back(movement(f / kHz));
    solved.cameras.resize(cameras.size());
  }

  [[nodiscard]] reconstruct::TrialResiduals residuals() const {
    return reconstruct::trial_residuals(body, cameras, detections, solved);
  }
  [[nodiscard]] std::optional<Finding> verdict(
      const std::vector<double>& given_s = {}) const {
    return assess_trial(session_of(cameras), walk_with(given_s), residuals());
  }
};

TEST(TrialResiduals, AreTheDetectorsWhereNothingIsWrong) {
  const auto residuals = SolvedWalk().residuals();
  EXPECT_GT(residuals.all.corners, 1000);
  EXPECT_LT(residuals.all.rms_m, 1e-3);
  for (const auto& camera : residuals.cameras) {
    EXPECT_LT(std::abs(camera.late_s), 5e-4);
    EXPECT_LT(camera.explained, 0.05);
  }
  ASSERT_EQ(residuals.stretches.size(), 4U);
  EXPECT_EQ(residuals.stretches[1].first_frame, 15);
  EXPECT_FALSE(SolvedWalk().verdict());
}

TEST(TrialResiduals, EstimateTheDelayOfACamera) {
  const auto residuals = SolvedWalk({0.0, 0.0, 0.012, 0.0}).residuals();
  EXPECT_NEAR(residuals.cameras[2].late_s, 0.012, 0.001);
  EXPECT_GT(residuals.cameras[2].explained, 0.8);
}

TEST(AssessTrial, NamesTheCameraWhoseClockIsOff) {
  const auto found = SolvedWalk({0.0, 0.0, 0.012, 0.0}).verdict();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->severity, Severity::kPoor);
  EXPECT_TRUE(says(*found, "by 12 ms or more late")) << found->message();
  EXPECT_TRUE(says(*found, "skip no frames")) << found->message();
  const auto given = SolvedWalk({0.0, 0.0, 0.012, 0.0}).verdict({0.0, 0.0, 0.001, 0.0});
  ASSERT_TRUE(given);
  EXPECT_TRUE(says(*given, "correct time_offset_s")) << given->message();
}

TEST(AssessTrial, NamesTheTagThatSitsElsewhere) {
  SolvedWalk walk;
  auto& tag = walk.body.tags[12];
  tag.segment_from_tag.translation += glm::dvec3(0.0, 0.012, 0.0);
  const auto found = walk.verdict();
  ASSERT_TRUE(found);
  EXPECT_TRUE(says(*found, "tag " + std::to_string(number(tag.tag.id))))
      << found->message();
}

TEST(AssessTrial, NamesTheFramesThatDoNotFit) {
  SolvedWalk walk;
  for (std::size_t f = 30; f < 45; ++f) {
    walk.solved.estimate.motion.poses[f].root_in_world.y += 0.025;
  }
  const auto found = walk.verdict();
  ASSERT_TRUE(found);
  EXPECT_TRUE(says(*found, "in frames 30 to 44")) << found->message();
}

/// Returns a standing trial's soles at `height_m` above the floor.
SoleHeight standing_at(double height_m) {
  return {"static", height_m};
}

Session with_floor(double thickness_m) {
  Session session;
  session.file = "session.toml";
  AprilGrid board{6, 6, 0.1, 0.03, 0, 0.0};
  board.thickness_m = thickness_m;
  session.target = board;
  Trial floor;
  floor.name = "floor";
  floor.kind = TrialKind::kFloor;
  session.trials.push_back(floor);
  return session;
}

TEST(AssessFloorHeight, PassesShoes) {
  const Session session = with_floor(0.005);
  EXPECT_FALSE(assess_floor_height(session, standing_at(0.03), {}));
  EXPECT_FALSE(assess_floor_height(session, standing_at(-0.015), {}));
}

TEST(AssessFloorHeight, NamesTheThicknessOfTheBoard) {
  const std::vector<SoleHeight> motions{{"walk", 0.09}};
  const auto finding = assess_floor_height(with_floor(0.1), standing_at(0.095), motions);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->severity, Severity::kPoor);
  EXPECT_TRUE(says(*finding, "95 mm above the floor, and equally high in the motions"))
      << finding->message();
  EXPECT_TRUE(
      says(*finding, "thickness_m under [board] (0.100 now, about 95 mm too much"))
      << finding->message();
}

TEST(AssessFloorHeight, NamesTheLowestCornerThatWouldFitWhereNoFloorTrialIs) {
  Session session;
  session.calibration.lowest_corner_m = 0.11;
  const auto finding = assess_floor_height(session, standing_at(0.06), {});
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->severity, Severity::kFair);
  EXPECT_TRUE(says(*finding, "set lowest_corner_m under [calibration] to 0.050"))
      << finding->message();
}

TEST(AssessBody, ReportsUncertainShouldersAndHips) {
  Body body = testing::tagged_person();
  EXPECT_TRUE(assess_body(body).empty());
  body.joint_centre_sigma_m[index(HumanBone::kLeftUpperArm)] = 0.016;
  body.joint_centre_sigma_m[index(HumanBone::kRightUpperLeg)] = 0.0131;
  body.joint_centre_sigma_m[index(HumanBone::kRightUpperArm)] = 0.014;
  const auto warnings = assess_body(body);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].cause.find("\"leftUpperArm\" has a standard deviation of 16 mm"),
            std::string::npos);
  EXPECT_NE(warnings[1].cause.find("\"rightUpperLeg\" has a standard deviation of 15 mm"),
            std::string::npos);
}

TEST(AssessFloorHeight, DistinguishesARaisedSubjectFromAWrongFloor) {
  const std::vector<SoleHeight> motions{{"walk", 0.002}};
  const auto box = assess_floor_height(with_floor(0.005), standing_at(0.2), motions);
  ASSERT_TRUE(box);
  EXPECT_TRUE(says(*box, "not in the motions (walk 2 mm)")) << box->message();
  EXPECT_TRUE(says(*box, "record trial static again")) << box->message();
  const auto chair = assess_floor_height(with_floor(0.005), standing_at(-0.1), {});
  ASSERT_TRUE(chair);
  EXPECT_TRUE(says(*chair, "100 mm below the floor")) << chair->message();
  EXPECT_TRUE(says(*chair, "nothing under it")) << chair->message();
}

TEST(SoleHeight, IsThatOfWhoStandsOnTheFloor) {
  const SolvedWalk walk;
  EstimatedMotion estimate;
  estimate.motion = walk.solved.estimate.motion;
  const Movement standing = testing::standing(walk.body);
  for (Pose& pose : estimate.motion.poses) {
    pose = standing(0.0);
    estimate.uncertainty.emplace_back(kHumanBoneCount,
                                      JointUncertainty{0.005, Source::kMeasured});
  }
  const auto on_floor = sole_height_m(estimate, walk.body.stature_m);
  ASSERT_TRUE(on_floor);
  EXPECT_NEAR(*on_floor, 0.0, 0.02);
  for (Pose& pose : estimate.motion.poses) pose.root_in_world.y += 0.095;
  EXPECT_NEAR(*sole_height_m(estimate, walk.body.stature_m), *on_floor + 0.095, 1e-9);
  for (auto& joints : estimate.uncertainty) {
    joints.assign(kHumanBoneCount, JointUncertainty{0.05, Source::kInferred});
  }
  EXPECT_FALSE(sole_height_m(estimate, walk.body.stature_m)) << "no camera saw the feet";
}

}  // namespace
}  // namespace marey::app
