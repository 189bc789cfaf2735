// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sources/live_source.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

constexpr double kLiveLn2 = 0.69314718055994530942;
// A group that gave way keeps this share, so that it shows the source where nothing else
// plays, and no posture jumps when the share returns.
constexpr float kLeastShare = 1e-6F;
// Times closer than this are the same: the clocks of caller and engine round differently.
constexpr double kSame_s = 1e-9;

// One step of x(t) = (x + (v + x y) t) e^(-y t).
template <class Number>
void decay_to_zero(Number& value, Number& rate, double half_life_s, double step_s) {
  const double y = 2.0 * kLiveLn2 / half_life_s;
  const double x = static_cast<double>(value);
  const double j = static_cast<double>(rate) + x * y;
  const double e = std::exp(-y * step_s);
  value = static_cast<Number>((x + j * step_s) * e);
  rate = static_cast<Number>((static_cast<double>(rate) - j * y * step_s) * e);
}

// Time in which a steady velocity would go as far as one that decays.
double decayed_s(double time_s, double half_life_s) {
  return half_life_s / kLiveLn2 * -std::expm1(-kLiveLn2 / half_life_s * time_s);
}

}  // namespace

Status check_live_options(const LiveOptions& options) {
  for (const double value : {options.max_sigma_m,
                             options.max_age_s,
                             options.good_s,
                             options.share_half_life_s,
                             options.extrapolate_half_life_s,
                             options.gap_s,
                             options.gap_half_life_s}) {
    if (std::isfinite(value) && value > 0.0) continue;
    return bad_input("live source",
                     "a limit or time of its options is not finite and above 0",
                     "give limits and times above 0");
  }
  return Done{};
}

Status LiveSource::push(const LivePosture& posture) {
  if (const Status good = check_live_posture(posture); !good) return good.error();
  if (has_any_ && !(posture.time_s > newest_.time_s)) {
    return bad_input("live posture",
                     "its time is not after that of the posture before",
                     "push postures in the order of their times");
  }
  const double since_s = posture.time_s - newest_.time_s;
  has_rates_ = has_any_ && since_s <= options_.max_age_s;
  if (has_rates_) {
    data_rates_ =
        rates_between(newest_.posture, posture.posture, static_cast<float>(since_s));
    const RootPlace moved_by = relative(newest_.root_legs, posture.root_legs);
    data_root_rate_ = {
        moved_by.x_m / since_s, moved_by.z_m / since_s, moved_by.heading_rad / since_s};
    has_data_ = true;
  }
  newest_ = posture;
  has_any_ = true;
  is_new_ = true;
  return Done{};
}

double LiveSource::ahead_s(double time_s) const {
  const double dt_s = time_s - now_s_;
  return dt_s <= 0.0 ? dt_s : decayed_s(dt_s, options_.extrapolate_half_life_s);
}

void LiveSource::take_data(double time_s, double step_s) {
  const bool after_gap = is_shown_ && newest_.time_s - shown_data_s_ > options_.gap_s &&
                         time_s - step_s - shown_data_s_ > 0.5 * options_.gap_s;
  const auto half_life_s = static_cast<float>(options_.extrapolate_half_life_s);
  double age_s = time_s - newest_.time_s;
  if (age_s < kSame_s) age_s = 0.0;
  posture_ = newest_.posture;
  rates_ = data_rates_;
  if (age_s > 0.0) {
    extrapolate(static_cast<float>(age_s), half_life_s, rates_, posture_);
  }
  const double gone_s = decayed_s(age_s, options_.extrapolate_half_life_s);
  const double left = std::exp2(-age_s / options_.extrapolate_half_life_s);
  const RootPlace before = root_;
  root_ = moved(newest_.root_legs,
                {data_root_rate_.x * gone_s,
                 data_root_rate_.z * gone_s,
                 data_root_rate_.heading * gone_s});
  root_rate_ = {
      data_root_rate_.x * left, data_root_rate_.z * left, data_root_rate_.heading * left};
  shown_data_s_ = newest_.time_s;
  is_new_ = false;
  if (after_gap) {
    BlendPosture to = posture_;
    move_posture(rates_, static_cast<float>(-step_s), to);
    offset_.start(out_, out_rates_, to, rates_);
    // The displacement during the gap is not made up.
    root_lag_ = {out_root_rate_.x - root_rate_.x,
                 out_root_rate_.z - root_rate_.z,
                 out_root_rate_.heading - root_rate_.heading};
    root_lag_rate_ = {};
    out_root_rate_ = root_rate_;
  } else if (is_shown_) {
    const RootPlace moved_by = relative(before, root_);
    out_root_rate_ = {
        moved_by.x_m / step_s, moved_by.z_m / step_s, moved_by.heading_rad / step_s};
  } else {
    out_root_rate_ = root_rate_;
  }
}

