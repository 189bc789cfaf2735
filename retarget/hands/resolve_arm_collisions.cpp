// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/resolve_arm_collisions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/transform.h"
#include "retarget/base/smooth_cover.h"
#include "core/base/smooth_step.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/hands/arm_clearance.h"

namespace marey::retarget {
namespace {

// Between these shares of its length an arm changes from bending or stretching to
// rotation only: the elbow of a straight arm moves by centimetres for a millimetre of the
// wrist.
constexpr double kMaxStraightness = 0.8;
constexpr double kTurns = 0.95;
// Maximum share of the error after a pass for another pass to follow.
constexpr double kWorthIt = 0.95;

std::size_t slot_of_side(int side) {
  return static_cast<std::size_t>(side);
}

struct Clearing {
  const VolumeInMotion& source;
  const VolumeInMotion& avatar;
  const Arms& source_arms;
  const Arms& arms;
  double slack_m;
  std::optional<double> source_floor_m;  // World Y; nullopt: floors are ignored.
  std::optional<double> floor_m;

  [[nodiscard]] ArmPenetration penetration(std::size_t t,
                                           int side,
                                           const ArmShift& shift) const {
    return arm_penetration(
        {source.volume, source.frames[t], source_arms.places(t, side), source_floor_m},
        {avatar.volume, avatar.frames[t], arms.places(t, side, shift), floor_m},
        side,
        slack_m);
  }

  [[nodiscard]] ArmShift answer(std::size_t t,
                                int side,
                                const ArmShift& shift,
                                const ArmPenetration& penetration) const {
    return shift_for(penetration, arms.limb(side), arms.places(t, side, shift));
  }
};

// Displacement of a wrist as a rotation of the line from the shoulder and a change of its
// length.
struct Turn {
  glm::dvec3 turn{0.0};  // Rotation vector, world axes. [rad]
  double longer_m = 0.0;
};

Turn turn_of(const LimbMap& limb, const ArmPlaces& arm, const glm::dvec3& way) {
  const glm::dvec3 reach = arm.wrist - arm.shoulder;
  const double reach_m = glm::length(reach);
  if (reach_m < 1e-6) return {};
  const double straight = smooth_step((reach_m / limb.length_m() - kMaxStraightness) /
                                      (kTurns - kMaxStraightness));
  return {glm::cross(reach, way) / (reach_m * reach_m),
          (1.0 - straight) * glm::dot(way, reach) / reach_m};
}

glm::dvec3 way_of(const ArmPlaces& arm, const Turn& turn) {
  const glm::dvec3 reach = arm.wrist - arm.shoulder;
  const double reach_m = glm::length(reach);
  if (reach_m < 1e-6) return glm::dvec3(0.0);
  const glm::dvec3 turned = rotation_from_vector(turn.turn) * reach;
  return turned * (1.0 + turn.longer_m / reach_m) - reach;
}

// A signal of errors over time, and its smooth upper bound.
struct Channel {
  std::vector<double> above;
  std::vector<double> below;

  explicit Channel(std::size_t count) : above(count, 0.0), below(count, 0.0) {}
  void set(std::size_t t, double value) {
    above[t] = std::max(value, 0.0);
    below[t] = std::max(-value, 0.0);
  }
  [[nodiscard]] std::vector<double> covered(int half) const {
    std::vector<double> out = smooth_cover(above, half);
    const std::vector<double> minus = smooth_cover(below, half);
    for (std::size_t t = 0; t < out.size(); ++t) out[t] -= minus[t];
    return out;
  }
};

// A vector in axes that rotate with the hips.
struct VectorChannel {
  std::array<Channel, 3> axes;

  explicit VectorChannel(std::size_t count)
      : axes{Channel(count), Channel(count), Channel(count)} {}
  void set(std::size_t t, const glm::dvec3& way) {
    for (int i = 0; i < 3; ++i) axes[slot_of_side(i)].set(t, way[i]);
  }
  [[nodiscard]] std::vector<glm::dvec3> covered(int half) const {
    std::vector<glm::dvec3> out(axes[0].above.size(), glm::dvec3(0.0));
    for (int i = 0; i < 3; ++i) {
      const std::vector<double> values = axes[slot_of_side(i)].covered(half);
      for (std::size_t t = 0; t < out.size(); ++t) out[t][i] = values[t];
    }
    return out;
  }
};

glm::dvec3 greater_by_axis(const glm::dvec3& a, const glm::dvec3& b) {
  glm::dvec3 out = a;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(b[i]) > std::abs(a[i])) out[i] = b[i];
  }
  return out;
}

