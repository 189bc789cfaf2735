// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/box_touches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/pose.h"

namespace marey::edit {
namespace {

/// Points of a hand's axis that are compared with a box, from the wrist to the tips.
constexpr int kAxisPoints = 9;

/// Nearest point of a box's surface, its normal there, and the distance of a point from
/// it: negative inside.
struct BoxSide {
  glm::dvec3 p_in_world{0.0};
  glm::dvec3 normal{0.0, 1.0, 0.0};
  double distance_m = 0.0;
};

BoxSide side_of_box(const EditObject& box, const glm::dvec3& p) {
  BoxSide out;
  const glm::dvec3 nearest = glm::clamp(p, box.min_in_world, box.max_in_world);
  const double outside_m = glm::distance(p, nearest);
  if (outside_m > 0.0) {
    return {nearest, (p - nearest) / outside_m, outside_m};
  }
  double least_m = -1.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double face : {box.max_in_world[axis], box.min_in_world[axis]}) {
      const double depth_m = std::abs(face - p[axis]);
      if (least_m >= 0.0 && depth_m >= least_m) continue;
      least_m = depth_m;
      out.p_in_world = p;
      out.p_in_world[axis] = face;
      out.normal = glm::dvec3(0.0);
      out.normal[axis] = face == box.max_in_world[axis] ? 1.0 : -1.0;
      out.distance_m = -depth_m;
    }
  }
  return out;
}

/// Place of one hand relative to one box in one frame.
struct HandAtBox {
  double gap_m = 0.0;
  glm::dvec3 p_in_joint{0.0};
  glm::dvec3 p_in_world{0.0};
};

HandAtBox hand_at_box(const retarget::Capsule& hand,
                      const RigidTransform& world_from_joint,
                      const EditObject& box) {
  HandAtBox out;
  for (int i = 0; i < kAxisPoints; ++i) {
    const double along = 2.0 * i / (kAxisPoints - 1) - 1.0;
    const glm::dvec3 p_in_joint = retarget::axis_point_in_joint(hand, along);
    const BoxSide side = side_of_box(box, world_from_joint * p_in_joint);
    const double gap_m = side.distance_m - hand.radius_m;
    if (i > 0 && gap_m >= out.gap_m) continue;
    const glm::dvec3 inward = glm::conjugate(world_from_joint.rotation) * -side.normal;
    out = {gap_m, p_in_joint + hand.radius_m * inward, side.p_in_world};
  }
  return out;
}

/// Returns the speeds of a path by line fits over `half` frames to either side. [m/s]
std::vector<double> fitted_speeds(const std::vector<glm::dvec3>& path,
                                  double hz,
                                  int half) {
  const int count = static_cast<int>(path.size());
  std::vector<double> out(path.size(), 0.0);
  for (int t = 0; t < count; ++t) {
    const int from = std::max(0, t - half);
    const int to = std::min(count - 1, t + half);
    const double middle = 0.5 * (from + to);
    glm::dvec3 slope(0.0);
    double squares = 0.0;
    for (int k = from; k <= to; ++k) {
      slope += (k - middle) * path[static_cast<std::size_t>(k)];
      squares += (k - middle) * (k - middle);
    }
    if (squares > 0.0)
      out[static_cast<std::size_t>(t)] = glm::length(slope) * hz / squares;
  }
  return out;
}

/// Runs of frames of one hand that may be on a box.
struct TouchRun {
  FrameRange frames;
  bool starts = false;
};

std::vector<TouchRun> touch_runs(const std::vector<HandAtBox>& places,
                                 const std::vector<double>& speed,
                                 double leg_m,
                                 double hz,
                                 const BoxTouchOptions& options) {
  std::vector<TouchRun> runs;
  const double max_pause = options.max_pause_s * hz;
  for (int frame = 0; frame < static_cast<int>(places.size()); ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    if (std::abs(places[t].gap_m) > options.max_gap_m) continue;
    if (speed[t] > options.keep_speed_legs_per_s * leg_m) continue;
    const bool starts = speed[t] <= options.start_speed_legs_per_s * leg_m;
    if (!runs.empty() && frame - runs.back().frames.last - 1 <= max_pause) {
      runs.back().frames.last = frame;
      runs.back().starts = runs.back().starts || starts;
    } else {
      runs.push_back({{frame, frame}, starts});
    }
  }
  std::erase_if(runs, [&](const TouchRun& run) {
    return !run.starts ||
           run.frames.last - run.frames.first + 1 < options.min_touch_s * hz;
  });
  return runs;
}

BoxTouch mean_touch(const FrameRange& frames, const std::vector<HandAtBox>& places) {
  BoxTouch out;
  out.frames = frames;
  const double share = 1.0 / (frames.last - frames.first + 1);
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const HandAtBox& place = places[static_cast<std::size_t>(frame)];
    out.p_in_joint += share * place.p_in_joint;
    out.p_in_world += share * place.p_in_world;
    out.gap_m += share * place.gap_m;
  }
  return out;
}

}  // namespace

std::vector<BoxTouch> find_box_touches(const Motion& motion,
                                       const retarget::BodyMap& map,
                                       const retarget::BodyVolume& volume,
                                       std::span<const EditObject> objects,
                                       const BoxTouchOptions& options) {
  using retarget::VolumePart;
  std::vector<BoxTouch> out;
  if (objects.empty()) return out;
  const double hz = motion.rate.hz;
  const int half =
      std::max(1, static_cast<int>(std::lround(0.5 * options.smoothing_s * hz)));
  std::vector<RigidTransform> joints(motion.skeleton.joints.size());
  for (int side = 0; side < 2; ++side) {
    const auto& hand = volume[retarget::on_side(VolumePart::kLeftHand, side)];
    if (!hand) continue;
    std::vector<glm::dvec3> path;
    std::vector<std::vector<HandAtBox>> places(objects.size());
    for (const Pose& pose : motion.poses) {
      world_from_joints(motion.skeleton, pose, joints);
      const RigidTransform& joint = joints[index(hand->joint)];
      path.push_back(joint * retarget::axis_point_in_joint(*hand, 0.0));
      for (std::size_t i = 0; i < objects.size(); ++i) {
        places[i].push_back(hand_at_box(*hand, joint, objects[i]));
      }
    }
    const std::vector<double> speed = fitted_speeds(path, hz, half);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      for (const TouchRun& run :
           touch_runs(places[i], speed, map.leg_length_m, hz, options)) {
        BoxTouch touch = mean_touch(run.frames, places[i]);
        touch.side = side;
        touch.object = i;
        out.push_back(touch);
      }
    }
  }
  return out;
}

}  // namespace marey::edit
