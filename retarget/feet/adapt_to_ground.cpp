// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/adapt_to_ground.h"

#include <array>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/transform.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/ground_legs.h"

namespace marey::retarget {
namespace {

constexpr double kReachTolerance = 5e-4;  // [m] A foot further off its print has slipped.

GroundLegs reference_legs(const Skeleton& body,
                          const BodyMap& map,
                          std::span<const NormalizedPose> poses) {
  GroundLegs out;
  std::vector<RigidTransform> world_from_joint(body.joints.size());
  for (const NormalizedPose& pose : poses) {
    add_legs(body, map, pose, world_from_joint, out);
  }
  return out;
}

// Puts both feet where plan_foot_path() plans them.
void plan(const BodyMap& map,
          const Contacts& contacts,
          FrameRate rate,
          const FootPathOptions& options,
          GroundLegs& ground) {
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<FootPlace>& foot = ground.legs[side].foot;
    MAREY_ASSERT(static_cast<int>(foot.size()) == contacts.frame_count);
    foot = plan_foot_path(
        foot, contacts.feet[side], map.feet[side], map.leg_length_m, rate, options);
  }
}

// Sinks the root where bearing legs do not reach, smoothly; legs follow.
GroundReport settle(const BodyMap& map,
                    const Contacts& contacts,
                    FrameRate rate,
                    std::span<NormalizedPose> poses,
                    const GroundLegs& ground,
                    const GroundOptions& options) {
  GroundReport report;
  if (poses.empty()) return report;
  const std::vector<double> sink =
      root_sinks_m(map, contacts, rate, ground, options.anticipation_s, options.straight);
  std::array<std::vector<char>, 2> bears;
  for (std::size_t side = 0; side < 2; ++side) {
    bears[side] = frame_marks(contacts.feet[side].stance, poses.size());
  }
  for (std::size_t t = 0; t < poses.size(); ++t) {
    const auto missed_m = settle_pose(map, ground, t, sink[t], poses[t]);
    bool slipped = false;
    for (std::size_t side = 0; side < 2; ++side) {
      slipped |= missed_m[side] > kReachTolerance && bears[side][t];
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
  GroundLegs ground = reference_legs(body, map, poses);
  for (std::size_t side = 0; side < 2; ++side) {
    MAREY_ASSERT(feet[side].size() == poses.size());
    ground.legs[side].foot = std::move(feet[side]);
  }
  return settle(map, contacts, rate, poses, ground, options);
}

std::array<std::vector<FootPlace>, 2> plan_level_feet(
    const Skeleton& body,
    const BodyMap& map,
    const Contacts& contacts,
    FrameRate rate,
    std::span<const NormalizedPose> poses,
    const FootPathOptions& options) {
  GroundLegs ground = reference_legs(body, map, poses);
  plan(map, contacts, rate, options, ground);
  return {std::move(ground.legs[0].foot), std::move(ground.legs[1].foot)};
}

GroundReport adapt_to_ground(const Skeleton& body,
                             const BodyMap& map,
                             const Contacts& contacts,
                             FrameRate rate,
                             std::span<NormalizedPose> poses,
                             const GroundOptions& options) {
  GroundLegs ground = reference_legs(body, map, poses);
  plan(map, contacts, rate, options.feet, ground);
  return settle(map, contacts, rate, poses, ground, options);
}

}  // namespace marey::retarget
