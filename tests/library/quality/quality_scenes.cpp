// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/library/quality/quality_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::library {

LibraryMotion standing_clip(int frames, double hz, double stature_m) {
  LibraryMotion clip;
  clip.motion.skeleton = make_humanoid(average_proportions(stature_m));
  clip.motion.rate.hz = hz;
  clip.motion.poses.assign(static_cast<std::size_t>(frames),
                           rest_pose(clip.motion.skeleton));
  clip.contacts.assign(static_cast<std::size_t>(frames), FootParts{1, 1, 1, 1});
  return clip;
}

LibraryMotion walking_clip(int frames, double hz) {
  const testing::SyntheticWalk walk = testing::synthetic_walk(frames, hz);
  LibraryMotion clip;
  clip.motion = walk.motion;
  const Skeleton& skeleton = clip.motion.skeleton;
  for (int t = 0; t < frames; ++t) {
    const auto i = static_cast<std::size_t>(t);
    Pose& pose = clip.motion.poses[i];
    const double phase = 2.0 * std::numbers::pi * t / (1.1 * hz);
    for (const double side : {1.0, -1.0}) {
      const auto joint = [&](HumanBone left) {
        return index(*skeleton.find(side > 0.0 ? left : mirrored(left)));
      };
      pose.parent_from_joint[joint(HumanBone::kLeftUpperArm)] =
          glm::angleAxis(0.4 * side * std::sin(phase), glm::dvec3(1.0, 0.0, 0.0)) *
          glm::angleAxis(-1.2 * side, glm::dvec3(0.0, 0.0, 1.0));
      pose.parent_from_joint[joint(HumanBone::kLeftLowerArm)] = glm::angleAxis(
          -side * (0.4 + 0.2 * std::sin(phase)), glm::dvec3(0.0, 1.0, 0.0));
      pose.parent_from_joint[joint(HumanBone::kLeftHand)] =
          glm::angleAxis(0.1 * std::sin(phase + 0.3), glm::dvec3(0.0, 0.0, 1.0));
    }
    FootParts parts{};
    for (std::size_t s = 0; s < 2; ++s) {
      parts[2 * s] = walk.feet[s].heel[i] != 0 ? 1 : 0;
      parts[2 * s + 1] = walk.feet[s].ball[i] != 0 ? 1 : 0;
    }
    clip.contacts.push_back(parts);
  }
  return clip;
}

LibraryMotion jumping_clip(double hz) {
  LibraryMotion clip = standing_clip(static_cast<int>(4.0 * hz), hz);
  const double half_s = 0.2;
  for (std::size_t t = 0; t < clip.contacts.size(); ++t) {
    for (const double top_s : {1.0, 2.5}) {
      const double since_s = static_cast<double>(t) / hz - top_s;
      const double up_m = 0.5 * 9.81 * (half_s * half_s - since_s * since_s);
      if (up_m <= 0.0) continue;
      clip.motion.poses[t].root_in_world.y += up_m;
      clip.contacts[t] = {};
    }
  }
  return clip;
}

QualityResult measured(const LibraryMotion& clip) {
  const auto map = retarget::map_body(clip.motion.skeleton);
  EXPECT_TRUE(map.has_value());
  return measure_quality(clip, *map, {});
}

const ClipFigure& figure(const QualityResult& result, std::string_view name) {
  const auto found = std::find_if(result.figures.begin(),
                                  result.figures.end(),
                                  [&](const auto& one) { return one.name == name; });
  EXPECT_NE(found, result.figures.end()) << name;
  return *found;
}

}  // namespace marey::library
