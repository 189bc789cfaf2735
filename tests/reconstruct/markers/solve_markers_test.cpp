// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/solve_markers.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "tests/reconstruct/markers/moving_body.h"
#include "tests/support/program/count_allocations.h"

namespace marey::reconstruct {
namespace {

using marey::testing::moving_body;
using marey::testing::MovingBody;
using marey::testing::MovingBodyOptions;

/// Returns the distances of the twelve limb joints from the truth, over all frames. [m]
std::vector<double> limb_errors(const Motion& motion, const Motion& truth) {
  std::vector<double> errors;
  for (std::size_t f = 0; f < truth.poses.size(); ++f) {
    const auto found = world_from_joints(motion.skeleton, motion.poses[f]);
    const auto real = world_from_joints(truth.skeleton, truth.poses[f]);
    for (const HumanLimb& limb : human_limbs()) {
      for (const HumanBone bone : {limb.upper, limb.lower, limb.end}) {
        errors.push_back(
            glm::length(found[index(bone)].translation - real[index(bone)].translation));
      }
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(SolveMarkers, RecoversTheMotionOfExactMarkers) {
  const MovingBody moving = moving_body();
  const auto solved = solve_markers(moving.body, moving.tracks);
  ASSERT_TRUE(solved);
  const auto errors = limb_errors(solved->estimate.motion, moving.motion);
  // Effect of pose priors and smoothness, which are independent of the truth, on markers
  // with a sigma of two millimetres.
  EXPECT_LT(rms(errors), 0.0008);
  EXPECT_LT(errors.back(), 0.003);
  EXPECT_LT(solved->rms_m, 0.0005);
  EXPECT_EQ(solved->frames_solved, 400);
}

TEST(SolveMarkers, IsBetterThanItsMarkersUnderNoise) {
  MovingBodyOptions options;
  options.noise_m = 0.004;
  MovingBody moving = moving_body(options);
  for (PlacedMarker& marker : moving.body.markers) marker.stray_m = 0.004;
  const auto solved = solve_markers(moving.body, moving.tracks);
  ASSERT_TRUE(solved);
  // A marker is off by sqrt(3) times 4 mm; its joint, determined by several in time and
  // space, by less than two thirds of that.
  EXPECT_LT(rms(limb_errors(solved->estimate.motion, moving.motion)), 0.0045);
}

TEST(SolveMarkers, DoesNotLagBehindQuickMovement) {
  // Four times the speed: a lag shows as an error along the path.
  MovingBodyOptions options;
  options.rate_hz = 25.0;
  options.noise_m = 0.002;
  MovingBody moving = moving_body(options);
  moving.tracks.rate = FrameRate{100.0};
  const auto solved = solve_markers(moving.body, moving.tracks);
  ASSERT_TRUE(solved);
  double along = 0.0;
  double speed2 = 0.0;
  const Motion& truth = moving.motion;
  for (std::size_t f = 1; f + 1 < truth.poses.size(); ++f) {
    const auto place = [&](const Motion& motion, std::size_t frame) {
      return world_from_joints(motion.skeleton,
                               motion.poses[frame])[index(HumanBone::kLeftHand)]
          .translation;
    };
    const glm::dvec3 velocity = 0.5 * (place(truth, f + 1) - place(truth, f - 1));
    along += glm::dot(place(solved->estimate.motion, f) - place(truth, f), velocity);
    speed2 += glm::dot(velocity, velocity);
  }
  // Lag in frames: a twentieth of one.
  EXPECT_LT(std::abs(along / speed2), 0.05);
}

TEST(SolveMarkers, BridgesAnUnseenLimbAndReportsIt) {
  MovingBody moving = moving_body();
  constexpr std::size_t kFirst = 150;
  constexpr std::size_t kEnd = 180;  // 0.3 s
  for (std::size_t f = kFirst; f < kEnd; ++f) {
    for (std::size_t m = 0; m < moving.tracks.markers(); ++m) {
      const HumanBone bone = moving.body.markers[m].segment;
      if (bone == HumanBone::kLeftLowerLeg || bone == HumanBone::kLeftFoot) {
        moving.tracks.at(f, m).reset();
      }
    }
  }
  const auto solved = solve_markers(moving.body, moving.tracks);
  ASSERT_TRUE(solved);
  const auto& estimate = solved->estimate;
  const std::size_t middle = (kFirst + kEnd) / 2;
  const JointUncertainty& bridged =
      estimate.uncertainty[middle][index(HumanBone::kLeftFoot)];
  EXPECT_EQ(bridged.source, Source::kRepaired);
  EXPECT_EQ(estimate.uncertainty[kFirst - 5][index(HumanBone::kLeftFoot)].source,
            Source::kMeasured);
  const auto found =
      world_from_joints(estimate.motion.skeleton, estimate.motion.poses[middle]);
  const auto real =
      world_from_joints(moving.motion.skeleton, moving.motion.poses[middle]);
  const double error = glm::length(found[index(HumanBone::kLeftFoot)].translation -
                                   real[index(HumanBone::kLeftFoot)].translation);
  // Three coordinates of its stated sigma, three sigmas.
  EXPECT_LT(error, 3.0 * std::sqrt(3.0) * bridged.sigma_m);
  EXPECT_GT(bridged.sigma_m,
            2.0 * estimate.uncertainty[kFirst - 5][index(HumanBone::kLeftFoot)].sigma_m);
}

TEST(SolveMarkers, GivesTheSameWhateverTheTakesLength) {
  // Windows end somewhere in the longer one; smoothing looks ahead past their ends.
  MovingBodyOptions options;
  options.frames = 700;
  const MovingBody moving = moving_body(options);
  MarkerTracks shorter = moving.tracks;
  shorter.samples.resize(500 * shorter.markers());
  const auto all = solve_markers(moving.body, moving.tracks);
  const auto part = solve_markers(moving.body, shorter);
  ASSERT_TRUE(all && part);
  for (const std::size_t f : {0U, 200U, 255U, 256U, 257U, 390U}) {
    const auto a =
        world_from_joints(all->estimate.motion.skeleton, all->estimate.motion.poses[f]);
    const auto b =
        world_from_joints(part->estimate.motion.skeleton, part->estimate.motion.poses[f]);
    for (const HumanBone bone : human_bones()) {
      EXPECT_LT(glm::length(a[index(bone)].translation - b[index(bone)].translation),
                1e-5)
          << f;
    }
  }
}

TEST(SolveMarkers, DeclinesTakesWithoutMarkersEnough) {
  MovingBody moving = moving_body();
  for (auto& sample : moving.tracks.samples) sample.reset();
  EXPECT_FALSE(solve_markers(moving.body, moving.tracks));
}

TEST(SolveMarkers, SolvesASingleFrame) {
  MovingBodyOptions options;
  options.frames = 1;
  const MovingBody moving = moving_body(options);
  const auto solved = solve_markers(moving.body, moving.tracks);
  ASSERT_TRUE(solved);
  EXPECT_LT(rms(limb_errors(solved->estimate.motion, moving.motion)), 0.003);
}

TEST(MarkerTracker, FollowsLiveAndGivesTheSameBytesAgain) {
  MovingBodyOptions options;
  options.noise_m = 0.002;
  options.frames = 200;
  const MovingBody moving = moving_body(options);
  const auto run = [&] {
    MarkerTracker tracker(moving.body, moving.tracks.labels, moving.tracks.rate);
    Motion motion = moving.motion;
    std::vector<JointUncertainty> uncertainty;
    for (std::size_t f = 0; f < moving.tracks.frames(); ++f) {
      const auto frame =
          std::span(moving.tracks.samples)
              .subspan(f * moving.tracks.markers(), moving.tracks.markers());
      EXPECT_TRUE(tracker.step(frame, motion.poses[f], uncertainty));
    }
    return std::pair(motion, uncertainty);
  };
  const auto [first, first_uncertainty] = run();
  const auto [second, second_uncertainty] = run();
  EXPECT_LT(rms(limb_errors(first, moving.motion)), 0.004);
  for (std::size_t f = 0; f < first.poses.size(); ++f) {
    ASSERT_EQ(0,
              std::memcmp(first.poses[f].parent_from_joint.data(),
                          second.poses[f].parent_from_joint.data(),
                          sizeof(glm::dquat) * kHumanBoneCount));
    ASSERT_EQ(first.poses[f].root_in_world, second.poses[f].root_in_world);
  }
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    EXPECT_EQ(first_uncertainty[b].sigma_m, second_uncertainty[b].sigma_m);
  }
}

/// No markers for half a second from frame 100 on, then five metres off and turned.
const glm::dquat kTurned = rotation_from_vector({0.0, 2.5, 0.0});

MovingBody comes_back_elsewhere() {
  MovingBodyOptions options;
  options.frames = 200;
  MovingBody moving = moving_body(options);
  for (std::size_t f = 100; f < 200; ++f) {
    for (std::size_t m = 0; m < moving.tracks.markers(); ++m) {
      auto& sample = moving.tracks.at(f, m);
      if (f < 150) {
        sample.reset();
      } else {
        sample->p_in_world = kTurned * sample->p_in_world + glm::dvec3(5.0, 0.0, 0.0);
      }
    }
  }
  return moving;
}

TEST(SolveMarkers, FindsABodyThatComesBackElsewhereAndKeepsWhatWasBefore) {
  const MovingBody moving = comes_back_elsewhere();
  const auto solved = solve_markers(moving.body, moving.tracks);
  ASSERT_TRUE(solved);
  const auto foot = index(HumanBone::kRightFoot);
  const auto place = [&](const Motion& motion, std::size_t f) {
    return world_from_joints(motion.skeleton, motion.poses[f])[foot].translation;
  };
  for (const std::size_t f : {20U, 90U, 99U}) {
    EXPECT_LT(glm::length(place(solved->estimate.motion, f) - place(moving.motion, f)),
              0.003)
        << f;
  }
  EXPECT_LT(glm::length(place(solved->estimate.motion, 190) -
                        (kTurned * place(moving.motion, 190) + glm::dvec3(5, 0, 0))),
            0.003);
  // In between the place is unknown; the body continues its movement, without a jump.
  for (std::size_t f = 100; f < 150; ++f) {
    const double sigma_m = solved->estimate.uncertainty[f][foot].sigma_m;
    EXPECT_TRUE(std::isfinite(sigma_m));
    EXPECT_GT(sigma_m, 0.001) << f;
    EXPECT_LT(glm::length(place(solved->estimate.motion, f) - place(moving.motion, 99)),
              2.0)
        << f;
  }
}

TEST(MarkerTracker, FindsABodyThatComesBackElsewhere) {
  const MovingBody moving = comes_back_elsewhere();
  MarkerTracker tracker(moving.body, moving.tracks.labels, moving.tracks.rate);
  Pose pose;
  std::vector<JointUncertainty> uncertainty;
  for (std::size_t f = 0; f < 200; ++f) {
    (void)tracker.step(std::span(moving.tracks.samples)
                           .subspan(f * moving.tracks.markers(), moving.tracks.markers()),
                       pose,
                       uncertainty);
  }
  const auto found = world_from_joints(tracker.skeleton(), pose);
  const auto real = world_from_joints(moving.motion.skeleton, moving.motion.poses.back());
  const auto foot = index(HumanBone::kRightFoot);
  EXPECT_LT(glm::length(found[foot].translation -
                        (kTurned * real[foot].translation + glm::dvec3(5.0, 0.0, 0.0))),
            0.003);
}

bool follow(const MovingBody& moving,
            std::size_t f,
            MarkerTracker& tracker,
            Pose& pose,
            std::vector<JointUncertainty>& uncertainty) {
  return tracker.step(std::span(moving.tracks.samples)
                          .subspan(f * moving.tracks.markers(), moving.tracks.markers()),
                      pose,
                      uncertainty);
}

TEST(MarkerTracker, IsNotPoisonedByASampleThatIsNoNumber) {
  MovingBody moving = moving_body();
  moving.tracks.at(50, 3)->p_in_world.x = std::nan("");
  moving.tracks.at(51, 4)->sigma_m = std::numeric_limits<float>::infinity();
  MarkerTracker tracker(moving.body, moving.tracks.labels, moving.tracks.rate);
  Pose pose;
  std::vector<JointUncertainty> uncertainty;
  for (std::size_t f = 0; f < 60; ++f) {
    ASSERT_TRUE(follow(moving, f, tracker, pose, uncertainty));
  }
  const auto found = world_from_joints(tracker.skeleton(), pose);
  const auto real = world_from_joints(moving.motion.skeleton, moving.motion.poses[59]);
  const auto hand = index(HumanBone::kLeftHand);
  EXPECT_LT(glm::length(found[hand].translation - real[hand].translation), 0.003);
}

TEST(MarkerTracker, DoesNotAllocateAfterItsFirstFrame) {
  const MovingBody moving = moving_body();
  MarkerTracker tracker(moving.body, moving.tracks.labels, moving.tracks.rate);
  Pose pose;
  std::vector<JointUncertainty> uncertainty;
  long before = 0;
  for (std::size_t f = 0; f < 100; ++f) {
    if (f == 1) before = marey::testing::allocations();
    ASSERT_TRUE(follow(moving, f, tracker, pose, uncertainty));
  }
  EXPECT_EQ(marey::testing::allocations() - before, 0);
}

}  // namespace
}  // namespace marey::reconstruct
