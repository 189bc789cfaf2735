// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "retarget/activation.h"
#include "retarget/adapter_state.h"
#include "retarget/smooth_step.h"

/// Postures while constraints fade in or out, or one control passes over to the other.
namespace marey::retarget {
namespace {

// A joint of a mean of postures keeps its limits wholly where each of them keeps them to
// single precision, and not at all where one of them is as far beyond as a degree or two.
constexpr double kWithin_rad = 1e-4;
constexpr double kBeyond_rad = 0.03;

float dot(const Quat<float>& a, const Quat<float>& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

// Rounds that bring a mean's centre of mass back, each of which leaves about a fifth.
// Always as many: to end where it is good enough would be a jump.
constexpr int kRootRounds = 6;
// Less is rounding's, in units.
constexpr float kSettled = 2e-7F;
// In precisions of balance: nothing is mended up to the first, all from the second on. A
// straight limb makes much of the least motion of its root.
constexpr double kNearEnough = 0.1;
constexpr double kWholly = 0.4;

}  // namespace

void Adapter::State::mix(float share) {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    const Quat<float>& q = lanes.rotation[i];
    Quat<float>& sum = mixed_rotation[i];
    // Of the two quaternions of a rotation the one on the side of the sum so far: so two
    // that are nearly the same never cancel, and the sum only grows. The first is on the
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

// Constraints fade between the postures without and with them. With activations
// 1 = a0 > a1 > ... > an > an+1 = 0 and posture Si for all constraints of at least ai,
// the answer is the mean of the Si with weights ai - ai+1: continuous in every
// activation, also as they pass each other, and exact where nothing fades (the Lovasz
// extension of the map from sets of constraints to postures). What all the Si keep is
// then brought back into that mean.
void Adapter::State::solve_faded(LaneFigures<float>& figures) {
  const std::vector<double>& ramps = question.ramps;
  for (Quat<float>& q : mixed_rotation) q = {0.0F, 0.0F, 0.0F, 0.0F};
  for (float& beyond : mixed_beyond) beyond = 0.0F;
  for (Vec3<float>& left : mixed_left) left = {0.0F, 0.0F, 0.0F};
  mixed_root = {0.0F, 0.0F, 0.0F};
  mixed_com = mixed_root;
  mixed_com_target = mixed_root;
  const auto add_all = [&](Control asked, double weight) {
    control = asked;
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
  std::vector<WishNumbers>& wishes = question.numbers;
  for (std::size_t k = 0; k < wishes.size(); ++k) {
    const double activation = question.activations[k];
    wishes[k].active = activation > kFirmActivation;
    firmness[k] = static_cast<float>(
        smooth_step((activation - kFirmActivation) / (1.0 - kFirmActivation)));
  }
  pack_wishes(plan, body, origin_in_world, wishes, question.wishes);
  load_wishes(plan, question.wishes.data(), 0, lanes);
  take_mean();
  close_mean();
  if (shape().rows.balance) settle_mean();
  // Aiming has put its own rotations in the place of those that are wanted.
  load_wishes(plan, question.wishes.data(), 0, lanes);
  lanes.com_target = mixed_com_target;
  const auto last = static_cast<float>(shape().last_level);
  figures.balance = measure(plan, shape().rows.balance, last, lanes).balance;
}

// The mean posture, within limits where the mixed ones are.
void Adapter::State::take_mean() {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    lanes.rotation[i] = normalized(mixed_rotation[i]);
    if (plan.limit_of[i] >= 0 && j != 0) {
      // Between two postures that keep a limit may be one that does not. Where one of
      // them does not either (supports and references may be beyond) the mean stays as it
      // is.
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

// Wishes aim at what the mixed postures reached of them, on the mean: where all of them
// are one posture, what it has not reached (for balance, or for what comes first) is not
// taken after all. Extremities aim at how the mean has them turned: rotations fade as the
// postures do, and what is kept in all of these is kept in the mean.
void Adapter::State::aim_at_mean() {
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

// Supports first, then every other limb that somebody asks something of.
void Adapter::State::close_mean() {
  aim_at_mean();
  SolveSettings told = settings();
  told.keeps_orientation = true;
  const auto last = static_cast<float>(shape().last_level);
  reach_supports(plan, told, true, lanes);
  for (std::size_t l = 0; l < plan.limbs.size(); ++l) {
    const LimbPlan& limb = plan.limbs[l];
    bool asked = options.extremities_keep_orientation;
    for (const int k : limb.points) {
      asked = asked || lanes.points[static_cast<std::size_t>(k)].active > 0.0F;
    }
    for (const int k : limb.orientations) {
      asked = asked || lanes.points[static_cast<std::size_t>(k)].active > 0.0F;
    }
    if (asked) close_limb(plan, static_cast<int>(l), told, last, true, lanes);
  }
}

// The centre of mass to where the mixed postures have theirs on average, by the root:
// steps of the whole body would jump as a fading support joins them. What legs at full
// stretch or a root that may not travel leave is left.
void Adapter::State::settle_mean() {
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
