// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Lag of a live tracked body behind the time stamps of its pictures, if no camera is the
// reference, as in `marey live`.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/pose.h"
#include "reconstruct/tags/track_body.h"
#include "tests/support/bodies/synthetic_person.h"
#include "tests/support/program/paths.h"
#include "tests/support/truth/motion_delay.h"
#include "tests/support/truth/truth_motion.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Film;
using marey::testing::Movement;
using marey::testing::TimedPlace;

/// True if a camera's picture is skipped.
using PassedOver = std::function<bool(int frame, int camera)>;

PassedOver none() {
  return [](int, int) { return false; };
}

/// Skips each picture with probability one half.
PassedOver half_at_random(unsigned seed) {
  std::mt19937 dice(seed);
  std::vector<bool> passed;
  for (int i = 0; i < 4000; ++i) passed.push_back(dice() % 2 == 0);
  return [passed](int frame, int camera) {
    return bool{passed[static_cast<std::size_t>(4 * frame + camera)]};
  };
}

/// Skips all pictures of every second instant.
PassedOver every_second_instant() {
  return [](int frame, int) { return frame % 2 == 1; };
}

/// Skips two cameras in one instant, the other two in the next.
PassedOver by_turns() {
  return [](int frame, int camera) { return frame % 2 != camera / 2; };
}

/// Returns a captured walk on another body, in the middle of the cameras; empty without
/// its data.
Movement captured_walk(const Body& body, const std::string& recording) {
  const auto truth =
      marey::testing::truth_motion(marey::testing::shared_data().string() + "/blender/" +
                                   recording + "/walk/truth/segments.csv");
  if (!truth) return {};
  const Skeleton skeleton = make_humanoid(body.proportions);
  glm::dvec3 middle(0.0);
  for (const Pose& pose : truth->poses) {
    middle += pose.root_in_world / static_cast<double>(truth->poses.size());
  }
  middle.y = 0.0;
  std::vector<Pose> poses;
  for (const Pose& pose : truth->poses) {
    const auto segments = world_from_joints(truth->skeleton, pose);
    std::vector<glm::dquat> turned;
    for (const Joint& joint : skeleton.joints) {
      // Segments that the recording lacks move with their parent.
      glm::dquat turn =
          joint.parent ? turned[index(*joint.parent)] : segments[0].rotation;
      for (std::size_t s = 0; s < segments.size(); ++s) {
        if (truth->skeleton.joints[s].bone == joint.bone) turn = segments[s].rotation;
      }
      turned.push_back(turn);
    }
    poses.push_back(pose_from_world(skeleton, pose.root_in_world - middle, turned));
  }
  return [poses](double time_s) {
    const double at =
        std::clamp(30.0 * time_s, 0.0, static_cast<double>(poses.size() - 1));
    const auto before = std::min(static_cast<std::size_t>(at), poses.size() - 2);
    const double share = at - static_cast<double>(before);
    Pose pose = poses[before];
    const Pose& next = poses[before + 1];
    pose.root_in_world += share * (next.root_in_world - pose.root_in_world);
    for (std::size_t j = 0; j < pose.parent_from_joint.size(); ++j) {
      pose.parent_from_joint[j] =
          glm::slerp(pose.parent_from_joint[j], next.parent_from_joint[j], share);
    }
    return pose;
  };
}

class TrackLag : public ::testing::Test {
 protected:
  TrackLag() {
    film_.frames = 120;
    film_.disturbance.noise_px = 0.2;
  }

