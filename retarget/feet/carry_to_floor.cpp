// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/carry_to_floor.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/pose.h"
#include "retarget/base/triweight.h"
#include "retarget/feet/plan_feet.h"

namespace marey::retarget {
namespace {

bool is_carried(const FloorFoot& foot) {
  return std::any_of(foot.carried_m.begin(),
                     foot.carried_m.end(),
                     [](const glm::dvec3& by_m) { return by_m != glm::dvec3(0.0); });
}

// Mean over the feet that stand at all.
glm::dvec3 root_shift_m(const std::array<FloorFoot, 2>& feet, std::size_t t) {
  glm::dvec3 sum_m(0.0);
  int count = 0;
  for (const FloorFoot& foot : feet) {
    if (foot.stances.empty()) continue;
    sum_m += foot.carried_m[t];
    ++count;
  }
  return count > 0 ? sum_m / static_cast<double>(count) : feet[0].carried_m[t];
}

// Averages over +-`half_s` over the whole motion, with a C2 kernel that is narrower near
// the ends: uniform motion stays uniform, and exact zeros stay zero.
std::vector<glm::dvec3> root_path_m(const std::array<FloorFoot, 2>& feet,
                                    std::size_t count,
                                    double half_s,
                                    FrameRate rate) {
  std::vector<glm::dvec3> shift_m(count);
  for (std::size_t t = 0; t < count; ++t) shift_m[t] = root_shift_m(feet, t);
  const auto widest = static_cast<std::size_t>(
      std::clamp(half_s * rate.hz, 0.0, static_cast<double>(count)));
  std::vector<glm::dvec3> out(count);
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t half = std::min({widest, t, count - 1 - t});
    glm::dvec3 sum_m = shift_m[t];
    double weights = 1.0;
    for (std::size_t k = 1; k <= half; ++k) {
      const double weight =
          triweight(static_cast<double>(k) / static_cast<double>(half + 1));
      sum_m += weight * (shift_m[t - k] + shift_m[t + k]);
      weights += 2.0 * weight;
    }
    out[t] = sum_m / weights;
  }
  return out;
}

}  // namespace

CarriedMotion carry_to_floor(const Motion& motion,
                             const BodyMap& map,
                             const Contacts& contacts,
                             const Floor& floor,
                             double floor_height_m,
                             const CarryOptions& options) {
  auto feet = plan_feet(motion, map, contacts, floor_height_m, &floor);
  // A foot is lifted over an edge only if it is displaced, or the edge was in the way
  // before.
  if (!is_carried(feet[0]) && !is_carried(feet[1])) return {motion, {}};

  const std::vector<glm::dvec3> root_m =
      root_path_m(feet, motion.poses.size(), options.root_blend_s, motion.rate);
  std::vector<NormalizedPose> poses(motion.poses.size());
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  for (std::size_t t = 0; t < poses.size(); ++t) {
    world_from_joints(motion.skeleton, motion.poses[t], world_from_joint);
    normalize(map, world_from_joint, poses[t]);
    poses[t].root += root_m[t] / root_unit_m(map, poses[t].root_normalization);
  }
  CarriedMotion out{motion, {}};
  out.ground = settle_on_feet(motion.skeleton,
                              map,
                              contacts,
                              motion.rate,
                              poses,
                              {std::move(feet[0].places), std::move(feet[1].places)},
                              options.ground);
  for (std::size_t t = 0; t < poses.size(); ++t) {
    expand(poses[t], motion.skeleton, map, world_from_joint, out.motion.poses[t]);
  }
  return out;
}

}  // namespace marey::retarget
