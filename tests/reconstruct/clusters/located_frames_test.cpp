// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/located_frames.h"

#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/camera.h"
#include "core/detection.h"

namespace marey::reconstruct {
namespace {

constexpr double kTagSize_m = 0.08;

/// Two neighbouring cameras that look along +Z at tags of one shin, three metres away.
struct Shin {
  std::vector<Camera> cameras;
  std::vector<TagOnSegment> tags{{TagId{1}, HumanBone::kLeftLowerLeg, kTagSize_m},
                                 {TagId{2}, HumanBone::kLeftLowerLeg, kTagSize_m}};

  Shin() {
    for (int c = 0; c < 2; ++c) {
      Camera camera;
      camera.intrinsics.width_px = 1280;
      camera.intrinsics.height_px = 720;
      camera.intrinsics.focal_px = {900.0, 900.0};
      camera.intrinsics.centre_px = {639.5, 359.5};
      camera.camera_from_world.translation = glm::dvec3(-0.3 * c, 0.0, 0.0);
      cameras.push_back(camera);
    }
  }

  /// Returns the number of frames that locate the shin. In the only frame these cameras
  /// see these tags, turned about the vertical by `tilt_rad` from facing the first
  /// camera.
  [[nodiscard]] int located(const std::vector<std::pair<std::size_t, std::size_t>>& seen,
                            double tilt_rad) const {
    std::vector<CameraDetections> detections(2);
    for (std::size_t c = 0; c < 2; ++c) {
      detections[c].camera = CameraId{static_cast<int>(c)};
      detections[c].rate = FrameRate{30.0};
      detections[c].frames.resize(1);
    }
    for (const auto& [tag, camera] : seen) {
      // Facing the camera: Z of the tag towards it.
      const RigidTransform world_from_tag{
          glm::angleAxis(tilt_rad, glm::dvec3(0, 1, 0)) *
              glm::angleAxis(3.14159265358979, glm::dvec3(1, 0, 0)),
          glm::dvec3(0.1 * static_cast<double>(tag), 0.0, 3.0)};
      TagDetection detection;
      detection.id = tags[tag].id;
      for (int k = 0; k < 4; ++k) {
        detection.corners_px[static_cast<std::size_t>(k)] =
            *project(cameras[camera], world_from_tag * corner_in_tag(k, kTagSize_m));
      }
      detections[camera].frames[0].tags.push_back(detection);
    }
    return located_frames(group_sightings(detections, tags),
                          tags,
                          cameras)[index(HumanBone::kLeftLowerLeg)];
  }
};

TEST(LocatedFrames, CountWhatTwoSightingsLocate) {
  const Shin shin;
  EXPECT_EQ(shin.located({{0, 0}, {0, 1}}, 0.0), 1) << "two cameras";
  EXPECT_EQ(shin.located({{0, 0}, {1, 0}}, 0.0), 1) << "two tags";
  EXPECT_EQ(shin.located({}, 0.0), 0);
}

TEST(LocatedFrames, CountALoneTagOnlyWhereItsTiltShows) {
  const Shin shin;
  EXPECT_EQ(shin.located({{0, 0}}, 0.0), 0) << "face on";
  // 24 px wide: its far side is 0.5 px shorter at one radian, half of the requirement
  // for 0.3 px.
  EXPECT_EQ(shin.located({{0, 0}}, 1.0), 0);
  Shin near = shin;
  for (Camera& camera : near.cameras) camera.intrinsics.focal_px *= 3.0;
  EXPECT_EQ(near.located({{0, 0}}, 1.0), 1) << "the same three times as large";
  EXPECT_EQ(near.located({{0, 0}}, 0.1), 0);
}

}  // namespace
}  // namespace marey::reconstruct