  /// Tracks the movement, and returns its lag behind the truth after lags have been
  /// estimated for a second. [ms]
  [[nodiscard]] double delay_ms(const Movement& movement, const PassedOver& passed_over) {
    const auto seen = marey::testing::film(body_, movement, cameras_, film_);
    TrackBodyOptions options;
    options.lag_known.assign(cameras_.size(), false);
    auto tracker = BodyTracker::create(body_, cameras_, FrameRate{film_.hz}, options);
    EXPECT_TRUE(tracker);
    const auto& joints = marey::testing::limb_joints();
    const Skeleton skeleton = make_humanoid(body_.proportions);
    std::vector<std::vector<TimedPlace>> found(joints.size());
    std::vector<CameraView> views(cameras_.size());
    Pose pose;
    std::vector<JointUncertainty> uncertainty;
    int last = -1;
    for (int f = 0; f < film_.frames; ++f) {
      bool any = false;
      for (std::size_t c = 0; c < views.size(); ++c) {
        views[c] = {};
        if (passed_over(f, static_cast<int>(c))) continue;
        views[c].tags = seen[c].frames[static_cast<std::size_t>(f)].tags;
        any = true;
      }
      if (!any) continue;
      const bool is_found =
          tracker->step(views, (f - last) / film_.hz, pose, uncertainty);
      last = f;
      if (!is_found || f < film_.hz) continue;
      const auto world = world_from_joints(skeleton, pose);
      for (std::size_t j = 0; j < joints.size(); ++j) {
        found[j].push_back({f / film_.hz, world[index(joints[j])].translation});
      }
    }
    lags_s_.assign(tracker->lags_s().begin(), tracker->lags_s().end());
    return 1e3 * marey::testing::delay_s(found, [&](std::size_t joint, double time_s) {
             return world_from_joints(skeleton, movement(time_s))[index(joints[joint])]
                 .translation;
           });
  }

  Body body_ = marey::testing::tagged_person();
  std::vector<Camera> cameras_ = marey::testing::ring_of_cameras();
  Film film_;
  std::vector<double> lags_s_;  ///< After delay_ms().
};

// The pose reported for a time is the body's at that time.
TEST_F(TrackLag, DoesNotTrailItsStampsThoughHalfOfThePicturesArePassedOver) {
  const Movement movement = marey::testing::range_of_motion(body_);
  for (const auto& passed_over : {none(),
                                  half_at_random(7),
                                  half_at_random(8),
                                  every_second_instant(),
                                  by_turns()}) {
    EXPECT_NEAR(delay_ms(movement, passed_over), 0.0, 2.0);
  }
}

TEST_F(TrackLag, DoesNotTrailItsStampsInAWalkAt60Hz) {
  film_.hz = 60.0;
  const Movement walk = marey::testing::walking(body_);
  for (const auto& passed_over : {none(), half_at_random(9), every_second_instant()}) {
    EXPECT_NEAR(delay_ms(walk, passed_over), 0.0, 2.0);
  }
}

// Stamps are right on average: the pose is that of the mean instant of all cameras.
TEST_F(TrackLag, TakesTheMeanOfCamerasThatDifferForTheTruth) {
  const Movement movement = marey::testing::range_of_motion(body_);
  for (const std::vector<double>& offsets_s : {std::vector{0.0, 0.0073, -0.0111, 0.0049},
                                               std::vector{0.01, -0.012, 0.008, 0.015}}) {
    film_.offsets_s = offsets_s;
    double mean_s = 0.0;
    for (const double one_s : offsets_s) mean_s += one_s / 4.0;
    for (const auto& passed_over : {none(), half_at_random(3), every_second_instant()}) {
      EXPECT_NEAR(delay_ms(movement, passed_over), -1e3 * mean_s, 2.0);
      double sum_s = 0.0;
      for (std::size_t c = 0; c < lags_s_.size(); ++c) {
        EXPECT_NEAR(lags_s_[c], offsets_s[c] - mean_s, 1.5e-3) << c;
        sum_s += lags_s_[c];
      }
      EXPECT_NEAR(sum_s, 0.0, 1e-9);
    }
  }
}

TEST_F(TrackLag, DoesNotTrailItsStampsInACapturedWalk) {
  for (const std::string recording : {"dev", "second"}) {
    const Movement walk = captured_walk(body_, recording);
    if (!walk) GTEST_SKIP() << "the rendered recordings are not next to the repository";
    for (const auto& passed_over :
         {none(), half_at_random(5), every_second_instant(), by_turns()}) {
      EXPECT_NEAR(delay_ms(walk, passed_over), 0.0, 2.0) << recording;
    }
  }
}

}  // namespace
}  // namespace marey::reconstruct
