// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/hold_feet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "edit/state/bend_limb.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "retarget/base/smooth_cover.h"
#include "retarget/base/triweight.h"

namespace marey::edit {
namespace {

constexpr double kFade_s = 0.08;  // Half of the fade: smooth_cover() reaches twice that.
constexpr double kLower_s = 0.1;  // The root is lowered this long before.
constexpr double kMaxExtension =
    0.999;  // Maximum extension of a leg, unless it was straighter before.
constexpr double kHeldRounding_m = 1e-12;

/// Target of one foot in one frame, and the longest leg that may reach it.
struct HeldFoot {
  glm::dvec3 ankle_in_world{0.0};
  glm::dquat world_from_foot{1.0, 0.0, 0.0, 0.0};
  double max_reach_m = 0.0;
};

glm::dquat turned_towards(const glm::dquat& from, glm::dquat to, double share) {
  if (share >= 1.0) return to;
  if (glm::dot(from, to) < 0.0) to = -to;
  return glm::normalize(glm::slerp(from, to, share));
}

/// Returns the distance by which the hip must be lowered so that the ankle is within
/// reach. 0 if no height suffices.
double drop_m(const glm::dvec3& hip, const HeldFoot& foot) {
  const glm::dvec3 way = hip - foot.ankle_in_world;
  const double level = way.x * way.x + way.z * way.z;
  const double square = foot.max_reach_m * foot.max_reach_m;
  if (level + way.y * way.y <= square) return 0.0;
  return std::max(0.0, way.y - std::sqrt(std::max(0.0, square - level)));
}

/// Returns a smooth curve that is nowhere below `needed`: maximum, then triweight average
/// over half of that window. The window shrinks towards the ends that `frames` shares
/// with frames that do not change. Each averaged value is a maximum over a window that
/// contains the frame itself, because the window shrinks by at most one frame per frame.
std::vector<double> cover_within(const std::vector<double>& needed,
                                 const FrameRange& frames,
                                 int half) {
  const int count = static_cast<int>(needed.size());
  const auto room = [&](int frame) {
    int out = half;
    if (frames.first > 0) out = std::min(out, frame - frames.first);
    if (frames.last + 1 < count) out = std::min(out, frames.last - frame);
    return std::max(0, out);
  };
  std::vector<double> highest(needed.size(), 0.0);
  for (int t = frames.first; t <= frames.last; ++t) {
    for (int k = -room(t); k <= room(t); ++k) {
      const int from = std::clamp(t + k, frames.first, frames.last);
      double& out = highest[static_cast<std::size_t>(t)];
      out = std::max(out, needed[static_cast<std::size_t>(from)]);
    }
  }
  std::vector<double> out(needed.size(), 0.0);
  for (int t = frames.first; t <= frames.last; ++t) {
    const int reach = room(t) / 2;
    const std::vector<double> weights = retarget::triweight_weights(reach);
    double sum = 0.0;
    double total = 0.0;
    for (int k = -reach; k <= reach; ++k) {
      const int from = std::clamp(t + k, frames.first, frames.last);
      const double weight = weights[static_cast<std::size_t>(k + reach)];
      sum += weight * highest[static_cast<std::size_t>(from)];
      total += weight;
    }
    out[static_cast<std::size_t>(t)] = sum / total;
  }
  return out;
}

/// Plans and applies hold_feet().
class FeetHolder {
 public:
  FeetHolder(const EditState& state, const Motion& before, const KeptFeet& kept)
      : state_(state), before_(before), kept_(kept) {
    const std::size_t joints = state.motion.skeleton.joints.size();
    old_joints_.resize(joints);
    new_joints_.resize(joints);
    for (auto& feet : feet_) feet.resize(before.poses.size());
    needed_m_.resize(before.poses.size(), 0.0);
  }

