// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/jump_reference.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/smooth_step.h"
#include "core/signal/choose_smoothing.h"
#include "core/signal/spline_curve.h"

namespace marey::dynamics {
namespace {

/// Samples of the force per frame.
constexpr double kForcesPerFrame = 2.0;
constexpr double kNoForceLimit_m_s2 = 1e6;
/// Largest cut-off of the force, times the duration of the push: 10 Hz for 0.7 s. Errors
/// of a centre of mass are correlated from frame to frame, so cross-validation alone
/// smooths too little. The residual keeps the rest.
constexpr double kCutoffPerDuration = 7.0;
/// Shorter pushes, whose start the user gave, are smoothed as one of this duration, since
/// the landing has the same cut-off.
constexpr double kShortestPush_s = 0.2;
/// Share of a support in which its force rises from a flight's 0, and falls to it.
constexpr double kFlightTaper = 0.06;
/// A landing that the clip cuts counts if it lasts this long.
constexpr double kLeastLanding_s = 0.15;

/// Accelerations of the centre of mass as functions of time.
std::vector<SplineCurve> acceleration_curves(const BodyTrack& track, double cutoff_hz) {
  const std::size_t count = track.com_in_world.size();
  std::array<std::vector<double>, 3> channels;
  SmoothingChannels smoothing;
  smoothing.splines.emplace_back(count, SplineOptions{3});
  std::vector<std::size_t> used;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const glm::dvec3& p : track.com_in_world) {
      channels[axis].push_back(p[static_cast<int>(axis)]);
    }
    if (is_straight_channel(channels[axis])) continue;
    used.push_back(smoothing.samples.size());
    smoothing.samples.emplace_back(channels[axis]);
    smoothing.spline_of.push_back(0);
  }
  if (!used.empty()) {
    const ChosenPenalties chosen =
        choose_penalties(smoothing, std::vector<std::vector<std::size_t>>{used});
    smoothing.splines[0].set_penalty(
        std::clamp(penalty_of_half_power(cutoff_hz, track.rate.hz, {3}),
                   chosen.groups[0],
                   std::max(chosen.groups[0], max_spline_penalty({3}))));
  } else {
    smoothing.splines[0].set_penalty(1.0);
  }
  std::vector<SplineCurve> out;
  for (const auto& channel : channels) {
    out.emplace_back(smoothing.splines[0], channel, track.rate.hz);
  }
  return out;
}

/// A support to be described.
struct SupportSpan {
  ComState start;
  ComState end;
  bool from_flight = false;
  bool to_flight = false;
};

SupportReference support_reference(const std::vector<SplineCurve>& acceleration,
                                   const SupportSpan& span,
                                   double gravity_m_s2,
                                   double rate_hz) {
  SupportReference out;
  out.start = span.start;
  out.end = span.end;
  out.gravity_m_s2 = gravity_m_s2;
  const double duration_s = out.duration_s();
  const auto count =
      static_cast<std::size_t>(std::ceil(kForcesPerFrame * duration_s * rate_hz)) + 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> force;
    for (std::size_t k = 0; k < count; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(count - 1);
      const double time_s = span.start.time_s + duration_s * share;
      const double at_s = std::clamp(time_s, 0.0, acceleration[axis].end_s());
      double value = acceleration[axis].at(at_s, 2);
      if (axis == 1) {
        value = std::max(0.0, value + gravity_m_s2);
      }
      if (span.from_flight) value *= smooth_step(share / kFlightTaper);
      if (span.to_flight) {
        value *= smooth_step((1.0 - share) / kFlightTaper);
      }
      if (axis == 1) {
        out.peak_g = std::max(out.peak_g, value / gravity_m_s2);
      }
      force.push_back(value);
    }
    out.axes[axis] = make_push_reference(duration_s, std::move(force));
  }
  return out;
}

/// Returns the model of a captured support: its own forces between its own states.
std::optional<SupportPush> model_of(const SupportReference& reference) {
  SupportWish wish;
  wish.start = reference.start;
  wish.end = reference.end;
  wish.gravity_m_s2 = reference.gravity_m_s2;
  wish.max_force_m_s2 = kNoForceLimit_m_s2;
  wish.friction = kNoForceLimit_m_s2;
  return derive_support(reference, wish);
}

}  // namespace

