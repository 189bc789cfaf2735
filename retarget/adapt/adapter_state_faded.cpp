// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "retarget/adapt/adapter_state.h"
#include "core/base/smooth_step.h"
#include "retarget/constraints/activation.h"

/// Computes postures while constraints fade in or out, or while one control fades to the
/// other.
namespace marey::retarget {
namespace {

// A joint of a mean posture is clamped to its limits completely where every blended
// posture is within the limits to single precision, and not at all where one of them
// exceeds them by a degree or two.
constexpr double kWithin_rad = 1e-4;
constexpr double kBeyond_rad = 0.03;

float dot(const Quat<float>& a, const Quat<float>& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

// Rounds that correct the centre of mass of a mean; each leaves about a fifth. The number
// is fixed, because an early end would cause a jump.
constexpr int kRootRounds = 6;
// Smaller values are rounding errors, in units.
constexpr float kSettled = 2e-7F;
// In units of the precision of balance: no correction below the first value, full
// correction from the second on. A straight limb amplifies the smallest motion of its
// root.
constexpr double kNearEnough = 0.1;
constexpr double kWholly = 0.4;

}  // namespace

void AdapterState::mix(float share) {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    const Quat<float>& q = lanes.rotation[i];
    Quat<float>& sum = mixed_rotation[i];
    // Two quaternions represent a rotation; uses the one on the side of the sum. Nearly
    // equal rotations then never cancel, and the sum only grows. The first is on the
    // reference's side.
    const bool is_first = dot(sum, sum) <= 0.0F;
    const Quat<float>& like = is_first ? lanes.reference_rotation[i] : sum;
    const float sign = dot(q, like) < 0.0F ? -share : share;
    sum = {
        sum.w + sign * q.w, sum.x + sign * q.x, sum.y + sign * q.y, sum.z + sign * q.z};
    if (plan.limit_of[i] < 0 || j == 0) continue;
    const auto p = static_cast<std::size_t>(plan.parent[i]);
    const Quat<float> kept = limited(plan, lanes, j, lanes.rotation[p], q);
    mixed_beyond[i] = std::max(mixed_beyond[i], length(turn_left(q, kept)));
  }
  mixed_root += share * lanes.place[0];
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    LanePoint<float>& p = lanes.points[k];
    p.place = place_of(plan.points[k], p, lanes);
    mixed_left[k] += share * (target_of(plan.points[k], p, lanes) - p.place);
  }
  if (!shape().rows.balance) return;
  measure_balance(plan, lanes);
  mixed_com += share * lanes.com;
  mixed_com_target += share * lanes.com_target;
}

// Constraints fade between the postures without and with them. With activations 1 = a0 >
// a1 > ... > an > an+1 = 0 and the posture Si for all constraints with an activation of
// at least ai, the result is the mean of the Si with weights ai - ai+1. It is continuous
// in every activation, also where two activations cross, and exact where nothing fades
// (the Lovasz extension of the map from sets of constraints to postures). Targets that
// all the Si meet are then restored in the mean.
void AdapterState::solve_faded(LaneFigures<float>& figures) {
  const std::vector<double>& ramps = own_problem.ramps;
  for (Quat<float>& q : mixed_rotation) q = {0.0F, 0.0F, 0.0F, 0.0F};
  for (float& beyond : mixed_beyond) beyond = 0.0F;
  for (Vec3<float>& left : mixed_left) left = {0.0F, 0.0F, 0.0F};
  mixed_root = {0.0F, 0.0F, 0.0F};
  mixed_com = mixed_root;
  mixed_com_target = mixed_root;
  const auto add_all = [&](Control solved, double weight) {
    control = solved;
    double above = 1.0;
    for (std::size_t n = 0; n <= ramps.size(); ++n) {
      const double next = n < ramps.size() ? ramps[n] : 0.0;
      solve_for(n == 0 ? 1.0 : ramps[n - 1], figures);
      mix(static_cast<float>(weight * (above - next)));
      above = next;
    }
  };
  if (left_share > 0.0) add_all(left_control, left_share);
  add_all(options.control, 1.0 - left_share);
  std::vector<TargetNumbers>& targets = own_problem.numbers;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const double activation = own_problem.activations[k];
    targets[k].active = activation > kFirmActivation;
    firmness[k] = static_cast<float>(
        smooth_step((activation - kFirmActivation) / (1.0 - kFirmActivation)));
  }
  pack_targets(plan, body, origin_in_world, targets, own_problem.targets);
  load_targets(plan, own_problem.targets.data(), 0, lanes);
  take_mean();
  close_mean();
  if (shape().rows.balance) settle_mean();
  // aim_at_mean() has overwritten the target rotations.
  load_targets(plan, own_problem.targets.data(), 0, lanes);
  lanes.com_target = mixed_com_target;
  const auto last = static_cast<float>(shape().last_level);
  figures.balance = measure(plan, shape().rows.balance, last, lanes).balance;
}

