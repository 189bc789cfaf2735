// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/support_frame.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/frame_range.h"
#include "core/base/smooth_step.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::retarget {
namespace {

// A sole's half length and half breadth, as multiples of the distance from ankle to ball.
// They define a measure for comparing two bodies, not the sole of either: rounded from
// about 1.6 times that length and kBreadthInFoot (retarget/body/foot_shape.h).
constexpr double kHalfLength = 0.8;
constexpr double kHalfBreadth = 0.3;

glm::dvec2 aside_of(const glm::dvec2& ahead) {
  return {ahead.y, -ahead.x};
}

// Aside and ahead of the middle. [m]
glm::dvec2 in_frame(const SupportFrame& frame, const glm::dvec2& p) {
  const glm::dvec2 off = p - frame.centre;
  return {glm::dot(off, aside_of(frame.ahead)), glm::dot(off, frame.ahead)};
}

std::vector<double> ramps(const std::vector<FrameRange>& runs, int count, double ramp) {
  std::vector<double> out(static_cast<std::size_t>(count), 0.0);
  for (const FrameRange& run : runs) {
    for (int t = run.first; t <= run.last; ++t) {
      const double in = run.first == 0 ? 1.0 : (t - run.first + 1) / ramp;
      const double left = run.last == count - 1 ? 1.0 : (run.last - t + 1) / ramp;
      out[static_cast<std::size_t>(t)] = smooth_step(in) * smooth_step(left);
    }
  }
  return out;
}

}  // namespace

std::vector<SupportShares> support_shares(const Contacts& contacts,
                                          FrameRate rate,
                                          double ramp_s) {
  // A small total is divided with a regularizer, so that rounding does not decide.
  constexpr double kRegularizer = 1e-6;
  const double ramp = std::max(1.0, ramp_s * rate.hz);
  const int count = contacts.frame_count;
  std::vector<SupportShares> out(static_cast<std::size_t>(count));
  std::array<std::vector<double>, 2> bears;
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContacts& foot = contacts.feet[side];
    bears[side] = ramps(foot.stance, count, ramp);
    const std::vector<double> heel = ramps(foot.heel, count, ramp);
    const std::vector<double> ball = ramps(foot.ball, count, ramp);
    for (std::size_t t = 0; t < out.size(); ++t) {
      out[t].ball[side] =
          (ball[t] + kRegularizer) / (heel[t] + ball[t] + 2.0 * kRegularizer);
    }
  }
  for (std::size_t t = 0; t < out.size(); ++t) {
    const double left = bears[0][t];
    const double right = bears[1][t];
    const double both = left + right;
    if (both > 0.0) out[t].foot = {left / both, right / both};
    out[t].present = 1.0 - (1.0 - left) * (1.0 - right);
  }
  return out;
}

SupportFrame support_frame(const BodyMap& map,
                           std::span<const RigidTransform> world_from_joint,
                           const SupportShares& shares) {
  SupportFrame out;
  out.centre = glm::dvec2(0.0);
  glm::dvec2 ahead(0.0);
  std::array<glm::dvec2, 2> middle{};
  double length_m = 0.0;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    const JointIndex joint = map.leg(side).end;
    const RigidTransform& ankle = world_from_joint[index(joint)];
    const glm::dvec3 ball = rotation_from_t_pose(map, world_from_joint, joint) *
                            map.feet[s].ball_from_ankle_in_t_pose;
    const glm::dvec2 foot(ball.x, ball.z);
    middle[s] =
        glm::dvec2(ankle.translation.x, ankle.translation.z) + shares.ball[s] * foot;
    out.centre += shares.foot[s] * middle[s];
    length_m += shares.foot[s] * glm::length(map.feet[s].ball_from_ankle_in_t_pose);
    ahead += shares.foot[s] * foot / std::max(glm::length(foot), 1e-9);
  }
  if (glm::length(ahead) > 1e-3) out.ahead = glm::normalize(ahead);
  // Both feet by their shares of the load: the whole area between them if they are equal.
  const double both = 4.0 * shares.foot[0] * shares.foot[1];
  const glm::dvec2 apart = 0.5 * both * (middle[1] - middle[0]);
  out.half_size_m = {
      kHalfBreadth * length_m + std::abs(glm::dot(apart, aside_of(out.ahead))),
      kHalfLength * length_m + std::abs(glm::dot(apart, out.ahead))};
  return out;
}

double share_of_half(const SupportFrame& support, const glm::dvec2& p) {
  const glm::dvec2 at =
      in_frame(support, p) / glm::max(support.half_size_m, glm::dvec2(1e-9));
  return std::max(std::abs(at.x), std::abs(at.y));
}

glm::dvec2 corresponding(const SupportFrame& from,
                         const SupportFrame& to,
                         const glm::dvec2& p,
                         double beyond_scale) {
  const glm::dvec2 at = in_frame(from, p);
  const glm::dvec2 within = glm::clamp(at, -from.half_size_m, from.half_size_m);
  const glm::dvec2 there =
      within * (to.half_size_m / glm::max(from.half_size_m, glm::dvec2(1e-9))) +
      beyond_scale * (at - within);
  return to.centre + there.x * aside_of(to.ahead) + there.y * to.ahead;
}

}  // namespace marey::retarget
