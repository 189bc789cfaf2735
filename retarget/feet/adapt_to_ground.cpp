// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/adapt_to_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/base/smooth_cover.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {
namespace {

constexpr double kReachTolerance = 5e-4;  // [m] A foot further off its print has slipped.

// One leg over the whole motion.
struct LegPath {
  std::vector<FootPlace> foot;
  std::vector<glm::dvec3> hip_from_root;  // World axes. [m]
};

std::array<LegPath, 2> reference_legs(const Skeleton& body,
                                      const BodyMap& map,
                                      std::span<const NormalizedPose> poses) {
  std::array<LegPath, 2> legs;
  std::vector<RigidTransform> world_from_joint(body.joints.size());
  Pose scratch;
  for (const NormalizedPose& pose : poses) {
    expand(pose, body, map, world_from_joint, scratch);
    const glm::dvec3 root = world_from_joint[index(map.hips())].translation;
    for (int side = 0; side < 2; ++side) {
      LegPath& leg = legs[static_cast<std::size_t>(side)];
      leg.foot.push_back(foot_of(map, pose, world_from_joint, side));
      leg.hip_from_root.push_back(
          world_from_joint[index(map.leg(side).upper)].translation - root);
    }
  }
  return legs;
}

// Puts both feet where plan_foot_path() plans them.
void plan(const BodyMap& map,
          const Contacts& contacts,
          FrameRate rate,
          const FootPathOptions& options,
          std::array<LegPath, 2>& legs) {
  for (std::size_t side = 0; side < 2; ++side) {
    LegPath& leg = legs[side];
    MAREY_ASSERT(static_cast<int>(leg.foot.size()) == contacts.frame_count);
    leg.foot = plan_foot_path(
        leg.foot, contacts.feet[side], map.feet[side], map.leg_length_m, rate, options);
  }
}

// Sinks the root where bearing legs do not reach, smoothly; legs follow.
GroundReport settle(const BodyMap& map,
                    const Contacts& contacts,
                    FrameRate rate,
                    std::span<NormalizedPose> poses,
                    const std::array<LegPath, 2>& legs,
                    const GroundOptions& options) {
  GroundReport report;
  if (poses.empty()) return report;
  const std::size_t count = poses.size();
  const double unit_m = root_unit_m(map, poses[0].root_normalization);

  std::array<std::vector<char>, 2> bears;
  std::vector<double> needed(count, 0.0);
  for (std::size_t side = 0; side < 2; ++side) {
    const LegPath& leg = legs[side];
    bears[side] = frame_marks(contacts.feet[side].stance, count);
    const double full_m = map.leg(static_cast<int>(side)).length_m();
    for (std::size_t t = 0; t < count; ++t) {
      if (!bears[side][t]) continue;
      const double length_m =
          full_m * std::max(options.straight, poses[t].limbs[2 + side]->extension);
      // hip_from_root removes half the pelvis' width.
      const glm::dvec3 hip = poses[t].root * unit_m + leg.hip_from_root[t];
      needed[t] = std::max(needed[t], sink_m(hip, leg.foot[t].ankle_in_world, length_m));
    }
  }

  // A window longer than the whole motion has no further effect.
  const double half_frames =
      std::clamp(options.anticipation_s * 0.5 * rate.hz, 1.0, static_cast<double>(count));
  const int half = static_cast<int>(std::lround(half_frames));
  const std::vector<double> sink = smooth_cover(needed, half);
  for (std::size_t t = 0; t < count; ++t) {
    NormalizedPose& pose = poses[t];
    pose.root.y -= sink[t] / unit_m;
    bool slipped = false;
    for (int side = 0; side < 2; ++side) {
      const LegPath& leg = legs[static_cast<std::size_t>(side)];
      const glm::dvec3 hip = pose.root * unit_m + leg.hip_from_root[t];
      auto& limb = pose.limbs[2 + static_cast<std::size_t>(side)];
      MAREY_ASSERT(limb.has_value());
      const double missed_m =
          aim_leg(hip, leg.foot[t].ankle_in_world, map.leg(side).length_m(), *limb);
      slipped |= missed_m > kReachTolerance && bears[static_cast<std::size_t>(side)][t];
      pose.segments[index(foot_bone(side))] = leg.foot[t].foot;
      pose.segments[index(toes_bone(side))] = leg.foot[t].toes;
    }
    if (slipped) ++report.unreachable_frames;
  }
  return report;
}

}  // namespace

double standing_rise_m(const BodyMap& source,
                       const std::array<double, 2>& source_ankles_rest_m,
                       const BodyMap& avatar,
                       double scale) {
  double source_m = source.hip_drop_m;
  double avatar_m = avatar.hip_drop_m;
  for (std::size_t side = 0; side < 2; ++side) {
    source_m += 0.5 * source_ankles_rest_m[side];
    avatar_m += 0.5 * avatar.feet[side].ankle_height_m;
  }
  return avatar_m - scale * source_m;
}

std::array<double, 2> ankles_rest_m(const BodyMap& source, const Contacts& contacts) {
  std::array<double, 2> rest_m{};
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContacts& foot = contacts.feet[side];
    const FootContacts& other = contacts.feet[1 - side];
    if (!foot.stance.empty()) {
      rest_m[side] = foot.ankle_height_m;
      continue;
    }
    rest_m[side] = source.feet[side].ankle_height_m;
    if (other.stance.empty()) continue;
    rest_m[side] += other.ankle_height_m - source.feet[1 - side].ankle_height_m;
  }
  return rest_m;
}

double floor_height_m(const BodyMap& body, const std::array<double, 2>& ankles_rest_m) {
  double floor_m = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    floor_m += 0.5 * (ankles_rest_m[side] - body.feet[side].ankle_height_m);
  }
  return floor_m;
}

double standing_rise_m(const BodyMap& source,
                       const Contacts& contacts,
                       const BodyMap& avatar,
                       double scale) {
  return standing_rise_m(source, ankles_rest_m(source, contacts), avatar, scale);
}

GroundReport settle_on_feet(const Skeleton& body,
                            const BodyMap& map,
                            const Contacts& contacts,
                            FrameRate rate,
                            std::span<NormalizedPose> poses,
                            std::array<std::vector<FootPlace>, 2> feet,
                            const GroundOptions& options) {
  std::array<LegPath, 2> legs = reference_legs(body, map, poses);
  for (std::size_t side = 0; side < 2; ++side) {
    MAREY_ASSERT(feet[side].size() == poses.size());
    legs[side].foot = std::move(feet[side]);
  }
  return settle(map, contacts, rate, poses, legs, options);
}

std::array<std::vector<FootPlace>, 2> plan_level_feet(
    const Skeleton& body,
    const BodyMap& map,
    const Contacts& contacts,
    FrameRate rate,
    std::span<const NormalizedPose> poses,
    const FootPathOptions& options) {
  std::array<LegPath, 2> legs = reference_legs(body, map, poses);
  plan(map, contacts, rate, options, legs);
  return {std::move(legs[0].foot), std::move(legs[1].foot)};
}

GroundReport adapt_to_ground(const Skeleton& body,
                             const BodyMap& map,
                             const Contacts& contacts,
                             FrameRate rate,
                             std::span<NormalizedPose> poses,
                             const GroundOptions& options) {
  std::array<LegPath, 2> legs = reference_legs(body, map, poses);
  plan(map, contacts, rate, options.feet, legs);
  return settle(map, contacts, rate, poses, legs, options);
}

}  // namespace marey::retarget
