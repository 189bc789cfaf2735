// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/located_frames.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "reconstruct/clusters/locate_rigid.h"

namespace marey::reconstruct {
namespace {

// The far side of a tilted square looks smaller than the near one. Poses of opposite tilt
// differ by this difference, which must be visible: in sigmas of a corner.
constexpr double kDistinctSigmas = 4.0;

bool has_unique_pose(const Camera& camera, const TagDetection& tag, double size_m) {
  const auto poses = planar_poses(camera, tag, size_m);
  if (!poses) return false;
  const RigidTransform camera_from_tag = camera.camera_from_world * poses->front();
  const double distance_m = glm::length(camera_from_tag.translation);
  if (!(distance_m > 0.0)) return false;
  const glm::dvec3 normal = camera_from_tag.rotation * glm::dvec3(0.0, 0.0, 1.0);
  const double tilt_sine =
      glm::length(glm::cross(normal, camera_from_tag.translation)) / distance_m;
  const double side_px =
      glm::distance(tag.corners_px[0], tag.corners_px[2]) / std::sqrt(2.0);
  return side_px * size_m * tilt_sine / distance_m > kDistinctSigmas * tag.sigma_px;
}

}  // namespace

std::array<int, kHumanBoneCount> located_frames(const Sightings& trial,
                                                std::span<const TagOnSegment> tags,
                                                std::span<const Camera> cameras) {
  std::array<int, kHumanBoneCount> frames{};
  for (const std::vector<TagSighting>& frame : trial.frames) {
    std::array<int, kHumanBoneCount> seen{};
    std::array<const TagSighting*, kHumanBoneCount> last{};
    for (const TagSighting& s : frame) {
      const std::size_t bone = index(solved_segment(tags[s.tag].segment));
      ++seen[bone];
      last[bone] = &s;
    }
    for (std::size_t bone = 0; bone < seen.size(); ++bone) {
      const TagSighting* s = last[bone];
      if (!s) continue;
      frames[bone] +=
          seen[bone] >= 2 ||
          has_unique_pose(cameras[index(s->camera)], *s->detection, tags[s->tag].size_m);
    }
  }
  return frames;
}

}  // namespace marey::reconstruct