// Errors of all frames. Vectors are in axes that rotate with the hips.
struct Missing {
  struct Arm {
    VectorChannel turn;
    Channel longer;
    Channel swivel;
    Channel rise;

    explicit Arm(std::size_t count)
        : turn(count), longer(count), swivel(count), rise(count) {}
  };
  std::array<Arm, 2> arms;
  // Displacements common to both wrists, where hands are on each other. [m]
  VectorChannel common;
  double max_depth_m = 0.0;
  std::optional<int> worst_frame{};
  double sum_m = 0.0;  // Sum over frames and arms, to judge the effect of a pass.

  explicit Missing(std::size_t count) : arms{Arm(count), Arm(count)}, common(count) {}
};

Missing missing_of(const Clearing& clearing,
                   const HandHolds& holds,
                   const std::vector<glm::dquat>& world_from_axes,
                   const ArmShifts& shifts) {
  const std::size_t count = clearing.arms.count();
  Missing out(count);
  for (std::size_t t = 0; t < count; ++t) {
    const glm::dquat axes_from_world = glm::conjugate(world_from_axes[t]);
    glm::dvec3 both(0.0);
    for (int side = 0; side < 2; ++side) {
      if (!clearing.arms.has(side) || !clearing.source_arms.has(side)) continue;
      const ArmShift& now = shifts[slot_of_side(side)][t];
      const ArmPenetration penetration = clearing.penetration(t, side, now);
      out.arms[slot_of_side(side)].rise.set(t, penetration.rise_m);
      const double max_depth_m = std::max(penetration.max_depth_m, penetration.rise_m);
      if (max_depth_m <= 0.0) continue;
      out.sum_m += max_depth_m;
      if (max_depth_m > out.max_depth_m) {
        out.max_depth_m = max_depth_m;
        out.worst_frame = static_cast<int>(t);
      }
      const ArmShift answer = clearing.answer(t, side, now, penetration);
      const Turn turn = turn_of(
          clearing.arms.limb(side), clearing.arms.places(t, side, now), answer.wrist_m);
      const double free = 1.0 - holds.hand[slot_of_side(side)][t];
      Missing::Arm& arm = out.arms[slot_of_side(side)];
      arm.turn.set(t, free * (axes_from_world * turn.turn));
      arm.longer.set(t, free * turn.longer_m);
      arm.swivel.set(t, answer.swivel_rad);
      both = greater_by_axis(both, axes_from_world * answer.wrist_m);
    }
    out.common.set(t, holds.hands[t] * both);
  }
  return out;
}

void add_covered(const Clearing& clearing,
                 const HandHolds& holds,
                 const std::vector<glm::dquat>& world_from_axes,
                 const Missing& missing,
                 int half,
                 ArmShifts& shifts) {
  const std::vector<glm::dvec3> together = missing.common.covered(half);
  for (int side = 0; side < 2; ++side) {
    if (!clearing.arms.has(side)) continue;
    const Missing::Arm& arm = missing.arms[slot_of_side(side)];
    const std::vector<glm::dvec3> turn = arm.turn.covered(half);
    const std::vector<double> longer_m = arm.longer.covered(half);
    const std::vector<double> swivel_rad = arm.swivel.covered(half);
    const std::vector<double> rise_m = arm.rise.covered(half);
    for (std::size_t t = 0; t < turn.size(); ++t) {
      ArmShift& shift = shifts[slot_of_side(side)][t];
      const double joined = holds.hands[t];
      const double free = 1.0 - holds.hand[slot_of_side(side)][t];
      const double both_free = free * (1.0 - holds.hand[slot_of_side(1 - side)][t]);
      const double alone = (1.0 - joined) * free;
      const Turn own{alone * (world_from_axes[t] * turn[t]), alone * longer_m[t]};
      const glm::dvec3 way = way_of(clearing.arms.places(t, side, shift), own) +
                             joined * both_free * (world_from_axes[t] * together[t]);
      shift.wrist_m += way + glm::dvec3(0.0, rise_m[t], 0.0);
      shift.swivel_rad += swivel_rad[t];
    }
  }
}