  void plan(int frame, const Pose& after) {
    const auto t = static_cast<std::size_t>(frame);
    const Skeleton& skeleton = state_.motion.skeleton;
    world_from_joints(skeleton, before_.poses[t], old_joints_);
    world_from_joints(skeleton, after, new_joints_);
    for (int side = 0; side < 2; ++side) {
      const auto s = static_cast<std::size_t>(side);
      const double share = kept_[s][t];
      if (share <= 0.0) continue;
      const retarget::LimbMap& leg = state_.map.leg(side);
      const RigidTransform& old_foot = old_joints_[index(leg.end)];
      const RigidTransform& new_foot = new_joints_[index(leg.end)];
      HeldFoot foot;
      foot.ankle_in_world =
          share >= 1.0 ? old_foot.translation
                       : glm::mix(new_foot.translation, old_foot.translation, share);
      foot.world_from_foot = turned_towards(new_foot.rotation, old_foot.rotation, share);
      const double was_m =
          glm::distance(old_foot.translation, old_joints_[index(leg.upper)].translation);
      foot.max_reach_m = std::max(kMaxExtension * leg.length_m(), was_m);
      needed_m_[t] = std::max(
          needed_m_[t], share * drop_m(new_joints_[index(leg.upper)].translation, foot));
      feet_[s][t] = foot;
    }
  }

  HoldFeetReport apply(const FrameRange& frames, Motion& after) {
    HoldFeetReport report;
    const int half = std::max(
        1, static_cast<int>(std::lround(2.0 * kLower_s * state_.motion.rate.hz)));
    const std::vector<double> lowered_m = cover_within(needed_m_, frames, half);
    LimbBender bender(state_.motion.skeleton, state_.map);
    for (int frame = frames.first; frame <= frames.last; ++frame) {
      const auto t = static_cast<std::size_t>(frame);
      after.poses[t].root_in_world.y -= lowered_m[t];
      report.lowered_m = std::max(report.lowered_m, lowered_m[t]);
      for (int side = 0; side < 2; ++side) place(side, frame, bender, report, after);
    }
    return report;
  }

 private:
  void place(int side,
             int frame,
             LimbBender& bender,
             HoldFeetReport& report,
             Motion& after) const {
    const auto s = static_cast<std::size_t>(side);
    const auto t = static_cast<std::size_t>(frame);
    if (kept_[s][t] <= 0.0) return;
    Pose& pose = after.poses[t];
    const HeldFoot& foot = feet_[s][t];
    const double missed_m =
        bender.move_end(2 + side, foot.ankle_in_world, foot.world_from_foot, pose);
    const HumanBone toes = side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
    if (const auto joint = state_.map.joint_of[marey::index(toes)]) {
      glm::dquat& rotation = pose.parent_from_joint[index(*joint)];
      rotation = turned_towards(
          rotation, before_.poses[t].parent_from_joint[index(*joint)], kept_[s][t]);
    }
    if (kept_[s][t] * missed_m <= report.missed_m + kHeldRounding_m) return;
    report.missed_m = kept_[s][t] * missed_m;
    report.missed_frame = frame;
  }

  const EditState& state_;
  const Motion& before_;
  const KeptFeet& kept_;
  std::vector<RigidTransform> old_joints_;
  std::vector<RigidTransform> new_joints_;
  std::array<std::vector<HeldFoot>, 2> feet_;
  std::vector<double> needed_m_;
};

}  // namespace

KeptFeet keep_standing_feet(const EditState& state) {
  const int half =
      std::max(1, static_cast<int>(std::lround(kFade_s * state.motion.rate.hz)));
  KeptFeet out;
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<double> stands(state.motion.poses.size(), 0.0);
    for (const FrameRange& run : state.contacts.feet[side].stance) {
      std::fill(stands.begin() + run.first, stands.begin() + run.last + 1, 1.0);
    }
    out[side] = retarget::smooth_cover(stands, half);
    for (std::size_t t = 0; t < stands.size(); ++t) {
      out[side][t] = stands[t] > 0.0 ? 1.0 : std::min(1.0, out[side][t]);
    }
  }
  return out;
}

KeptFeet keep_both_feet(const EditState& state) {
  KeptFeet out;
  for (auto& foot : out) foot.assign(state.motion.poses.size(), 1.0);
  return out;
}

HoldFeetReport hold_feet(const EditState& state,
                         const Motion& before,
                         const FrameRange& frames,
                         const KeptFeet& kept,
                         Motion& after) {
  MAREY_ASSERT(before.poses.size() == after.poses.size());
  MAREY_ASSERT(kept[0].size() == after.poses.size());
  if (frames.last < frames.first) return {};
  FeetHolder holder(state, before, kept);
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    holder.plan(frame, after.poses[static_cast<std::size_t>(frame)]);
  }
  return holder.apply(frames, after);
}

}  // namespace marey::edit