std::optional<JumpReference> JumpReference::make(const BodyTrack& track,
                                                 const Jump& jump) {
  const std::size_t count = track.com_in_world.size();
  if (count < kMinSmoothingSamples) return std::nullopt;
  JumpReference out;
  out.jump_ = jump;
  out.rate_hz_ = track.rate.hz;
  out.end_s_ = static_cast<double>(count - 1) / track.rate.hz;
  std::vector<double> times;
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    times.push_back(static_cast<double>(i) / track.rate.hz);
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < count; ++i) values[i] = track.com_in_world[i][axis];
    out.path_.emplace_back(times, values);
  }
  const std::vector<SplineCurve> curves = acceleration_curves(
      track,
      kCutoffPerDuration /
          std::max(kShortestPush_s, jump.takeoff.time_s - jump.start.time_s));
  for (std::size_t i = 0; i < count; ++i) {
    const double at_s = std::min(times[i], curves[1].end_s());
    out.push_g_.push_back(curves[1].at(at_s, 2) / jump.gravity_m_s2 + 1.0);
  }
  const bool from_flight = jump.start_kind == PushStart::kTouchdown;
  out.push_ = std::make_shared<const SupportReference>(
      support_reference(curves,
                        {jump.start, jump.takeoff, from_flight, true},
                        jump.gravity_m_s2,
                        track.rate.hz));
  const auto push = model_of(*out.push_);
  if (!push) return std::nullopt;
  out.push_model_ = *push;
  if (jump.touchdown && !jump.rest &&
      out.end_s_ - jump.touchdown->time_s >= kLeastLanding_s) {
    // The clip ends before the body rests: its end counts as P5.
    ComState end{out.end_s_, track.com_in_world.back(), {}};
    for (int axis = 0; axis < 3; ++axis) {
      const SplineCurve& curve = curves[static_cast<std::size_t>(axis)];
      end.velocity_m_s[axis] = curve.at(curve.end_s(), 1);
    }
    out.jump_.rest = end;
  }
  if (out.jump_.touchdown && out.jump_.rest) {
    out.landing_ = std::make_shared<const SupportReference>(support_reference(
        curves,
        {*out.jump_.touchdown, *out.jump_.rest, true, jump.rest_is_takeoff},
        jump.gravity_m_s2,
        track.rate.hz));
    out.landing_model_ = model_of(*out.landing_);
    if (!out.landing_model_) out.landing_.reset();
  }
  const double flight_end_s = jump.touchdown ? jump.touchdown->time_s : out.end_s_;
  for (double t_s = jump.takeoff.time_s; t_s <= flight_end_s;
       t_s += 1.0 / track.rate.hz) {
    out.flight_residual_m_ =
        std::max(out.flight_residual_m_, glm::length(out.residual(t_s)));
  }
  return out;
}

double JumpReference::jump_end_s() const {
  if (landing_ != nullptr) return jump_.rest->time_s;
  return end_s_;
}

glm::dvec3 JumpReference::captured(double time_s) const {
  const double at_s = std::clamp(time_s, 0.0, end_s_);
  return {path_[0].at(at_s), path_[1].at(at_s), path_[2].at(at_s)};
}

double JumpReference::captured_push_g(double time_s) const {
  const double at = std::clamp(time_s, 0.0, end_s_) * rate_hz_;
  const auto before = std::min(static_cast<std::size_t>(at), push_g_.size() - 2);
  const double share = at - static_cast<double>(before);
  return (1.0 - share) * push_g_[before] + share * push_g_[before + 1];
}

glm::dvec3 JumpReference::modelled(double time_s) const {
  if (time_s < jump_.takeoff.time_s) {
    return push_model_.p_in_world(
        std::clamp(time_s - jump_.start.time_s, 0.0, push_model_.duration_s()));
  }
  if (landing_model_ && jump_.touchdown && time_s > jump_.touchdown->time_s) {
    return landing_model_->p_in_world(
        std::clamp(time_s - jump_.touchdown->time_s, 0.0, landing_model_->duration_s()));
  }
  const double t_s = time_s - jump_.takeoff.time_s;
  return jump_.takeoff.p_in_world + t_s * jump_.takeoff.velocity_m_s -
         glm::dvec3(0.0, 0.5 * jump_.gravity_m_s2 * t_s * t_s, 0.0);
}

glm::dvec3 JumpReference::residual(double time_s) const {
  return captured(time_s) - modelled(time_s);
}

}  // namespace marey::dynamics
