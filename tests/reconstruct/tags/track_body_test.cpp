// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/track_body.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/reconstruct/tags/nearest_quantile.h"
#include "tests/support/bodies/synthetic_person.h"
#include "tests/support/program/count_allocations.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Film;
using marey::testing::ring_of_cameras;
using marey::testing::tagged_person;

/// A film of a body that is tracked frame by frame.
class BodyScene {
 public:
  Body body = tagged_person();
  std::vector<Camera> cameras = ring_of_cameras();
  marey::testing::Movement movement = marey::testing::walking(body);
  Film film{60, 30.0, "walk", {}, {}, {}};
  TrackBodyOptions options;
  /// Changes the cameras' detections before tracking. May be empty.
  std::function<void(std::vector<CameraDetections>&)> tamper;
  /// Frames that are not passed to the tracker. May be empty.
  std::function<bool(int frame)> dropped;

  struct Frame {
    int number = 0;
    bool found = false;
    Pose pose;
    std::vector<JointUncertainty> uncertainty;
    TrackReport report;
    long allocations = 0;  ///< Allocations of the step.
  };

  [[nodiscard]] std::vector<Frame> follow() {
    auto detections = marey::testing::film(body, movement, cameras, film);
    if (tamper) tamper(detections);
    auto tracker = BodyTracker::create(body, cameras, FrameRate{film.hz}, options);
    EXPECT_TRUE(tracker);
    std::vector<Frame> frames;
    std::vector<CameraView> views(cameras.size());
    Frame now;
    int last = -1;
    for (int f = 0; f < film.frames; ++f) {
      if (dropped && dropped(f)) continue;
      for (std::size_t c = 0; c < views.size(); ++c) {
        views[c].tags = detections[c].frames[static_cast<std::size_t>(f)].tags;
        views[c].late_s = 0.0;
      }
      const long before = marey::testing::allocations();
      now.found = tracker->step(views, (f - last) / film.hz, now.pose, now.uncertainty);
      now.allocations = marey::testing::allocations() - before;
      now.number = last = f;
      now.report = tracker->last();
      frames.push_back(now);
    }
    lags_s.assign(tracker->lags_s().begin(), tracker->lags_s().end());
    return frames;
  }
  std::vector<double> lags_s;  ///< After follow().

  /// Returns the distances of the limbs' joints from the truth. [m]
  [[nodiscard]] std::vector<double> off_m(const Frame& frame) const {
    const Skeleton skeleton = make_humanoid(body.proportions);
    const auto found = world_from_joints(skeleton, frame.pose);
    const auto right = world_from_joints(skeleton, movement(frame.number / film.hz));
    std::vector<double> off;
    for (const HumanBone bone : marey::testing::limb_joints()) {
      off.push_back(
          glm::distance(found[index(bone)].translation, right[index(bone)].translation));
    }
    return off;
  }
  [[nodiscard]] double worst_m(const Frame& frame) const {
    const auto off = off_m(frame);
    return *std::max_element(off.begin(), off.end());
  }
  void hide_all(int first, int last) {
    film.hidden = [=](const TagOnSegment&, int frame) {
      return frame >= first && frame <= last;
    };
  }
};

bool is_finite(const BodyScene::Frame& frame) {
  const auto& root = frame.pose.root_in_world;
  bool all = std::isfinite(root.x + root.y + root.z);
  for (const glm::dquat& q : frame.pose.parent_from_joint) {
    all = all && std::isfinite(q.w + q.x + q.y + q.z);
  }
  for (const JointUncertainty& uncertainty : frame.uncertainty) {
    all = all && std::isfinite(uncertainty.sigma_m) && uncertainty.sigma_m >= 0.0;
  }
  return all;
}

TEST(TrackBody, RecoversAWalkFromExactCorners) {
  BodyScene scene;
  std::vector<double> off;
  for (const auto& frame : scene.follow()) {
    ASSERT_TRUE(frame.found) << frame.number;
    EXPECT_EQ(frame.report.state, TrackState::kTracked);
    EXPECT_EQ(frame.report.tags_rejected, 0);
    const auto here = scene.off_m(frame);
    off.insert(off.end(), here.begin(), here.end());
  }
  // The motion model and the pose priors have a thousandth of the tags' weight; more if
  // no tag of a foot or hand is seen.
  EXPECT_LT(nearest_quantile(off, 0.5), 3e-4);
  EXPECT_LT(nearest_quantile(off, 0.95), 3e-3);
}

TEST(TrackBody, StaysWithinMillimetresUnderNoise) {
  BodyScene scene;
  scene.film.disturbance.noise_px = 0.2;
  std::vector<double> off;
  double squares_px2 = 0.0;
  int frames = 0;
  for (const auto& frame : scene.follow()) {
    const auto here = scene.off_m(frame);
    off.insert(off.end(), here.begin(), here.end());
    squares_px2 += frame.report.rms_px * frame.report.rms_px;
    ++frames;
  }
  // A corner is 0.8 mm off in space; a few tags determine each joint.
  EXPECT_LT(nearest_quantile(off, 0.5), 2e-3);
  EXPECT_LT(nearest_quantile(off, 0.95), 6e-3);
  // Noise of two coordinates, of which the pose absorbs some.
  EXPECT_NEAR(std::sqrt(squares_px2 / frames), 0.24, 0.05);
}

