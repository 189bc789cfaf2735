// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/plant_near.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "retarget/base/smooth_step.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/feet/adapt_to_ground.h"

namespace marey::edit {
namespace {

using retarget::FootContacts;
using retarget::FootPlace;
using PlannedFeet = std::array<std::vector<std::optional<FootPlace>>, 2>;

// A swing shorter than this has no room for a fade. [s]
constexpr double kMinFade_s = 0.15;
// Fade of a foot that does not stand again. [s]
constexpr double kFreeFade_s = 0.4;

bool overlaps(const FrameRange& a, const FrameRange& b) {
  return a.first <= b.last && b.first <= a.last;
}

// Returns the indices of the first and the last stance to plant; nullopt if there is
// none.
std::optional<std::pair<std::size_t, std::size_t>> stances_near(
    const std::vector<FrameRange>& stances, const FrameRange& zone, double min_gap) {
  std::optional<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t k = 0; k < stances.size(); ++k) {
    if (!overlaps(stances[k], zone)) continue;
    if (!out) out = {k, k};
    out->second = k;
  }
  if (!out) return out;
  const auto gap = [&](std::size_t k) { return stances[k + 1].first - stances[k].last; };
  while (out->first > 0 && gap(out->first - 1) < min_gap) --out->first;
  while (out->second + 1 < stances.size() && gap(out->second) < min_gap) ++out->second;
  return out;
}

std::vector<FrameRange> runs_within(const std::vector<FrameRange>& runs,
                                    const FrameRange& within) {
  std::vector<FrameRange> out;
  for (const FrameRange& run : runs) {
    if (overlaps(run, within)) out.push_back(run);
  }
  return out;
}

// One foot's stances to plant, and the frames over which its displacement fades.
struct NearStances {
  FrameRange planted;
  int fade_from = 0;  // The displacement is 0 here and before.
  int fade_to = 0;

  [[nodiscard]] double share(int frame) const {
    if (frame < planted.first) {
      return retarget::smooth_step(static_cast<double>(frame - fade_from) /
                                   std::max(1, planted.first - fade_from));
    }
    if (frame > planted.last) {
      return retarget::smooth_step(static_cast<double>(fade_to - frame) /
                                   std::max(1, fade_to - planted.last));
    }
    return 1.0;
  }
};

// Keeps the contacts of the planted stances alone.
std::optional<NearStances> restrict_contacts(FootContacts& foot,
                                             const FrameRange& zone,
                                             double hz) {
  const auto chosen = stances_near(foot.stance, zone, kMinFade_s * hz);
  if (!chosen) {
    foot.heel.clear();
    foot.ball.clear();
    foot.stance.clear();
    foot.heel_up.clear();
    return std::nullopt;
  }
  const auto [first, last] = *chosen;
  NearStances out;
  out.planted = {foot.stance[first].first, foot.stance[last].last};
  const int fade = static_cast<int>(std::ceil(kFreeFade_s * hz));
  out.fade_from = first > 0 ? foot.stance[first - 1].last : out.planted.first - fade;
  out.fade_to = last + 1 < foot.stance.size() ? foot.stance[last + 1].first
                                              : out.planted.last + fade;
  for (auto* runs : {&foot.heel, &foot.ball, &foot.stance, &foot.heel_up}) {
    *runs = runs_within(*runs, out.planted);
  }
  return out;
}

std::vector<retarget::NormalizedPose> level_poses(const EditState& state, double rise_m) {
  std::vector<RigidTransform> joints(state.motion.skeleton.joints.size());
  std::vector<retarget::NormalizedPose> out(state.motion.poses.size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    world_from_joints(state.motion.skeleton, state.motion.poses[t], joints);
    retarget::normalize(state.map, joints, out[t], retarget::RootNormalization::kNone);
    out[t].root.y += rise_m;
  }
  return out;
}

FootPlace between_places(const FootPlace& a, const FootPlace& b, double share) {
  return {glm::mix(a.ankle_in_world, b.ankle_in_world, share),
          glm::normalize(glm::slerp(a.foot, b.foot, share)),
          glm::normalize(glm::slerp(a.toes, b.toes, share))};
}

// Returns one foot where it is planted, fading to where it was.
std::vector<std::optional<FootPlace>> faded_foot(const NearStances& near,
                                                 const std::vector<FootPlace>& before,
                                                 const std::vector<FootPlace>& planned) {
  std::vector<std::optional<FootPlace>> out(before.size());
  for (std::size_t t = 0; t < before.size(); ++t) {
    const double share = near.share(static_cast<int>(t));
    if (share > 0.0) out[t] = between_places(before[t], planned[t], share);
  }
  return out;
}

FrameRange changed_frames(const PlannedFeet& feet) {
  FrameRange out{0, -1};
  for (const auto& path : feet) {
    for (std::size_t t = 0; t < path.size(); ++t) {
      if (!path[t]) continue;
      const int frame = static_cast<int>(t);
      out = out.last < out.first
                ? FrameRange{frame, frame}
                : FrameRange{std::min(out.first, frame), std::max(out.last, frame)};
    }
  }
  return out;
}

}  // namespace

PlantNearReport plant_feet_near(EditState& state, const FrameRange& zone) {
  MAREY_ASSERT(zone.first >= 0 && zone.first <= zone.last &&
               zone.last < state.frame_count());
  retarget::Contacts contacts = state.contacts;
  std::array<std::optional<NearStances>, 2> near;
  for (std::size_t side = 0; side < 2; ++side) {
    near[side] = restrict_contacts(contacts.feet[side], zone, state.motion.rate.hz);
  }
  PlantNearReport report;
  report.changed = {0, -1};
  if (!near[0] && !near[1]) return report;
  const double rise_m =
      retarget::standing_rise_m(state.map, state.contacts, state.map, 1.0);
  const auto poses = level_poses(state, rise_m);
  const auto planned = retarget::plan_level_feet(
      state.motion.skeleton, state.map, contacts, state.motion.rate, poses);
  PlannedFeet feet;
  for (std::size_t side = 0; side < 2; ++side) {
    feet[side].resize(poses.size());
    if (!near[side]) continue;
    auto lowered = planned[side];
    for (FootPlace& place : lowered) place.ankle_in_world.y -= rise_m;
    feet[side] =
        faded_foot(*near[side], foot_places(state, static_cast<int>(side)), lowered);
  }
  report.changed = changed_frames(feet);
  report.plant = set_feet(state, feet);
  return report;
}

}  // namespace marey::edit
