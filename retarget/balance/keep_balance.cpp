// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/balance/keep_balance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/human/centre_of_mass.h"
#include "core/pose.h"
#include "core/base/smooth_step.h"
#include "retarget/base/triweight.h"

namespace marey::retarget {
namespace {

// Weight of the frames that do not count, relative to a frame without error. Where no
// frame is still for longer than the window, the correction fades to zero.
constexpr double kAbsent = 0.02;
constexpr double kSpeedOver_s = 0.05;  // Half width.
// Larger shifts of the hips look unnatural.
constexpr double kMaxInLegs = 0.3;

glm::dvec2 above(const glm::dvec3& p) {
  return {p.x, p.z};
}

// Limits a vector smoothly to `max_m`; short vectors are unchanged.
glm::dvec2 limited(const glm::dvec2& way_m, double max_m) {
  return way_m / std::pow(1.0 + std::pow(glm::length(way_m) / max_m, 8.0), 0.125);
}

// Averages the error over the still frames within the window around each frame.
void low_pass(std::span<const glm::dvec2> missing,
              std::span<const double> still,
              std::span<const double> weights,
              std::span<glm::dvec2> out) {
  const int count = static_cast<int>(missing.size());
  const int half = static_cast<int>(weights.size()) / 2;
  for (int t = 0; t < count; ++t) {
    glm::dvec2 sum(0.0);
    double sum_of_weights = 0.0;
    for (int k = -half; k <= half; ++k) {
      const auto i = static_cast<std::size_t>(std::clamp(t + k, 0, count - 1));
      const double weight = weights[static_cast<std::size_t>(k + half)];
      sum += weight * still[i] * missing[i];
      sum_of_weights += weight * (still[i] + kAbsent * (1.0 - still[i]));
    }
    out[static_cast<std::size_t>(t)] = sum / sum_of_weights;
  }
}

// Returns for each frame how close it is to standing still over its support: 0 to 1.
std::vector<double> stillness(const BalanceReference& reference,
                              FrameRate rate,
                              const BalanceOptions& options) {
  const auto count = static_cast<int>(reference.com_xz_m.size());
  const int reach = std::max(1, static_cast<int>(std::lround(kSpeedOver_s * rate.hz)));
  std::vector<double> out;
  for (int t = 0; t < count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const int from = std::max(0, t - reach);
    const int to = std::min(count - 1, t + reach);
    const double way_m = glm::length(reference.com_xz_m[static_cast<std::size_t>(to)] -
                                     reference.com_xz_m[static_cast<std::size_t>(from)]);
    const double speed = to > from ? way_m * rate.hz / (to - from) : 0.0;
    const double moves = (speed / reference.leg_length_m - options.still_legs_per_s) /
                         (options.moving_legs_per_s - options.still_legs_per_s);
    const double outside =
        (share_of_half(reference.support[i], reference.com_xz_m[i]) - 1.0) /
        (options.max_offset_in_halves - 1.0);
    out.push_back(reference.shares[i].present * (1.0 - smooth_step(moves)) *
                  (1.0 - smooth_step(outside)));
  }
  return out;
}

double mean_length(std::span<const glm::dvec2> missing, std::span<const double> still) {
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t t = 0; t < missing.size(); ++t) {
    sum += still[t] * glm::length(missing[t]);
    weights += still[t];
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

}  // namespace

BalanceReference balance_reference(const Skeleton& body,
                                   const BodyMap& map,
                                   std::span<const PointMass> masses,
                                   const Contacts& contacts,
                                   FrameRate rate,
                                   std::span<const NormalizedPose> poses,
                                   const BalanceOptions& options) {
  BalanceReference out;
  out.shares = support_shares(contacts, rate, options.ramp_s);
  out.leg_length_m = map.leg_length_m;
  MAREY_ASSERT(out.shares.size() == poses.size());
  std::vector<RigidTransform> world_from_joint(body.joints.size());
  Pose scratch;
  for (std::size_t t = 0; t < poses.size(); ++t) {
    expand(poses[t], body, map, world_from_joint, scratch);
    out.support.push_back(support_frame(map, world_from_joint, out.shares[t]));
    out.com_xz_m.push_back(above(centre_of_mass(masses, world_from_joint)));
  }
  out.still = stillness(out, rate, options);
  return out;
}

KeptBalance keep_balance(const BalanceReference& reference,
                         const BalancedBody& body,
                         const Contacts& contacts,
                         FrameRate rate,
                         double beyond_scale,
                         std::span<NormalizedPose> poses,
                         const BalanceOptions& options,
                         const GroundOptions& ground) {
  MAREY_ASSERT(reference.com_xz_m.size() == poses.size());
  KeptBalance out;
  if (poses.empty()) return out;
  const std::vector<NormalizedPose> first(poses.begin(), poses.end());
  const auto feet =
      plan_level_feet(body.skeleton, body.map, contacts, rate, first, ground.feet);
  const double unit_m = root_unit_m(body.map, first[0].root_normalization);
  const double half_frames = std::clamp(
      0.5 * options.low_pass_s * rate.hz, 1.0, static_cast<double>(poses.size()));
  const std::vector<double> weights =
      triweight_weights(static_cast<int>(std::lround(half_frames)));
  const double max_m = kMaxInLegs * body.map.leg_length_m;
  std::vector<glm::dvec2> moved(poses.size(), glm::dvec2(0.0));
  std::vector<glm::dvec2> missing(poses.size());
  std::vector<glm::dvec2> added(poses.size());
  std::vector<RigidTransform> world_from_joint(body.skeleton.joints.size());
  Pose scratch;
  for (int pass = 0;; ++pass) {
    for (std::size_t t = 0; t < poses.size(); ++t) {
      poses[t] = first[t];
      const glm::dvec2 by_m = limited(moved[t], max_m);
      poses[t].root += glm::dvec3(by_m.x, 0.0, by_m.y) / unit_m;
    }
    out.ground =
        settle_on_feet(body.skeleton, body.map, contacts, rate, poses, feet, ground);
    for (std::size_t t = 0; t < poses.size(); ++t) {
      expand(poses[t], body.skeleton, body.map, world_from_joint, scratch);
      const SupportFrame support =
          support_frame(body.map, world_from_joint, reference.shares[t]);
      missing[t] =
          corresponding(
              reference.support[t], support, reference.com_xz_m[t], beyond_scale) -
          above(centre_of_mass(body.masses, world_from_joint));
    }
    out.mean_off_m = mean_length(missing, reference.still);
    if (pass == 0) out.mean_off_before_m = out.mean_off_m;
    if (pass == options.passes) break;
    low_pass(missing, reference.still, weights, added);
    for (std::size_t t = 0; t < poses.size(); ++t) moved[t] += added[t];
  }
  for (const glm::dvec2& by_m : moved) {
    out.max_shift_m = std::max(out.max_shift_m, glm::length(limited(by_m, max_m)));
  }
  return out;
}

}  // namespace marey::retarget