// Raises hands that are still in the floor: a few passes for this alone, regardless of
// the body.
void lift_hands(const Clearing& clearing, int half, double enough_m, ArmShifts& shifts) {
  constexpr int kMaxPasses = 6;
  for (int side = 0; side < 2; ++side) {
    if (!clearing.arms.has(side) || !clearing.source_arms.has(side)) continue;
    std::vector<ArmShift>& shift = shifts[slot_of_side(side)];
    for (int pass = 0; pass < kMaxPasses; ++pass) {
      std::vector<double> needed_m;
      for (std::size_t t = 0; t < shift.size(); ++t) {
        needed_m.push_back(clearing.penetration(t, side, shift[t]).rise_m);
      }
      if (*std::max_element(needed_m.begin(), needed_m.end()) <= enough_m) break;
      const std::vector<double> rise_m = smooth_cover(needed_m, half);
      for (std::size_t t = 0; t < shift.size(); ++t) shift[t].wrist_m.y += rise_m[t];
    }
  }
}

}  // namespace

ArmCollisionReport resolve_arm_collisions(const VolumeInMotion& source,
                                          const VolumeInMotion& avatar,
                                          const Arms& arms,
                                          FrameRate rate,
                                          const WorldScale& world,
                                          const HandHolds& holds,
                                          const ArmCollisionOptions& options,
                                          ArmShifts& shifts) {
  const std::size_t count = avatar.frames.count();
  MAREY_ASSERT(source.frames.count() == count);
  MAREY_ASSERT(holds.hands.size() == count && shifts[0].size() == count);
  ArmCollisionReport report;
  if (count == 0) return report;
  const Arms source_arms(source.frames, source.map);
  Clearing clearing{source, avatar, source_arms, arms, options.slack_m, {}, {}};
  if (options.over_floor) {
    clearing.source_floor_m = -world.rise_m / world.scale;
    clearing.floor_m = 0.0;
  }
  std::vector<glm::dquat> world_from_axes;
  const JointIndex hips = avatar.map.hips();
  for (std::size_t t = 0; t < count; ++t) {
    world_from_axes.push_back(rotation_from_t_pose(avatar.map, avatar.frames[t], hips));
  }
  const double half_frames =
      std::clamp(0.5 * options.anticipation_s * rate.hz, 1.0, static_cast<double>(count));
  const int half = static_cast<int>(std::lround(half_frames));
  const ArmShifts before = shifts;
  ArmShifts best = shifts;
  double min_m = std::numeric_limits<double>::max();
  for (;; ++report.passes) {
    const Missing missing = missing_of(clearing, holds, world_from_axes, shifts);
    if (report.passes == 0) report.max_depth_before_m = missing.max_depth_m;
    // Penetrations that held hands cause remain after any number of passes.
    const bool better = missing.sum_m < min_m;
    const bool goes_on = missing.sum_m < kWorthIt * min_m;
    if (better) {
      min_m = missing.sum_m;
      best = shifts;
      report.max_depth_after_m = missing.max_depth_m;
      report.worst_frame = missing.worst_frame;
    }
    const bool enough = missing.max_depth_m <= options.slack_m + options.good_enough_m;
    if (enough || !goes_on || report.passes == options.max_passes) break;
    add_covered(clearing, holds, world_from_axes, missing, half, shifts);
  }
  for (int side = 0; side < 2; ++side) {
    if (!arms.has(side)) continue;
    const auto i = static_cast<std::size_t>(side);
    for (std::size_t t = 0; t < count; ++t) {
      const ArmShift& from = before[i][t];
      const ArmShift out = limited_shift(
          {best[i][t].wrist_m - from.wrist_m, best[i][t].swivel_rad - from.swivel_rad},
          arms.limb(side).length_m());
      shifts[i][t] = {from.wrist_m + out.wrist_m, from.swivel_rad + out.swivel_rad};
    }
  }
  const Missing left = missing_of(clearing, holds, world_from_axes, shifts);
  report.max_depth_after_m = left.max_depth_m;
  report.worst_frame = left.worst_frame;
  lift_hands(clearing, half, options.slack_m, shifts);
  return report;
}

}  // namespace marey::retarget
