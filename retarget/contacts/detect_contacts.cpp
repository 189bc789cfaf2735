// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/detect_contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/pose.h"

namespace marey::retarget {
namespace {

// One foot joint over the motion.
struct Path {
  std::vector<glm::dvec3> p_in_world;
  std::vector<double> speed_m_per_s;         // Around each frame.
  std::vector<double> before_speed_m_per_s;  // Up to the frame.
  std::vector<double> after_speed_m_per_s;   // From the frame on.
  double rest_height_m = 0.0;
};

// Returns the speed as the slope of the line fitted to the positions from `first` to
// `last`. The fit averages noise that a difference of two frames would keep.
double fitted_speed(std::span<const glm::dvec3> p_in_world,
                    int first,
                    int last,
                    double hz) {
  const double middle = 0.5 * (first + last);
  glm::dvec3 slope(0.0);
  double weight = 0.0;
  for (int k = first; k <= last; ++k) {
    slope += (k - middle) * p_in_world[static_cast<std::size_t>(k)];
    weight += (k - middle) * (k - middle);
  }
  return weight > 0.0 ? glm::length(slope) * hz / weight : 0.0;
}

void find_speeds(double hz, double smoothing_s, Path& path) {
  const int count = static_cast<int>(path.p_in_world.size());
  const int half = std::max(1, static_cast<int>(std::lround(0.5 * smoothing_s * hz)));
  for (int t = 0; t < count; ++t) {
    const int first = std::max(0, t - half);
    const int last = std::min(count - 1, t + half);
    const auto speed = [&](int from, int to) {
      return fitted_speed(path.p_in_world, from, to, hz);
    };
    path.speed_m_per_s.push_back(speed(first, last));
    path.before_speed_m_per_s.push_back(first < t ? speed(first, t) : speed(first, last));
    path.after_speed_m_per_s.push_back(t < last ? speed(t, last) : speed(first, last));
  }
}

// Returns the lower decile of the heights while slow, or of all heights if it is never
// slow.
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

std::vector<FrameRange> runs(const std::vector<char>& on) {
  std::vector<FrameRange> out;
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

// Returns the height of the floor under one foot above its usual height, frame by frame:
// the lower decile of the heights of its lower point, while the foot is slow. Captured
// floors, and bodies that were fitted to markers, are off by some centimetres from one
// step to the next. A raised heel with the ball down is not such an offset.
std::vector<double> floor_under(const Path& ankle,
                                const Path* toes,
                                const BodyMap& map,
                                const DetectContactsOptions& o) {
  const double slow_m_per_s = o.keep_speed_legs_per_s * map.leg_length_m;
  const double max_m = o.uneven_legs * map.leg_length_m;
  std::vector<double> above;
  std::vector<char> slow;
  for (std::size_t t = 0; t < ankle.p_in_world.size(); ++t) {
    double height_m = ankle.p_in_world[t].y - ankle.rest_height_m;
    double speed = ankle.speed_m_per_s[t];
    if (toes != nullptr) {
      height_m = std::min(height_m, toes->p_in_world[t].y - toes->rest_height_m);
      speed = std::min(speed, toes->speed_m_per_s[t]);
    }
    above.push_back(height_m);
    slow.push_back(speed < slow_m_per_s && height_m < max_m ? 1 : 0);
  }
  std::vector<double> floor_m(above.size(), 0.0);
  for (const FrameRange& run : runs(slow)) {
    std::vector<double> heights(above.begin() + run.first, above.begin() + run.last + 1);
    const auto decile =
        heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 10);
    std::nth_element(heights.begin(), decile, heights.end());
    std::fill(floor_m.begin() + run.first,
              floor_m.begin() + run.last + 1,
              std::clamp(*decile, 0.0, max_m));
  }
  return floor_m;
}

// Returns the frames that keep a contact, in runs that contain at least one that starts
// it.
std::vector<FrameRange> resting_runs(const Path& path,
                                     std::span<const double> floor_m,
                                     const BodyMap& map,
                                     double hz,
                                     const DetectContactsOptions& o) {
  std::vector<char> start(path.p_in_world.size(), 0);
  std::vector<char> keep(path.p_in_world.size(), 0);
  for (std::size_t t = 0; t < keep.size(); ++t) {
    const double speed = path.speed_m_per_s[t] / map.leg_length_m;
    const double height =
        (path.p_in_world[t].y - path.rest_height_m - floor_m[t]) / map.leg_length_m;
    // A foot that has just landed already rests; one about to leave still rests.
    const bool is_slow =
        speed < o.keep_speed_legs_per_s ||
        path.after_speed_m_per_s[t] < o.edge_speed_legs_per_s * map.leg_length_m ||
        path.before_speed_m_per_s[t] < o.edge_speed_legs_per_s * map.leg_length_m;
    const bool keeps = is_slow && height < o.keep_height_legs;
    const bool starts =
        keeps && speed < o.start_speed_legs_per_s && height < o.start_height_legs;
    keep[t] = keeps ? 1 : 0;
    start[t] = starts ? 1 : 0;
  }
  std::vector<FrameRange> merged;
  for (const FrameRange& run : runs(keep)) {
    if (std::find(start.begin() + run.first, start.begin() + run.last + 1, 1) ==
        start.begin() + run.last + 1) {
      continue;
    }
    if (!merged.empty() && run.first - merged.back().last - 1 <= o.max_gap_s * hz) {
      merged.back().last = run.last;
    } else {
      merged.push_back(run);
    }
  }
  std::erase_if(merged, [&](const FrameRange& run) {
    return run.last - run.first + 1 < o.min_contact_s * hz;
  });
  return merged;
}

// Returns the frames in which the ball bears alone and the ankle is slow, in runs over
// which it hardly moves.
std::vector<FrameRange> heel_up_runs(const Path& ankle,
                                     const FootContacts& foot,
                                     const BodyMap& map,
                                     double hz,
                                     const DetectContactsOptions& o) {
  std::vector<char> still(ankle.p_in_world.size(), 0);
  for (const FrameRange& run : foot.ball) {
    for (int k = run.first; k <= run.last; ++k) {
      const auto t = static_cast<std::size_t>(k);
      const bool is_slow =
          ankle.speed_m_per_s[t] < o.start_speed_legs_per_s * map.leg_length_m;
      still[t] = is_slow ? 1 : 0;
    }
  }
  for (const FrameRange& run : foot.heel) {
    std::fill(still.begin() + run.first, still.begin() + run.last + 1, char{0});
  }
  std::vector<FrameRange> out = runs(still);
  std::erase_if(out, [&](const FrameRange& run) {
    if (run.last - run.first + 1 < o.min_contact_s * hz) return true;
    glm::dvec3 mean(0.0);
    for (int k = run.first; k <= run.last; ++k) {
      mean += ankle.p_in_world[static_cast<std::size_t>(k)];
    }
    mean /= run.last - run.first + 1;
    for (int k = run.first; k <= run.last; ++k) {
      const double away_m =
          glm::length(ankle.p_in_world[static_cast<std::size_t>(k)] - mean);
      if (away_m > o.heel_up_legs * map.leg_length_m) return true;
    }
    return false;
  });
  return out;
}

std::vector<FrameRange> either(const FootContacts& foot, int frame_count) {
  std::vector<char> on(static_cast<std::size_t>(frame_count), 0);
  for (const auto* part : {&foot.heel, &foot.ball}) {
    for (const FrameRange& run : *part) {
      std::fill(on.begin() + run.first, on.begin() + run.last + 1, char{1});
    }
  }
  return runs(on);
}

// Both sides stand on one floor: the height of a foot that never comes down is not its
// resting height.
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
    find_speeds(motion.rate.hz, options.smoothing_s, *path);
    path->rest_height_m =
        resting_height_m(*path, options.start_speed_legs_per_s * map.leg_length_m);
  }
  // Large, since the two feet of a captured body rest a few centimetres apart.
  constexpr double kSameFloorInLegs = 0.06;
  const double tolerance_m = kSameFloorInLegs * map.leg_length_m;
  share_floor(*paths[0], *paths[1], tolerance_m);
  if (paths[2] && paths[3]) share_floor(*paths[2], *paths[3], tolerance_m);

  for (std::size_t side = 0; side < 2; ++side) {
    FootContacts& foot = out.feet[side];
    const auto& toes = paths[side + 2];
    const std::vector<double> floor_m =
        floor_under(*paths[side], toes ? &*toes : nullptr, map, options);
    foot.heel = resting_runs(*paths[side], floor_m, map, motion.rate.hz, options);
    foot.ankle_height_m = paths[side]->rest_height_m;
    foot.ball = foot.heel;
    foot.ball_height_m = foot.ankle_height_m;
    if (toes) {
      foot.ball = resting_runs(*toes, floor_m, map, motion.rate.hz, options);
      foot.ball_height_m = toes->rest_height_m;
    }
    foot.stance = either(foot, out.frame_count);
    if (toes) {
      foot.heel_up = heel_up_runs(*paths[side], foot, map, motion.rate.hz, options);
    }
  }
  return out;
}

}  // namespace marey::retarget
