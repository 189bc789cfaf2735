// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/resolve_planar_ambiguities.h"

#include <algorithm>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "reconstruct/tags/solve_motion.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::reconstruct {
namespace {

constexpr int kFirstLone = 15;
constexpr int kLastLone = 29;
constexpr double kLoneNoise_px = 1.2;

/// A walk in which, for half a second, one camera sees one tag of the right arm.
struct LoneArm {
  Body truth = marey::testing::tagged_person();
  std::vector<Camera> cameras = marey::testing::ring_of_cameras();
  marey::testing::Movement movement = marey::testing::walking(truth);
  std::vector<CameraDetections> detections;

  LoneArm(HumanBone bone, std::size_t camera, unsigned seed) {
    marey::testing::Film film{45, 30.0, "walk", {}, {}, {}};
    film.disturbance.noise_px = 0.2;
    detections = marey::testing::film(truth, movement, cameras, film);
    const HumanLimb& arm = human_limbs()[1];
    std::optional<TagId> kept;
    for (const PlacedTag& placed : truth.tags) {
      if (placed.tag.segment == bone && !kept) kept = placed.tag.id;
    }
    std::mt19937 random(seed);
    std::normal_distribution<double> noise_px(0.0, kLoneNoise_px);
    for (std::size_t c = 0; c < detections.size(); ++c) {
      for (FrameDetections& frame : detections[c].frames) {
        if (frame.frame < kFirstLone || frame.frame > kLastLone) continue;
        std::erase_if(frame.tags, [&](const TagDetection& tag) {
          const auto placed =
              std::find_if(truth.tags.begin(), truth.tags.end(), [&](const PlacedTag& p) {
                return p.tag.id == tag.id;
              });
          const HumanBone segment = placed->tag.segment;
          const bool is_of_arm =
              segment == arm.upper || segment == arm.lower || segment == arm.end;
          return is_of_arm && (c != camera || tag.id != kept);
        });
        // Far away or out of focus: the difference between two poses is lost first.
        for (TagDetection& tag : frame.tags) {
          if (tag.id != kept) continue;
          tag.sigma_px = kLoneNoise_px;
          for (glm::dvec2& p : tag.corners_px) {
            p.x += noise_px(random);
            p.y += noise_px(random);
          }
        }
      }
    }
  }

  [[nodiscard]] std::vector<SingleViewInterval> stretches(
      std::size_t maximum = 60) const {
    const BodyModel model = to_model(truth);
    std::vector<SingleViewInterval> arm;
    for (const SingleViewInterval& run :
         single_view_intervals(model, group_sightings(detections, model.tags), maximum)) {
      if (run.limb == 1) arm.push_back(run);
    }
    return arm;
  }
};

TEST(ResolvePlanarAmbiguities, FindsStretchesWhereOneCameraSeesOneTagOfALimb) {
  const LoneArm scene(HumanBone::kRightLowerArm, 0, 1);
  const std::vector<SingleViewInterval> found = scene.stretches();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LE(found[0].first, static_cast<std::size_t>(kFirstLone));
  EXPECT_GE(found[0].first + found[0].count, static_cast<std::size_t>(kLastLone + 1));
}

TEST(ResolvePlanarAmbiguities, DividesLongStretchesIntoPieces) {
  const LoneArm scene(HumanBone::kRightLowerArm, 0, 1);
  const std::vector<SingleViewInterval> whole = scene.stretches();
  ASSERT_EQ(whole.size(), 1u);
  std::size_t frames = 0;
  for (const SingleViewInterval& run : scene.stretches(4)) {
    EXPECT_LE(run.count, 4u);
    frames += run.count;
  }
  EXPECT_LE(frames, whole[0].count);
  EXPECT_GT(frames, whole[0].count / 2);
}

// The tag determines the elbow poorly: its error is within its sigma.
TEST(ResolvePlanarAmbiguities, GiveASingleViewArmACorrectSigma) {
  int frames = 0;
  int far = 0;
  int scenes = 0;
  for (const HumanBone bone : {HumanBone::kRightUpperArm, HumanBone::kRightLowerArm}) {
    for (std::size_t camera = 0; camera < 4; ++camera) {
      for (unsigned seed = 1; seed <= 4; ++seed) {
        const LoneArm scene(bone, camera, seed);
        if (scene.stretches().empty()) continue;
        const auto trial = solve_motion(scene.truth, scene.cameras, scene.detections, {});
        ASSERT_TRUE(trial) << trial.error().message();
        ++scenes;
        const Skeleton truth = make_humanoid(scene.truth.proportions);
        const std::size_t elbow = index(HumanBone::kRightLowerArm);
        for (int f = kFirstLone; f <= kLastLone; ++f) {
          const auto at = static_cast<std::size_t>(f);
          const Motion& motion = trial->estimate.motion;
          const double off_m = glm::distance(
              world_from_joints(motion.skeleton, motion.poses[at])[elbow].translation,
              world_from_joints(truth, scene.movement(f / 30.0))[elbow].translation);
          ++frames;
          // 95 % of three independent coordinates lie within 2.8 sigma.
          far += off_m > 2.8 * trial->estimate.uncertainty[at][elbow].sigma_m;
        }
      }
    }
  }
  EXPECT_GE(scenes, 8);
  // Four of 240 are farther without the alternative poses.
  EXPECT_LE(far, frames / 100);
}

}  // namespace
}  // namespace marey::reconstruct
