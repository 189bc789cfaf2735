// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/solve_motion.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/reconstruct/tags/nearest_quantile.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Film;
using marey::testing::ring_of_cameras;
using marey::testing::tagged_person;
using marey::testing::tags_of;

struct Scene {
  Body truth = tagged_person();
  std::vector<Camera> cameras = ring_of_cameras();
  marey::testing::Movement movement = marey::testing::walking(truth);
  Film film{45, 30.0, "walk", {}, {}, {}};
  SolveMotionOptions options;

  explicit Scene(double noise_px = 0.0) { film.disturbance.noise_px = noise_px; }

  [[nodiscard]] std::vector<CameraDetections> detections() const {
    return marey::testing::film(truth, movement, cameras, film);
  }
  [[nodiscard]] Result<SolvedTrial> solve() const {
    return solve_motion(truth, cameras, detections(), options);
  }
  void hide(std::vector<HumanBone> bones, int first, int last) {
    film.hidden = [=](const TagOnSegment& tag, int frame) {
      return frame >= first && frame <= last &&
             std::find(bones.begin(), bones.end(), tag.segment) != bones.end();
    };
  }
};

/// Returns the distance of a joint from its truth, per frame. [m]
std::vector<double> error_m(const Scene& scene,
                            const SolvedTrial& trial,
                            HumanBone bone) {
  const Skeleton truth = make_humanoid(scene.truth.proportions);
  const Motion& motion = trial.estimate.motion;
  std::vector<double> off;
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    const auto found = world_from_joints(motion.skeleton, motion.poses[f]);
    const auto right =
        world_from_joints(truth, scene.movement(static_cast<double>(f) / scene.film.hz));
    off.push_back(
        glm::distance(found[index(bone)].translation, right[index(bone)].translation));
  }
  return off;
}

std::vector<double> limbs_off_m(const Scene& scene, const SolvedTrial& trial) {
  std::vector<double> all;
  for (const HumanBone bone : marey::testing::limb_joints()) {
    const auto of_bone = error_m(scene, trial, bone);
    all.insert(all.end(), of_bone.begin(), of_bone.end());
  }
  return all;
}

std::vector<Source> sources(const SolvedTrial& trial, HumanBone bone) {
  std::vector<Source> out;
  for (const auto& frame : trial.estimate.uncertainty)
    out.push_back(frame[index(bone)].source);
  return out;
}

TEST(SolveMotion, RecoversAWalkFromExactCorners) {
  const Scene scene;
  const auto trial = scene.solve();
  ASSERT_TRUE(trial) << trial.error().message();
  const auto off = limbs_off_m(scene, *trial);
  // Pose priors and smoothness have a ten thousandth of a sighting's weight.
  EXPECT_LT(nearest_quantile(off, 0.5), 2e-5);
  EXPECT_LT(nearest_quantile(off, 1.0), 1e-3);
  EXPECT_LT(trial->rms_px, 0.02);
  EXPECT_EQ(trial->frames_solved, scene.film.frames);
}

TEST(SolveMotion, StaysWithinMillimetresUnderNoise) {
  const Scene scene(0.2);
  const auto trial = scene.solve();
  ASSERT_TRUE(trial) << trial.error().message();
  const auto off = limbs_off_m(scene, *trial);
  // A corner is 0.8 mm off in space; a few tags and three frames determine each joint.
  EXPECT_LT(nearest_quantile(off, 0.5), 1e-3);
  EXPECT_LT(nearest_quantile(off, 0.95), 3e-3);
  EXPECT_NEAR(trial->rms_px, 0.26, 0.03);
}

TEST(SolveMotion, HasCorrectUncertainties) {
  const Scene scene(0.2);
  const auto trial = scene.solve();
  ASSERT_TRUE(trial) << trial.error().message();
  std::vector<double> in_sigmas;
  for (const HumanBone bone : marey::testing::limb_joints()) {
    const auto off = error_m(scene, *trial, bone);
    for (std::size_t f = 0; f < off.size(); ++f) {
      const double sigma_m = trial->estimate.uncertainty[f][index(bone)].sigma_m;
      in_sigmas.push_back(off[f] / (std::sqrt(3.0) * sigma_m));
    }
  }
  // The value would be 0.89 if the noise were the declared 0.3 px: 0.6.
  EXPECT_GT(nearest_quantile(in_sigmas, 0.5), 0.4);
  EXPECT_LT(nearest_quantile(in_sigmas, 0.5), 2.0);
}