TEST(TrackBody, FollowsCamerasThatAreLate) {
  BodyScene scene;
  scene.film.disturbance.noise_px = 0.2;
  scene.film.frames = 90;
  scene.movement = marey::testing::range_of_motion(scene.body);
  scene.film.offsets_s = {0.0, 0.0073, -0.0111, 0.0049};
  const auto frames = scene.follow();
  for (std::size_t c = 0; c < scene.lags_s.size(); ++c) {
    EXPECT_NEAR(scene.lags_s[c], scene.film.offsets_s[c], 1.5e-3) << c;
  }
  EXPECT_LT(scene.worst_m(frames.back()), 0.015);
}

TEST(TrackBody, UsesGivenLags) {
  BodyScene scene;
  scene.options.lag_known = {true, true, true, true};
  scene.film.offsets_s = {0.0, 0.010, 0.0, 0.0};
  (void)scene.follow();
  for (const double lag_s : scene.lags_s) EXPECT_EQ(lag_s, 0.0);
}

TEST(TrackBody, BridgesALimbUnseenAndThenGuesses) {
  BodyScene scene;
  // Later the walk leaves the cameras' pictures.
  scene.film.frames = 100;
  scene.film.hidden = [](const TagOnSegment& tag, int frame) {
    return frame >= 20 && frame < 80 && tag.segment == HumanBone::kLeftLowerArm;
  };
  double sigma_before_m = 0.0;
  for (const auto& frame : scene.follow()) {
    const JointUncertainty& uncertainty =
        frame.uncertainty[index(HumanBone::kLeftLowerArm)];
    Source expected = Source::kMeasured;
    if (frame.number >= 20 && frame.number < 80) {
      expected = frame.number < 49 ? Source::kRepaired : Source::kInferred;
    }
    if (frame.number != 49 && frame.number != 50) {
      EXPECT_EQ(uncertainty.source, expected) << frame.number;
    }
    const double wrist_m = frame.uncertainty[index(HumanBone::kLeftHand)].sigma_m;
    if (frame.number == 19) sigma_before_m = wrist_m;
    if (frame.number == 79) {
      EXPECT_GT(wrist_m, 2.0 * sigma_before_m);
    }
    EXPECT_EQ(frame.report.state, TrackState::kTracked);
    // Only the tags of the hand and the upper arm remain.
    EXPECT_LT(scene.worst_m(frame), 0.15) << frame.number;
    if (frame.number > 85) {
      EXPECT_LT(scene.worst_m(frame), 0.01) << frame.number;
    }
  }
}

TEST(TrackBody, ReportsALostBodyAndRelocalizesIt) {
  BodyScene scene;
  scene.movement = marey::testing::range_of_motion(scene.body);
  scene.film.frames = 160;
  scene.hide_all(30, 119);
  for (const auto& frame : scene.follow()) {
    EXPECT_TRUE(frame.found && is_finite(frame)) << frame.number;
    const bool lost = frame.number > 61 && frame.number < 120;
    if (frame.number < 59 || lost) {
      EXPECT_EQ(frame.report.state, lost ? TrackState::kLost : TrackState::kTracked)
          << frame.number;
    }
    if (lost) {
      EXPECT_EQ(frame.uncertainty[0].source, Source::kInferred);
      EXPECT_EQ(frame.report.tags_used, 0);
    }
    if (frame.number >= 126) {
      EXPECT_EQ(frame.report.state, TrackState::kTracked) << frame.number;
      EXPECT_LT(scene.worst_m(frame), 0.03) << frame.number;
    }
  }
}

TEST(TrackBody, FindsABodyThatComesBackElsewhere) {
  BodyScene scene;
  const auto before = marey::testing::standing(scene.body);
  const RigidTransform moved{rotation_from_vector({0.0, 2.5, 0.0}), {0.5, 0.0, 0.4}};
  scene.movement = [=](double time_s) {
    Pose pose = before(time_s);
    if (time_s < 1.5) return pose;
    pose.root_in_world = moved * pose.root_in_world;
    pose.parent_from_joint[0] = moved.rotation * pose.parent_from_joint[0];
    return pose;
  };
  scene.film.frames = 120;
  scene.hide_all(30, 80);
  const auto frames = scene.follow();
  EXPECT_LT(scene.worst_m(frames[29]), 0.005);
  EXPECT_EQ(frames[80].report.state, TrackState::kLost);
  EXPECT_EQ(frames[110].report.state, TrackState::kTracked);
  EXPECT_LT(scene.worst_m(frames[110]), 0.01);
}

TEST(TrackBody, WaitsForABodyThatIsNotThere) {
  BodyScene scene;
  scene.hide_all(0, 19);
  for (const auto& frame : scene.follow()) {
    EXPECT_EQ(frame.found, frame.number >= 20) << frame.number;
    EXPECT_EQ(frame.report.state,
              frame.found ? TrackState::kTracked : TrackState::kWaiting);
  }
}

