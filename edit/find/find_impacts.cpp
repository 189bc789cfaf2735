// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/find_impacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/pose.h"
#include "retarget/feet/leg_placement.h"

namespace marey::edit {
namespace {

constexpr double kImpact_m_per_s = 1.0;

int frames_of(double time_s, double hz) {
  return std::max(1, static_cast<int>(std::lround(time_s * hz)));
}

std::vector<double> heights_of(const EditState& state, JointIndex joint) {
  std::vector<double> out;
  std::vector<RigidTransform> joints(state.motion.skeleton.joints.size());
  for (const Pose& pose : state.motion.poses) {
    world_from_joints(state.motion.skeleton, pose, joints);
    out.push_back(joints[index(joint)].translation.y);
  }
  return out;
}

struct FootImpact {
  int frame = 0;
  double change_m_per_s = 0.0;
};

/// Returns the hardest change of velocity near the edge of a contact.
FootImpact impact_at(const std::vector<double>& height, int edge, double hz) {
  constexpr double kReach_s = 0.04;
  constexpr double kMean_s = 0.025;
  const int reach = frames_of(kReach_s, hz);
  const int span = frames_of(kMean_s, hz);
  const int last = static_cast<int>(height.size()) - 1;
  const auto at = [&](int frame) { return height[static_cast<std::size_t>(frame)]; };
  FootImpact out{edge, 0.0};
  for (int frame = std::max(edge - reach, span);
       frame <= std::min(edge + reach, last - span);
       ++frame) {
    const double change =
        std::abs(at(frame + span) - 2.0 * at(frame) + at(frame - span)) * hz / span;
    if (change > out.change_m_per_s) out = {frame, change};
  }
  return out;
}

void add_impacts(const std::vector<double>& height,
                 const std::vector<FrameRange>& runs,
                 double hz,
                 std::vector<FootImpact>& out) {
  const int last = static_cast<int>(height.size()) - 1;
  for (const FrameRange& run : runs) {
    for (const int edge : {run.first, run.last}) {
      if (edge == 0 || edge == last) continue;
      const FootImpact impact = impact_at(height, edge, hz);
      if (impact.change_m_per_s > kImpact_m_per_s) out.push_back(impact);
    }
  }
}

}  // namespace

std::vector<int> find_impacts(const EditState& state, int side) {
  const double hz = state.motion.rate.hz;
  const auto& foot = state.contacts.feet[static_cast<std::size_t>(side)];
  std::vector<FootImpact> found;
  add_impacts(heights_of(state, state.map.leg(side).end), foot.heel, hz, found);
  const auto toes = state.map.joint_of[marey::index(retarget::toes_bone(side))];
  if (toes) add_impacts(heights_of(state, *toes), foot.ball, hz, found);
  std::sort(found.begin(), found.end(), [](const FootImpact& a, const FootImpact& b) {
    return a.frame < b.frame;
  });
  constexpr double kApart_s = 0.05;
  std::vector<FootImpact> kept;
  for (const FootImpact& impact : found) {
    if (kept.empty() || impact.frame - kept.back().frame >= frames_of(kApart_s, hz)) {
      kept.push_back(impact);
    } else if (impact.change_m_per_s > kept.back().change_m_per_s) {
      kept.back() = impact;
    }
  }
  std::vector<int> out;
  out.reserve(kept.size());
  for (const FootImpact& impact : kept) out.push_back(impact.frame);
  return out;
}

}  // namespace marey::edit