TEST(SolveMotion, AddsTheBodysOwnUncertainty) {
  Scene scene;
  scene.film.frames = 10;
  const auto sure = scene.solve();
  scene.truth.joint_centre_sigma_m.fill(0.01);
  const auto unsure = scene.solve();
  ASSERT_TRUE(sure && unsure);
  for (const HumanBone bone : human_bones()) {
    const double before_m = sure->estimate.uncertainty[5][index(bone)].sigma_m;
    const double after_m = unsure->estimate.uncertainty[5][index(bone)].sigma_m;
    const std::string_view text = name(bone);
    const bool is_elbow = text.ends_with("LowerArm");
    const bool is_end = text.ends_with("Hand") || text.ends_with("Foot");
    const bool is_hip = text.ends_with("UpperLeg");
    const bool is_knee = text.ends_with("LowerLeg");
    const double added_m = is_elbow  ? 0.008
                           : is_knee ? 0.011
                           : is_end  ? 0.0085
                           : is_hip  ? 0.0115
                                     : 0.01;
    EXPECT_NEAR(after_m, std::hypot(added_m, before_m), 1e-12) << text;
  }
}

// Tags of an arm that one camera sees: the depth of its elbow depends on the shoulder.
TEST(SolveMotion, KnowsAnElbowBeforeOneCameraByItsShoulder) {
  Scene scene;
  scene.film.frames = 10;
  scene.truth.joint_centre_sigma_m[index(HumanBone::kLeftUpperArm)] = 0.02;
  auto detections = scene.detections();
  const auto elbow_m = [&] {
    const auto trial =
        solve_motion(scene.truth, scene.cameras, detections, scene.options);
    return trial->estimate.uncertainty[5][index(HumanBone::kLeftLowerArm)].sigma_m;
  };
  const double before_m = elbow_m();
  const auto is_of_arm = [&](const TagDetection& seen) {
    return std::ranges::any_of(scene.truth.tags, [&](const PlacedTag& tag) {
      return tag.tag.id == seen.id && (tag.tag.segment == HumanBone::kLeftUpperArm ||
                                       tag.tag.segment == HumanBone::kLeftLowerArm);
    });
  };
  bool is_seen = false;
  for (CameraDetections& camera : detections) {
    const bool keeps = !is_seen && std::ranges::any_of(camera.frames[5].tags, is_of_arm);
    is_seen |= keeps;
    if (keeps) continue;
    for (FrameDetections& frame : camera.frames) std::erase_if(frame.tags, is_of_arm);
  }
  ASSERT_TRUE(is_seen);
  EXPECT_LT(before_m, 0.005);
  EXPECT_GT(elbow_m(), 0.010);
}

TEST(SolveMotion, FindsByHowMuchCamerasAreLate) {
  Scene scene(0.2);
  scene.film.offsets_s = {0.0, 0.0073, -0.0111, 0.0049};
  const auto trial = scene.solve();
  ASSERT_TRUE(trial) << trial.error().message();
  for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
    EXPECT_NEAR(trial->cameras[c].offset_s, scene.film.offsets_s[c], 1e-3);
    EXPECT_EQ(trial->cameras[c].clock,
              c == 0 ? ClockSource::kReference : ClockSource::kEstimated);
  }
  // With them the walk is as accurate as without any.
  EXPECT_LT(nearest_quantile(limbs_off_m(scene, *trial), 0.95), 3e-3);
}

