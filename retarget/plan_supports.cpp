// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/plan_supports.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/assert.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "retarget/foot_plan.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr std::array<B, 2> kFeet{B::kLeftFoot, B::kRightFoot};
constexpr std::array<B, 2> kToes{B::kLeftToes, B::kRightToes};

// The foot over the motion, above a floor at Y = 0.
std::vector<FootPlace> places_of(const Motion& motion,
                                 const BodyMap& map,
                                 std::size_t side,
                                 double floor_height_m) {
  const auto turn = [&](const std::vector<RigidTransform>& world, JointIndex joint) {
    return world[index(joint)].rotation *
           glm::conjugate(map.joints[index(joint)].t_pose_from_joint);
  };
  const JointIndex ankle = map.leg(static_cast<int>(side)).end;
  const auto toes = map.joint_of[index(kToes[side])];
  std::vector<FootPlace> out;
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    FootPlace place{world[index(ankle)].translation, turn(world, ankle), {}};
    place.ankle_in_world.y -= floor_height_m;
    place.toes = toes ? turn(world, *toes) : place.foot;
    out.push_back(place);
  }
  return out;
}

// Runs that are nearer to each other than `gap` frames become one.
std::vector<FrameInterval> merged(const std::vector<FrameInterval>& runs, double gap) {
  std::vector<FrameInterval> out;
  for (const FrameInterval& run : runs) {
    if (!out.empty() && run.first - out.back().last <= gap) {
      out.back().last = run.last;
    } else {
      out.push_back(run);
    }
  }
  return out;
}

std::vector<FrameInterval> common(const std::vector<FrameInterval>& a,
                                  const std::vector<FrameInterval>& b) {
  std::vector<FrameInterval> out;
  for (const FrameInterval& x : a) {
    for (const FrameInterval& y : b) {
      const FrameInterval both{std::max(x.first, y.first), std::min(x.last, y.last)};
      if (both.first <= both.last) out.push_back(both);
    }
  }
  return out;
}

// Never by itself: whoever drives the track starts it.
constexpr double kNever_s = 1e8;

// Where a joint bears alone, and the frames of the flat foot beside it: there both hold,
// so that one may fade while the other does.
std::vector<FrameInterval> alone(const std::vector<FrameInterval>& runs,
                                 const std::vector<FrameInterval>& flat) {
  const auto is_in = [](const std::vector<FrameInterval>& all, int frame) {
    return std::any_of(all.begin(), all.end(), [frame](const FrameInterval& run) {
      return run.first <= frame && frame <= run.last;
    });
  };
  std::vector<FrameInterval> out;
  for (const FrameInterval& run : runs) {
    bool goes_on = false;
    for (int t = run.first; t <= run.last; ++t) {
      const bool counts = !is_in(flat, t) || (t > run.first && !is_in(flat, t - 1)) ||
                          (t < run.last && !is_in(flat, t + 1));
      if (counts && !goes_on) out.push_back({t, t});
      if (counts) out.back().last = t;
      goes_on = counts;
    }
  }
  return out;
}

struct Bearing {
  const char* name;
  std::vector<FrameInterval> runs;
  glm::dvec3 offset_in_t_pose;
  bool turns;
};

}  // namespace

std::vector<SupportTrack> plan_supports(const Motion& reference,
                                        const BodyMap& map,
                                        const Contacts& contacts,
                                        const PlanSupportsOptions& options) {
  MAREY_ASSERT(contacts.frame_count == static_cast<int>(reference.poses.size()));
  MAREY_ASSERT(options.ramp_s >= 0.0 && reference.rate.hz > 0.0);
  std::vector<SupportTrack> tracks;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!options.feet[side]) continue;
    const FootContacts& bears = contacts.feet[side];
    const FootMap& foot = map.feet[side];
    std::vector<FootPlace> plan =
        plan_foot(places_of(reference, map, side, options.floor_height_m),
                  bears,
                  foot,
                  map.leg_length_m,
                  reference.rate);
    for (FootPlace& place : plan) place.ankle_in_world.y += options.floor_height_m;
    const glm::dvec3 ball = foot.ball_from_ankle_in_t_pose;
    // Heel and ball first: of several supports of one limb the first is closed exactly,
    // and they hold while the flat foot fades in or out beside them.
    const std::vector<FrameInterval> flat = common(bears.heel, bears.ball);
    const std::array<Bearing, 3> ways{
        {{"heel", alone(bears.heel, flat), glm::dvec3(0.0), true},
         {"ball", alone(bears.ball, flat), ball, true},
         {"flat", flat, glm::dvec3(0.0), false}}};
    for (const Bearing& way : ways) {
      SupportTrack track;
      track.bears = merged(way.runs, 2.0 * options.ramp_s * reference.rate.hz + 1.0);
      if (track.bears.empty()) continue;
      const std::string segment(name(kFeet[side]));
      track.constraint.id = "found " + segment + " " + way.name;
      track.constraint.point = {segment, way.offset_in_t_pose};
      track.constraint.goal = Support{glm::dvec3(0.0), std::nullopt, way.turns};
      track.constraint.activation = {
          kNever_s, std::nullopt, options.ramp_s, options.ramp_s};
      for (const FootPlace& place : plan) {
        track.p_in_world.push_back(place.ankle_in_world +
                                   place.foot * way.offset_in_t_pose);
        track.world_from_t_pose.push_back(place.foot);
      }
      tracks.push_back(std::move(track));
    }
  }
  return tracks;
}

}  // namespace marey::retarget
