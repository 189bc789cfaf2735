// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/detect_contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

#include "core/assert.h"
#include "core/pose.h"

namespace marey::retarget {
namespace {

// One foot joint over the motion.
struct Path {
  std::vector<glm::dvec3> p_in_world;
  std::vector<double> speed_m_per_s;
  double rest_height_m = 0.0;
};

// Slope of the line fitted to the positions around each frame: noise is averaged away
// that a difference of two frames would keep.
std::vector<double> speeds(std::span<const glm::dvec3> p_in_world,
                           double hz,
                           double smoothing_s) {
  const int count = static_cast<int>(p_in_world.size());
  const int half = std::max(1, static_cast<int>(std::lround(0.5 * smoothing_s * hz)));
  std::vector<double> out;
  for (int t = 0; t < count; ++t) {
    const int first = std::max(0, t - half);
    const int last = std::min(count - 1, t + half);
    const double middle = 0.5 * (first + last);
    glm::dvec3 slope(0.0);
    double weight = 0.0;
    for (int k = first; k <= last; ++k) {
      slope += (k - middle) * p_in_world[static_cast<std::size_t>(k)];
      weight += (k - middle) * (k - middle);
    }
    out.push_back(weight > 0.0 ? glm::length(slope) * hz / weight : 0.0);
  }
  return out;
}

// The lower decile of the heights while slow; of all heights when it never is.
double resting_height_m(const Path& path, double slow_m_per_s) {
  std::vector<double> heights;
  for (std::size_t t = 0; t < path.p_in_world.size(); ++t) {
    if (path.speed_m_per_s[t] < slow_m_per_s) heights.push_back(path.p_in_world[t].y);
  }
  if (heights.empty()) {
    for (const glm::dvec3& p : path.p_in_world) heights.push_back(p.y);
  }
  const auto decile = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 10);
  std::nth_element(heights.begin(), decile, heights.end());
  return *decile;
}

std::vector<FrameInterval> runs(const std::vector<char>& on) {
  std::vector<FrameInterval> out;
  for (int t = 0; t < static_cast<int>(on.size()); ++t) {
    if (!on[static_cast<std::size_t>(t)]) continue;
    if (!out.empty() && out.back().last == t - 1) {
      out.back().last = t;
    } else {
      out.push_back({t, t});
    }
  }
  return out;
}

// Frames that keep a contact, in runs that hold at least one that starts it.
std::vector<FrameInterval> resting_runs(const Path& path,
                                        const BodyMap& map,
                                        double hz,
                                        const DetectContactsOptions& o) {
  std::vector<char> start(path.p_in_world.size(), 0);
  std::vector<char> keep(path.p_in_world.size(), 0);
  for (std::size_t t = 0; t < keep.size(); ++t) {
    const double speed = path.speed_m_per_s[t] / map.leg_length_m;
    const double height = (path.p_in_world[t].y - path.rest_height_m) / map.leg_length_m;
    const bool keeps = speed < o.keep_speed_legs_per_s && height < o.keep_height_legs;
    const bool starts =
        keeps && speed < o.start_speed_legs_per_s && height < o.start_height_legs;
    keep[t] = keeps ? 1 : 0;
    start[t] = starts ? 1 : 0;
  }
  std::vector<FrameInterval> merged;
  for (const FrameInterval& run : runs(keep)) {
    if (std::find(start.begin() + run.first, start.begin() + run.last + 1, 1) ==
        start.begin() + run.last + 1) {
      continue;
    }
    if (!merged.empty() && run.first - merged.back().last - 1 <= o.longest_gap_s * hz) {
      merged.back().last = run.last;
    } else {
      merged.push_back(run);
    }
  }
  std::erase_if(merged, [&](const FrameInterval& run) {
    return run.last - run.first + 1 < o.shortest_s * hz;
  });
  return merged;
}

std::vector<FrameInterval> either(const FootContacts& foot, int frame_count) {
  std::vector<char> on(static_cast<std::size_t>(frame_count), 0);
  for (const auto* part : {&foot.heel, &foot.ball}) {
    for (const FrameInterval& run : *part) {
      std::fill(on.begin() + run.first, on.begin() + run.last + 1, char{1});
    }
  }
  return runs(on);
}

// Both sides stand on one floor: a foot that never comes down must not call the height
// at which it hangs its resting height.
void share_floor(Path& left, Path& right, double tolerance_m) {
  const double lowest = std::min(left.rest_height_m, right.rest_height_m);
  for (Path* path : {&left, &right}) {
    if (path->rest_height_m > lowest + tolerance_m) path->rest_height_m = lowest;
  }
}

}  // namespace

Contacts detect_contacts(const Motion& motion,
                         const BodyMap& map,
                         const DetectContactsOptions& options) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  MAREY_ASSERT(map.joints.size() == motion.skeleton.joints.size());
  using B = HumanBone;
  constexpr std::array<B, 4> kBones{
      B::kLeftFoot, B::kRightFoot, B::kLeftToes, B::kRightToes};
  Contacts out;
  out.frame_count = static_cast<int>(motion.poses.size());
  if (motion.poses.empty()) return out;

  std::array<std::optional<Path>, 4> paths;
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world_from_joint);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const auto joint = map.joint_of[index(kBones[i])];
      if (!joint) continue;
      if (!paths[i]) paths[i].emplace();
      paths[i]->p_in_world.push_back(world_from_joint[index(*joint)].translation);
    }
  }
  for (auto& path : paths) {
    if (!path) continue;
    path->speed_m_per_s = speeds(path->p_in_world, motion.rate.hz, options.smoothing_s);
    path->rest_height_m =
        resting_height_m(*path, options.start_speed_legs_per_s * map.leg_length_m);
  }
  // Generous: the two feet of a captured body rest a few centimetres apart.
  constexpr double kSameFloorInLegs = 0.06;
  const double tolerance_m = kSameFloorInLegs * map.leg_length_m;
  share_floor(*paths[0], *paths[1], tolerance_m);
  if (paths[2] && paths[3]) share_floor(*paths[2], *paths[3], tolerance_m);

  for (std::size_t side = 0; side < 2; ++side) {
    FootContacts& foot = out.feet[side];
    foot.heel = resting_runs(*paths[side], map, motion.rate.hz, options);
    foot.ankle_height_m = paths[side]->rest_height_m;
    foot.ball = foot.heel;
    foot.ball_height_m = foot.ankle_height_m;
    if (const auto& toes = paths[side + 2]) {
      foot.ball = resting_runs(*toes, map, motion.rate.hz, options);
      foot.ball_height_m = toes->rest_height_m;
    }
    foot.stance = either(foot, out.frame_count);
  }
  return out;
}

}  // namespace marey::retarget
