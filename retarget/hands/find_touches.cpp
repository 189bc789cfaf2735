// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/find_touches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "retarget/body/posed_frames.h"

namespace marey::retarget {
namespace {

using P = VolumePart;

constexpr double kFar = std::numeric_limits<double>::max();

struct Segment {
  glm::dvec3 start;
  glm::dvec3 end;
};

Segment axis_in_world(const Capsule& capsule, std::span<const RigidTransform> joints) {
  const RigidTransform& world_from_joint = joints[index(capsule.joint)];
  return {world_from_joint * axis_point_in_joint(capsule, -1.0),
          world_from_joint * axis_point_in_joint(capsule, 1.0)};
}

double nearest_on(const Segment& segment, const glm::dvec3& p) {
  const glm::dvec3 d = segment.end - segment.start;
  const double length2 = glm::dot(d, d);
  if (length2 < 1e-18) return 0.5;
  return std::clamp(glm::dot(p - segment.start, d) / length2, 0.0, 1.0);
}

// Returns the position on `hand`, 0 to 1, nearest to `part`. Uses alternating projections
// on two convex sets, starting from the middle, so that parallel segments meet in the
// middle.
double nearest_along(const Segment& hand, const Segment& part) {
  double on_hand = 0.5;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 p = glm::mix(hand.start, hand.end, on_hand);
    const glm::dvec3 q = glm::mix(part.start, part.end, nearest_on(part, p));
    on_hand = nearest_on(hand, q);
  }
  return on_hand;
}

// Distance of one hand to one part over the motion.
struct Approach {
  P part = P::kHead;
  std::vector<double> gap_m;
  std::vector<double> along_hand;  // 0 to 1.
  std::vector<glm::dvec3> hand_in_part;
};

std::vector<double> speeds(const std::vector<glm::dvec3>& path, double hz, int half) {
  const int count = static_cast<int>(path.size());
  std::vector<double> out(path.size());
  for (int t = 0; t < count; ++t) {
    const int from = std::max(0, t - half);
    const int to = std::min(count - 1, t + half);
    const double middle = 0.5 * (from + to);
    glm::dvec3 slope(0.0);
    double weight = 0.0;
    for (int k = from; k <= to; ++k) {
      slope += (k - middle) * path[static_cast<std::size_t>(k)];
      weight += (k - middle) * (k - middle);
    }
    out[static_cast<std::size_t>(t)] =
        weight > 0.0 ? glm::length(slope) * hz / weight : 0.0;
  }
  return out;
}

std::vector<double> means(const std::vector<double>& values, int half) {
  const int count = static_cast<int>(values.size());
  std::vector<double> out(values.size());
  for (int t = 0; t < count; ++t) {
    const int from = std::max(0, t - half);
    const int to = std::min(count - 1, t + half);
    double sum = 0.0;
    for (int k = from; k <= to; ++k) sum += values[static_cast<std::size_t>(k)];
    out[static_cast<std::size_t>(t)] = sum / (to - from + 1);
  }
  return out;
}

// Returns the runs of frames that satisfy `keep` and contain a frame that satisfies
// `start`; short gaps are closed.
std::vector<FrameRange> runs_of(const std::vector<char>& keeps,
                                const std::vector<char>& starts,
                                double max_gap,
                                double shortest) {
  std::vector<FrameRange> runs;
  std::vector<char> started;
  for (int t = 0; t < static_cast<int>(keeps.size()); ++t) {
    const auto i = static_cast<std::size_t>(t);
    if (!keeps[i]) continue;
    if (!runs.empty() && t - runs.back().last - 1 <= max_gap) {
      runs.back().last = t;
      started.back() = started.back() || starts[i] ? 1 : 0;
    } else {
      runs.push_back({t, t});
      started.push_back(starts[i]);
    }
  }
  std::vector<FrameRange> out;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (started[i] && runs[i].last - runs[i].first + 1 >= shortest) {
      out.push_back(runs[i]);
    }
  }
  return out;
}

struct Search {
  const PosedFrames& frames;
  const BodyVolume& volume;
  const FindTouchesOptions& options;
  double hz;
  double leg_m;
  int half;
};

