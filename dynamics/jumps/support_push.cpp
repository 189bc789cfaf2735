// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/support_push.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace marey::dynamics {
namespace {

/// Instants at which the lowest point and the peak are looked for.
constexpr int kSupportInstants = 64;
constexpr double kShareOfCone = 0.70710678118654752;
/// Tolerance of captured horizontal forces. [m/s^2]
constexpr double kOverCaptured_m_s2 = 0.5;
/// Upward velocity of a body that counts as standing.
constexpr double kNearlyStill_m_s = 0.1;
constexpr double kGolden = 0.61803398874989485;
constexpr int kGoldenSteps = 30;

PushEnds ends_of(const SupportWish& wish, int axis) {
  PushEnds ends;
  ends.start_m = wish.start.p_in_world[axis];
  ends.start_m_s = wish.start.velocity_m_s[axis];
  ends.end_m = wish.end.p_in_world[axis];
  ends.end_m_s = wish.end.velocity_m_s[axis];
  ends.duration_s = wish.end.time_s - wish.start.time_s;
  ends.gravity_m_s2 = wish.gravity_m_s2;
  return ends;
}

double force_at(const PushReference& reference, double share) {
  const double at = share * static_cast<double>(reference.force_m_s2.size() - 1);
  const auto before =
      std::min(static_cast<std::size_t>(at), reference.force_m_s2.size() - 2);
  const double rest = at - static_cast<double>(before);
  return (1.0 - rest) * reference.force_m_s2[before] +
         rest * reference.force_m_s2[before + 1];
}

std::optional<std::variant<ForcePush, ThesisPush>> vertical_push(
    const SupportReference& reference, const SupportWish& wish, const ForceEnds& tied) {
  PushEnds ends = ends_of(wish, 1);
  if (wish.law == PushLawKind::kForce) {
    ForceLimits limits;
    limits.max_force_m_s2 = wish.max_force_m_s2;
    limits.deepest_m = wish.deepest_m;
    limits.highest_m = wish.highest_m;
    auto made = derive_push(reference.axes[1], ends, limits, tied);
    if (!made && limits.highest_m) {
      limits.highest_m.reset();
      made = derive_push(reference.axes[1], ends, limits, tied);
    }
    if (!made) return std::nullopt;
    return *made;
  }
  ends = thesis_ends(reference, wish);
  const auto made =
      choose_thesis_push(ends, near_point_cost(wish.lowest.at, wish.lowest.height_m));
  if (!made) return std::nullopt;
  return *made;
}

}  // namespace

PushEnds thesis_ends(const SupportReference& reference, const SupportWish& wish) {
  PushEnds ends = ends_of(wish, 1);
  const double scale = wish.gravity_m_s2 / reference.gravity_m_s2;
  ends.start_m_s2 =
      std::max(scale * reference.axes[1].force_m_s2.front() - wish.gravity_m_s2,
               -wish.gravity_m_s2);
  // The law needs a body that falls or stands at the start.
  if (ends.start_m_s > 0.0 && ends.start_m_s < kNearlyStill_m_s) ends.start_m_s = 0.0;
  if (ends.start_m_s == 0.0) ends.start_m_s2 = std::min(*ends.start_m_s2, 0.0);
  ends.end_m_s2 =
      std::max(scale * reference.axes[1].force_m_s2.back() - wish.gravity_m_s2,
               -wish.gravity_m_s2);
  return ends;
}

double SupportPush::height_m(double t_s) const {
  if (const auto* force = std::get_if<ForcePush>(&vertical_)) return force->height_m(t_s);
  return std::get<ThesisPush>(vertical_).height_m(t_s);
}

double SupportPush::vertical_force_m_s2(double t_s) const {
  if (const auto* force = std::get_if<ForcePush>(&vertical_)) {
    return force->force_m_s2(t_s);
  }
  return std::get<ThesisPush>(vertical_).force_m_s2(t_s);
}