TEST(TrackBody, IgnoresTagsOfOthers) {
  BodyScene alone;
  alone.film.disturbance.noise_px = 0.2;
  BodyScene crowded = alone;
  crowded.tamper = [](std::vector<CameraDetections>& cameras) {
    for (CameraDetections& camera : cameras) {
      for (FrameDetections& frame : camera.frames) {
        TagDetection stranger;
        stranger.id = TagId{400};
        stranger.corners_px = {{{10, 30}, {30, 30}, {30, 10}, {10, 10}}};
        frame.tags.push_back(stranger);
      }
    }
  };
  const auto a = alone.follow();
  const auto b = crowded.follow();
  for (std::size_t f = 0; f < a.size(); ++f) {
    EXPECT_EQ(a[f].pose.root_in_world, b[f].pose.root_in_world);
    EXPECT_EQ(a[f].pose.parent_from_joint, b[f].pose.parent_from_joint);
  }
}

TEST(TrackBody, RejectsAnothersTagOfTheSameId) {
  BodyScene scene;
  scene.film.disturbance.noise_px = 0.2;
  // One of a camera's tags is far from its place in every frame.
  scene.tamper = [](std::vector<CameraDetections>& cameras) {
    for (FrameDetections& frame : cameras[1].frames) {
      ASSERT_FALSE(frame.tags.empty());
      for (glm::dvec2& corner : frame.tags.front().corners_px) {
        corner += glm::dvec2(150.0, -40.0);
      }
    }
  };
  int rejected = 0;
  for (const auto& frame : scene.follow()) {
    rejected += frame.report.tags_rejected;
    EXPECT_LT(scene.worst_m(frame), 0.03) << frame.number;
  }
  EXPECT_EQ(rejected, scene.film.frames);
}

TEST(TrackBody, KeepsItsAccuracyWhenFramesAreDropped) {
  BodyScene scene;
  scene.dropped = [](int frame) { return frame % 3 == 1 || (frame > 30 && frame < 36); };
  std::vector<double> off;
  for (const auto& frame : scene.follow()) {
    const auto here = scene.off_m(frame);
    off.insert(off.end(), here.begin(), here.end());
  }
  EXPECT_LT(nearest_quantile(off, 0.5), 5e-4);
  EXPECT_LT(nearest_quantile(off, 0.95), 5e-3);
}

TEST(TrackBody, GivesTheSameBytesTwice) {
  BodyScene scene;
  scene.film.disturbance = {0.3, {}, 0.03};
  const auto a = scene.follow();
  const auto b = scene.follow();
  for (std::size_t f = 0; f < a.size(); ++f) {
    EXPECT_EQ(a[f].pose.root_in_world, b[f].pose.root_in_world);
    EXPECT_EQ(a[f].pose.parent_from_joint, b[f].pose.parent_from_joint);
    EXPECT_EQ(a[f].report.rms_px, b[f].report.rms_px);
  }
}

TEST(TrackBody, DoesNotAllocateAfterItsFirstFrame) {
  BodyScene scene;
  scene.film.disturbance = {0.3, {}, 0.05};
  scene.film.frames = 120;
  // Lost and relocalized in between.
  scene.hide_all(30, 80);
  const auto frames = scene.follow();
  ASSERT_TRUE(frames.front().found);
  for (std::size_t f = 1; f < frames.size(); ++f)
    EXPECT_EQ(frames[f].allocations, 0) << f;
}

TEST(TrackBody, IgnoresCornersThatAreNotFinite) {
  BodyScene scene;
  scene.tamper = [](std::vector<CameraDetections>& cameras) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double huge = std::numeric_limits<double>::max();
    for (FrameDetections& frame : cameras[0].frames) {
      for (std::size_t i = 0; i < frame.tags.size(); ++i) {
        if (i % 3 == 0) frame.tags[i].corners_px[2].y = nan;
        if (i % 3 == 1) frame.tags[i].corners_px[1].x = -huge;
        if (i % 3 == 2) frame.tags[i].sigma_px = frame.frame % 2 == 0 ? 0.0 : nan;
      }
    }
    // All corners in one place.
    for (TagDetection& tag : cameras[1].frames[20].tags) tag.corners_px.fill({640, 360});
  };
  for (const auto& frame : scene.follow()) {
    EXPECT_TRUE(frame.found && is_finite(frame)) << frame.number;
    EXPECT_LT(scene.worst_m(frame), 0.05) << frame.number;
  }
}

TEST(TrackBody, DeclinesABodyWithoutTags) {
  Body bare = tagged_person();
  bare.tags.clear();
  const auto tracker = BodyTracker::create(bare, ring_of_cameras(), FrameRate{30.0});
  ASSERT_FALSE(tracker);
  EXPECT_EQ(tracker.error().code, Errc::kBadInput);
  EXPECT_FALSE(BodyTracker::create(tagged_person(), {}, FrameRate{30.0}));
}

}  // namespace
}  // namespace marey::reconstruct