Approach approach(const Search& search, int side, P part) {
  const Capsule& hand = *search.volume[on_side(P::kLeftHand, side)];
  const Capsule& other = *search.volume[part];
  Approach out{part, {}, {}, {}};
  for (std::size_t t = 0; t < search.frames.count(); ++t) {
    const auto joints = search.frames[t];
    const Segment axis = axis_in_world(hand, joints);
    const double along = nearest_along(axis, axis_in_world(other, joints));
    const glm::dvec3 p = glm::mix(axis.start, axis.end, along);
    out.along_hand.push_back(along);
    out.gap_m.push_back(side_of(other, joints, p).distance_m - hand.radius_m);
    out.hand_in_part.push_back(
        inverse(joints[index(other.joint)] * other.joint_from_capsule) *
        (0.5 * (axis.start + axis.end)));
  }
  return out;
}

Touch touch_of(const Search& search,
               int side,
               const FrameRange& run,
               const std::vector<Approach>& parts) {
  const auto mean_over = [&](const std::vector<double>& values) {
    double sum = 0.0;
    for (int t = run.first; t <= run.last; ++t)
      sum += values[static_cast<std::size_t>(t)];
    return sum / (run.last - run.first + 1);
  };
  const Approach* nearest = &parts[0];
  for (const Approach& part : parts) {
    if (mean_over(part.gap_m) < mean_over(nearest->gap_m)) nearest = &part;
  }
  const Capsule& hand = *search.volume[on_side(P::kLeftHand, side)];
  const Capsule& other = *search.volume[nearest->part];
  Touch touch{
      side, nearest->part, run, 2.0 * mean_over(nearest->along_hand) - 1.0, {}, 0};
  glm::dvec3 p_in_part(0.0);
  for (int t = run.first; t <= run.last; ++t) {
    const auto joints = search.frames[static_cast<std::size_t>(t)];
    const glm::dvec3 p =
        joints[index(hand.joint)] * axis_point_in_joint(hand, touch.along_hand);
    p_in_part += inverse(joints[index(other.joint)] * other.joint_from_capsule) * p;
  }
  p_in_part /= run.last - run.first + 1;
  touch.place = place_on(other, p_in_part);
  touch.distance_m = side_of(other, p_in_part).distance_m - hand.radius_m;
  return touch;
}

// `group`: parts of which a hand touches at most one at a time.
void find_on(const Search& search,
             int side,
             std::span<const P> group,
             std::vector<Touch>& out) {
  std::vector<Approach> parts;
  for (const P part : group) {
    if (search.volume[part]) parts.push_back(approach(search, side, part));
  }
  if (parts.empty()) return;
  const FindTouchesOptions& o = search.options;
  const std::size_t count = search.frames.count();
  std::vector<double> gap_legs(count, kFar);
  std::vector<double> speed_legs(count, kFar);
  for (const Approach& part : parts) {
    const std::vector<double> gap = means(part.gap_m, search.half);
    const std::vector<double> speed = speeds(part.hand_in_part, search.hz, search.half);
    for (std::size_t t = 0; t < count; ++t) {
      if (gap[t] / search.leg_m >= gap_legs[t]) continue;
      gap_legs[t] = gap[t] / search.leg_m;
      speed_legs[t] = speed[t] / search.leg_m;
    }
  }
  std::vector<char> keeps(count, 0);
  std::vector<char> starts(count, 0);
  for (std::size_t t = 0; t < count; ++t) {
    keeps[t] = gap_legs[t] < o.keep_gap_legs && speed_legs[t] < o.keep_speed_legs_per_s;
    starts[t] =
        gap_legs[t] < o.start_gap_legs && speed_legs[t] < o.start_speed_legs_per_s;
  }
  for (const FrameRange& run :
       runs_of(keeps, starts, o.max_gap_s * search.hz, o.min_touch_s * search.hz)) {
    out.push_back(touch_of(search, side, run, parts));
  }
}

// Removes false touches: hands that touch each other bring each near the other's forearm.
void drop_arms_of_hands(std::vector<Touch>& touches) {
  const std::vector<Touch> all = touches;
  std::erase_if(touches, [&](const Touch& touch) {
    const P forearm = on_side(P::kLeftForearm, 1 - touch.side);
    const P upper = on_side(P::kLeftUpperArm, 1 - touch.side);
    if (touch.part != forearm && touch.part != upper) return false;
    return std::any_of(all.begin(), all.end(), [&](const Touch& hands) {
      return hands.part == P::kRightHand && hands.frames.first <= touch.frames.last &&
             hands.frames.last >= touch.frames.first;
    });
  });
}