glm::dvec3 SupportPush::p_in_world(double t_s) const {
  return {across_[0].height_m(t_s), height_m(t_s), across_[1].height_m(t_s)};
}

glm::dvec3 SupportPush::velocity_m_s(double t_s) const {
  double up = 0.0;
  if (const auto* force = std::get_if<ForcePush>(&vertical_)) {
    up = force->velocity_m_s(t_s);
  } else {
    up = std::get<ThesisPush>(vertical_).velocity_m_s(t_s);
  }
  return {across_[0].velocity_m_s(t_s), up, across_[1].velocity_m_s(t_s)};
}

glm::dvec3 SupportPush::force_m_s2(double t_s) const {
  return {
      across_[0].force_m_s2(t_s), vertical_force_m_s2(t_s), across_[1].force_m_s2(t_s)};
}

void SupportPush::measure() {
  const double step_s = duration_s_ / kSupportInstants;
  int lowest = 0;
  double height = height_m(0.0);
  peak_force_m_s2_ = 0.0;
  highest_m_ = height;
  for (int k = 0; k <= kSupportInstants; ++k) {
    const double t_s = std::min(k * step_s, duration_s_);
    peak_force_m_s2_ = std::max(peak_force_m_s2_, vertical_force_m_s2(t_s));
    const double here = height_m(t_s);
    highest_m_ = std::max(highest_m_, here);
    if (here < height) {
      height = here;
      lowest = k;
    }
  }
  double low_s = std::max(0, lowest - 1) * step_s;
  double high_s = std::min(std::min(kSupportInstants, lowest + 1) * step_s, duration_s_);
  for (int k = 0; k < kGoldenSteps; ++k) {
    const double a_s = high_s - kGolden * (high_s - low_s);
    const double b_s = low_s + kGolden * (high_s - low_s);
    if (height_m(a_s) < height_m(b_s)) {
      high_s = b_s;
    } else {
      low_s = a_s;
    }
  }
  const double at_s = 0.5 * (low_s + high_s);
  lowest_ = {at_s / duration_s_, height_m(at_s)};
}

std::optional<SupportPush> derive_support(const SupportReference& reference,
                                          const SupportWish& wish) {
  const ForceEnds tied{true, true, wish.gravity_m_s2 / reference.gravity_m_s2};
  const auto vertical = vertical_push(reference, wish, tied);
  if (!vertical) return std::nullopt;
  SupportPush out;
  out.duration_s_ = wish.end.time_s - wish.start.time_s;
  out.vertical_ = *vertical;
  for (int axis = 0; axis < 2; ++axis) {
    const PushReference& captured = reference.axes[axis == 0 ? 0 : 2];
    std::array<double, kForceInstants> largest{};
    std::array<double, kForceInstants> unlimited{};
    for (int k = 0; k < kForceInstants; ++k) {
      const double share = k / static_cast<double>(kForceInstants - 1);
      largest[static_cast<std::size_t>(k)] =
          std::max(kShareOfCone * wish.friction *
                       std::max(0.0, out.vertical_force_m_s2(share * out.duration_s_)),
                   std::abs(tied.scale * force_at(captured, share)) + kOverCaptured_m_s2);
      unlimited[static_cast<std::size_t>(k)] = 1e6;
    }
    const PushEnds ends = ends_of(wish, axis == 0 ? 0 : 2);
    auto made = derive_horizontal_push(captured, ends, largest, tied);
    if (!made) {
      out.within_friction_ = false;
      made = derive_horizontal_push(captured, ends, unlimited, tied);
    }
    if (!made) return std::nullopt;
    out.across_[static_cast<std::size_t>(axis)] = *made;
  }
  out.measure();
  if (wish.law == PushLawKind::kThesis && out.peak_force_m_s2_ > wish.max_force_m_s2) {
    return std::nullopt;
  }
  return out;
}

}  // namespace marey::dynamics