// Computes the mean posture, within limits where the blended postures are.
void AdapterState::take_mean() {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    lanes.rotation[i] = normalized(mixed_rotation[i]);
    if (plan.limit_of[i] >= 0 && j != 0) {
      // The mean of two postures within a limit may exceed it. If one of them exceeds it
      // (possible for supports and references), the mean is not clamped.
      const auto p = static_cast<std::size_t>(plan.parent[i]);
      const Quat<float> kept =
          limited(plan, lanes, j, lanes.rotation[p], lanes.rotation[i]);
      const auto keeps = static_cast<float>(
          smooth_step((kBeyond_rad - mixed_beyond[i]) / (kBeyond_rad - kWithin_rad)));
      lanes.rotation[i] = between(lanes.rotation[i], kept, keeps);
    }
    mixed_rotation[i] = lanes.rotation[i];
  }
  lanes.place[0] = mixed_root;
  place_live_joints(plan, lanes);
}

// Sets the targets to the mean result of the blended postures, on the mean posture: where
// all of them agree, their error (for balance or for higher levels) stays. Extremities
// get their rotation in the mean: rotations fade as the postures do, and a rotation that
// all postures keep is kept in the mean.
void AdapterState::aim_at_mean() {
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    LanePoint<float>& p = lanes.points[k];
    p.place = place_of(plan.points[k], p, lanes);
    const Vec3<float> wanted = target_of(plan.points[k], p, lanes) - mixed_left[k];
    p.target = p.place + firmness[k] * (wanted - p.place);
    p.error = p.active > 0.0F ? p.target - p.place : Vec3<float>{0.0F, 0.0F, 0.0F};
  }
  for (const LimbPlan& limb : plan.limbs) {
    float share = options.extremities_keep_orientation ? 1.0F : 0.0F;
    for (const int k : limb.points) {
      share = std::max(share, firmness[static_cast<std::size_t>(k)]);
    }
    for (const int k : limb.orientations) {
      share = std::max(share, firmness[static_cast<std::size_t>(k)]);
    }
    const auto e = static_cast<std::size_t>(limb.end);
    const Quat<float> aim = between(lanes.rotation[e], mixed_rotation[e], share);
    lanes.reference_rotation[e] = aim;
    for (const int k : limb.orientations) {
      lanes.points[static_cast<std::size_t>(k)].goal.rotation = aim;
    }
  }
}

// Closes supports first, then every other limb with a target.
void AdapterState::close_mean() {
  aim_at_mean();
  SolveSettings solve_settings = settings();
  solve_settings.keeps_orientation = true;
  const auto last = static_cast<float>(shape().last_level);
  reach_supports(plan, solve_settings, true, lanes);
  for (std::size_t l = 0; l < plan.limbs.size(); ++l) {
    const LimbPlan& limb = plan.limbs[l];
    bool closes = options.extremities_keep_orientation;
    for (const int k : limb.points) {
      closes = closes || lanes.points[static_cast<std::size_t>(k)].active > 0.0F;
    }
    for (const int k : limb.orientations) {
      closes = closes || lanes.points[static_cast<std::size_t>(k)].active > 0.0F;
    }
    if (closes) close_limb(plan, static_cast<int>(l), solve_settings, last, true, lanes);
  }
}

// Moves the centre of mass to the mean of those of the blended postures, by the root
// alone: whole-body steps would jump when a fading support is added. Errors remain where
// legs are at full stretch or the root may not move.
void AdapterState::settle_mean() {
  measure_balance(plan, lanes);
  lanes.com_target = mixed_com;
  const auto off = static_cast<double>(length(balance_error(lanes)));
  const double precisions =
      off / std::max(static_cast<double>(lanes.balance_precision), 1e-9);
  const auto share = static_cast<float>(
      smooth_step((precisions - kNearEnough) / (kWholly - kNearEnough)));
  if (share <= 0.0F) return;
  lanes.com_target = lanes.com + share * (mixed_com - lanes.com);
  for (int round = 0; round < kRootRounds; ++round) {
    measure_balance(plan, lanes);
    const Vec3<float> error = balance_error(lanes);
    if (length(error) < kSettled) return;
    lanes.place[0] += Vec3<float>{lanes.root_weight_on_floor * error.x,
                                  lanes.root_weight * error.y,
                                  lanes.root_weight_on_floor * error.z};
    place_live_joints(plan, lanes);
    close_mean();
  }
}

}  // namespace marey::retarget