TEST(SolveMotion, KeepsAnOffsetThatIsGiven) {
  Scene scene;
  scene.film.frames = 20;
  auto detections = scene.detections();
  detections[2].offset = from_seconds(0.004);  // Wrong, but given by the user.
  const auto trial = solve_motion(scene.truth, scene.cameras, detections, scene.options);
  ASSERT_TRUE(trial) << trial.error().message();
  EXPECT_EQ(trial->cameras[2].offset_s, 0.004);
  EXPECT_EQ(trial->cameras[2].clock, ClockSource::kGiven);
  EXPECT_EQ(trial->cameras[1].clock, ClockSource::kEstimated);
}

TEST(SolveMotion, CallsABridgedSegmentRepaired) {
  Scene scene;
  scene.hide({HumanBone::kLeftHand}, 12, 26);  // Half a second.
  const auto trial = scene.solve();
  ASSERT_TRUE(trial) << trial.error().message();
  std::vector<Source> expected(45, Source::kMeasured);
  std::fill(expected.begin() + 12, expected.begin() + 27, Source::kRepaired);
  EXPECT_EQ(sources(*trial, HumanBone::kLeftHand), expected);
  ASSERT_EQ(trial->gaps.size(), 1U);
  EXPECT_EQ(trial->gaps[0].segment, HumanBone::kLeftHand);
  EXPECT_EQ(trial->gaps[0].first_frame, 12);
  EXPECT_EQ(trial->gaps[0].last_frame, 26);
  EXPECT_EQ(trial->gaps[0].bridged_as, Source::kRepaired);
}

TEST(SolveMotion, CallsASegmentHiddenForTooLongInferred) {
  Scene scene;
  scene.hide({HumanBone::kLeftHand}, 12, 26);
  scene.options.max_repair_s = 0.4;
  const auto trial = scene.solve();
  ASSERT_TRUE(trial) << trial.error().message();
  EXPECT_EQ(sources(*trial, HumanBone::kLeftHand)[11], Source::kMeasured);
  EXPECT_EQ(sources(*trial, HumanBone::kLeftHand)[20], Source::kInferred);
}

TEST(SolveMotion, CallsASegmentHiddenForEverInferred) {
  Scene scene;
  scene.hide({HumanBone::kRightHand}, 0, 1000);
  const auto trial = scene.solve();
  ASSERT_TRUE(trial) << trial.error().message();
  const std::vector<Source> never(45, Source::kInferred);
  EXPECT_EQ(sources(*trial, HumanBone::kRightHand), never);
  // There is no tag on the neck: inferred, but not a gap.
  EXPECT_EQ(sources(*trial, HumanBone::kNeck), never);
  ASSERT_EQ(trial->gaps.size(), 1U);
  EXPECT_EQ(trial->gaps[0].segment, HumanBone::kRightHand);
  EXPECT_EQ(trial->gaps[0].last_frame, 44);
}

TEST(SolveMotion, BridgesAForearmHiddenForHalfASecond) {
  Scene scene(0.2);
  scene.hide({HumanBone::kLeftLowerArm, HumanBone::kLeftHand}, 12, 26);
  const auto trial = scene.solve();
  ASSERT_TRUE(trial) << trial.error().message();
  const auto off = error_m(scene, *trial, HumanBone::kLeftHand);
  for (std::size_t f = 12; f < 27; ++f) {
    // An arm that swings at 1 m/s continues its movement from before to after the gap:
    // off by a fraction of the 0.3 m of its travel.
    EXPECT_LT(off[f], 0.1);
    const double sigma_m =
        trial->estimate.uncertainty[f][index(HumanBone::kLeftHand)].sigma_m;
    EXPECT_LT(off[f], 3.0 * std::sqrt(3.0) * sigma_m) << "frame " << f;
  }
  // It is accurate again as soon as it is seen.
  EXPECT_LT(off[28], 3e-3);
}

TEST(SolveMotion, HasLargerSigmasForUnseenSegments) {
  Scene scene(0.2);
  scene.hide({HumanBone::kLeftLowerArm, HumanBone::kLeftHand}, 12, 26);
  const auto trial = scene.solve();
  ASSERT_TRUE(trial) << trial.error().message();
  const auto sigma_m = [&](std::size_t frame) {
    return trial->estimate.uncertainty[frame][index(HumanBone::kLeftHand)].sigma_m;
  };
  EXPECT_GT(sigma_m(19), 5.0 * sigma_m(5));
  EXPECT_GT(sigma_m(19), sigma_m(13));
}