void LiveSource::move_root(double step_s) {
  const double h_s = options_.gap_half_life_s;
  decay_to_zero(root_lag_.x, root_lag_rate_.x, h_s, step_s);
  decay_to_zero(root_lag_.z, root_lag_rate_.z, h_s, step_s);
  decay_to_zero(root_lag_.heading, root_lag_rate_.heading, h_s, step_s);
  out_root_rate_.x += root_lag_.x;
  out_root_rate_.z += root_lag_.z;
  out_root_rate_.heading += root_lag_.heading;
}

void LiveSource::rate_groups(double step_s) {
  for (std::size_t g = 0; g < kGroupCount; ++g) {
    const bool is_good = !report_.is_lost &&
                         static_cast<double>(newest_.sigma_m[g]) <= options_.max_sigma_m;
    good_s_[g] = is_good ? good_s_[g] + static_cast<float>(step_s) : 0.0F;
    if (!is_shown_) {
      is_wanted_[g] = is_good;
      report_.share[g] = is_good ? 1.0F : kLeastShare;
      continue;
    }
    if (!is_good) is_wanted_[g] = false;
    if (static_cast<double>(good_s_[g]) >= options_.good_s) is_wanted_[g] = true;
    const float goal = is_wanted_[g] ? 1.0F : 0.0F;
    float from_goal = report_.share[g] - goal;
    decay_to_zero(from_goal, share_rate_[g], options_.share_half_life_s, step_s);
    report_.share[g] = std::clamp(goal + from_goal, kLeastShare, 1.0F);
  }
}

void LiveSource::step(double time_s, double step_s) {
  MAREY_ASSERT(has_data_ && step_s > 0.0);
  const BlendPosture before = out_;
  if (is_new_ && has_rates_) {
    take_data(time_s, step_s);
  } else {
    extrapolate(static_cast<float>(step_s),
                static_cast<float>(options_.extrapolate_half_life_s),
                rates_,
                posture_);
    const double gone = decayed_s(step_s, options_.extrapolate_half_life_s);
    const double left = std::exp2(-step_s / options_.extrapolate_half_life_s);
    root_ = moved(root_,
                  {root_rate_.x * gone, root_rate_.z * gone, root_rate_.heading * gone});
    out_root_rate_ = {root_rate_.x * gone / step_s,
                      root_rate_.z * gone / step_s,
                      root_rate_.heading * gone / step_s};
    root_rate_ = {root_rate_.x * left, root_rate_.z * left, root_rate_.heading * left};
  }
  move_root(step_s);
  out_ = posture_;
  offset_.step(
      static_cast<float>(step_s), static_cast<float>(options_.gap_half_life_s), out_);
  out_rates_ =
      is_shown_ ? rates_between(before, out_, static_cast<float>(step_s)) : rates_;
  now_s_ = time_s;
  report_.age_s = std::max(0.0, time_s - shown_data_s_);
  report_.is_lost = report_.age_s > options_.max_age_s;
  rate_groups(step_s);
  is_shown_ = true;
}

void LiveSource::sample(double time_s, BlendPosture& out) const {
  out = out_;
  const double by_s = ahead_s(time_s);
  if (std::abs(by_s) > kSame_s) move_posture(out_rates_, static_cast<float>(by_s), out);
}

RootPlace LiveSource::root_step(double from_s, double to_s) const {
  const double by_s = ahead_s(to_s) - ahead_s(from_s);
  return {
      out_root_rate_.x * by_s, out_root_rate_.z * by_s, out_root_rate_.heading * by_s};
}

}  // namespace marey::engine