// Returns the end of the longest interval from `first` on that stays near its own start.
int stays_until(const std::vector<glm::dvec3>& path, int first, int last, double radius) {
  const glm::dvec3 begin = path[static_cast<std::size_t>(first)];
  int t = first;
  while (t < last &&
         glm::distance(path[static_cast<std::size_t>(t + 1)], begin) < radius) {
    ++t;
  }
  return t;
}

void find_still(const Search& search,
                const BodyMap& map,
                int side,
                std::vector<StillHand>& out) {
  const FindTouchesOptions& o = search.options;
  const Capsule& hand = *search.volume[on_side(P::kLeftHand, side)];
  const JointIndex shoulder = map.limbs[static_cast<std::size_t>(side)]->upper;
  std::vector<glm::dvec3> path;
  std::vector<glm::dvec3> shoulder_path;
  for (std::size_t t = 0; t < search.frames.count(); ++t) {
    const auto joints = search.frames[t];
    path.push_back(joints[index(hand.joint)] * axis_point_in_joint(hand, 0.0));
    shoulder_path.push_back(joints[index(shoulder)].translation);
  }
  const std::vector<double> speed = speeds(path, search.hz, 2 * search.half);
  std::vector<char> slow(path.size(), 0);
  for (std::size_t t = 0; t < slow.size(); ++t) {
    slow[t] = speed[t] < o.still_speed_legs_per_s * search.leg_m;
  }
  const double shortest = o.min_still_s * search.hz;
  for (const FrameRange& run : runs_of(slow, slow, o.max_gap_s * search.hz, shortest)) {
    for (int first = run.first; first <= run.last;) {
      const int last =
          stays_until(path, first, run.last, o.still_radius_legs * search.leg_m);
      StillHand still{side, {first, last}, glm::dvec3(0.0)};
      double travel_m = 0.0;
      for (int t = first; t <= last; ++t) {
        const auto i = static_cast<std::size_t>(t);
        still.p_in_world += path[i] / static_cast<double>(last - first + 1);
        travel_m =
            std::max(travel_m,
                     glm::distance(shoulder_path[i],
                                   shoulder_path[static_cast<std::size_t>(first)]));
      }
      if (last - first + 1 >= shortest && travel_m > o.still_travel_legs * search.leg_m) {
        out.push_back(still);
      }
      first = last + 1;
    }
  }
}

}  // namespace

Touches find_touches(const Motion& motion,
                     const BodyMap& map,
                     const BodyVolume& volume,
                     const FindTouchesOptions& options) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  MAREY_ASSERT(map.joints.size() == motion.skeleton.joints.size());
  Touches out;
  out.frame_count = static_cast<int>(motion.poses.size());
  if (motion.poses.empty()) return out;
  const PosedFrames frames(motion);
  const int half =
      static_cast<int>(std::lround(0.5 * options.smoothing_s * motion.rate.hz));
  const Search search{
      frames, volume, options, motion.rate.hz, map.leg_length_m, std::max(half, 1)};
  for (int side = 0; side < 2; ++side) {
    if (!volume[on_side(P::kLeftHand, side)]) continue;
    const auto arm = [&](P part) { return on_side(part, 1 - side); };
    constexpr std::array kOtherHand{P::kRightHand};
    constexpr std::array kHead{P::kHead};
    constexpr std::array kTrunk{P::kChest, P::kAbdomen, P::kPelvis};
    if (side == 0) find_on(search, side, kOtherHand, out.touches);
    find_on(search, side, kHead, out.touches);
    find_on(search, side, kTrunk, out.touches);
    for (int leg = 0; leg < 2; ++leg) {
      const std::array parts{on_side(P::kLeftThigh, leg), on_side(P::kLeftShank, leg)};
      find_on(search, side, parts, out.touches);
    }
    const std::array parts{arm(P::kLeftForearm), arm(P::kLeftUpperArm)};
    find_on(search, side, parts, out.touches);
    if (map.limbs[static_cast<std::size_t>(side)]) {
      find_still(search, map, side, out.still);
    }
  }
  drop_arms_of_hands(out.touches);
  return out;
}

}  // namespace marey::retarget