TEST(SolveMotion, GivesTheSameBytesTwice) {
  Scene scene(0.2);
  scene.film.frames = 20;
  const auto once = scene.solve();
  const auto again = scene.solve();
  ASSERT_TRUE(once && again);
  for (std::size_t f = 0; f < once->estimate.motion.poses.size(); ++f) {
    EXPECT_EQ(once->estimate.motion.poses[f].root_in_world,
              again->estimate.motion.poses[f].root_in_world);
    EXPECT_EQ(once->estimate.motion.poses[f].parent_from_joint,
              again->estimate.motion.poses[f].parent_from_joint);
    for (std::size_t j = 0; j < kHumanBoneCount; ++j) {
      EXPECT_EQ(once->estimate.uncertainty[f][j].sigma_m,
                again->estimate.uncertainty[f][j].sigma_m);
    }
  }
}

TEST(SolveMotion, HardlyDependsOnItsWindows) {
  Scene scene(0.2);
  const auto whole = scene.solve();
  scene.options.window_frames = 20;
  scene.options.overlap_frames = 8;
  const auto pieces = scene.solve();
  ASSERT_TRUE(whole && pieces);
  double max_m = 0.0;
  for (const HumanBone bone : marey::testing::limb_joints()) {
    const auto a = error_m(scene, *whole, bone);
    const auto b = error_m(scene, *pieces, bone);
    for (std::size_t f = 0; f < a.size(); ++f)
      max_m = std::max(max_m, std::abs(a[f] - b[f]));
  }
  // After eight frames a measurement has no effect.
  EXPECT_LT(max_m, 5e-4);
}

TEST(SolveMotion, DoesWithoutACameraThatHasNoVideo) {
  Scene scene;
  scene.film.frames = 20;
  auto detections = scene.detections();
  detections[1].frames.clear();
  const auto trial = solve_motion(scene.truth, scene.cameras, detections, scene.options);
  ASSERT_TRUE(trial) << trial.error().message();
  EXPECT_EQ(trial->cameras[1].corners, 0);
  EXPECT_LT(nearest_quantile(limbs_off_m(scene, *trial), 0.5), 1e-3);
}

TEST(SolveMotion, CountsTheSightings) {
  Scene scene;
  scene.film.frames = 10;
  const auto detections = scene.detections();
  const auto trial = solve_motion(scene.truth, scene.cameras, detections, scene.options);
  ASSERT_TRUE(trial) << trial.error().message();
  int tags = 0;
  for (const CameraDetections& camera : detections) {
    tags += static_cast<int>(camera.frames[4].tags.size());
  }
  EXPECT_EQ(trial->tags_seen[4], tags);
  EXPECT_EQ(trial->estimate.motion.rate.hz, 30.0);
  EXPECT_EQ(trial->estimate.uncertainty.size(), 10U);
  EXPECT_EQ(trial->frame_rms_px.size(), 10U);
}

TEST(SolveMotion, ReportsATrialWithoutBodyTags) {
  Scene scene;
  scene.film.hidden = [](const TagOnSegment&, int) { return true; };
  const auto trial = scene.solve();
  ASSERT_FALSE(trial);
  EXPECT_EQ(trial.error().code, Errc::kBadInput);
  EXPECT_EQ(trial.error().where, "walk/cam0.mp4");
  EXPECT_EQ(trial.error().cause, "no tag of the body is seen in any frame");
}

TEST(SolveMotion, ReportsATrialThatNeverShowsTheHips) {
  Scene scene;
  scene.film.frames = 10;
  scene.hide({HumanBone::kHips}, 0, 1000);
  const auto trial = scene.solve();
  ASSERT_FALSE(trial);
  EXPECT_EQ(trial.error().cause, "the body is not found: its hips are never seen");
}

}  // namespace
}  // namespace marey::reconstruct
