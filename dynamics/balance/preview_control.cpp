// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/preview_control.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

constexpr int kMaxRiccatiSteps = 20000;
constexpr double kRiccatiChange = 1e-13;

double largest_entry(const glm::dmat4& m) {
  double out = 0.0;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) out = std::max(out, std::abs(m[column][row]));
  }
  return out;
}

}  // namespace

PreviewGains preview_gains(FrameRate rate,
                           double height_m,
                           const PreviewOptions& options) {
  MAREY_ASSERT(rate.hz > 0.0 && height_m > 0.0 && options.gravity_m_s2 > 0.0);
  MAREY_ASSERT(options.preview_s > 0.0 && options.error_weight > 0.0 &&
               options.jerk_weight > 0.0);
  const double dt = 1.0 / rate.hz;
  const double lever = height_m / options.gravity_m_s2;
  // Cart-table: state (position, velocity, acceleration), input jerk, output point.
  const glm::dvec3 b(dt * dt * dt / 6.0, 0.5 * dt * dt, dt);
  const double cb = b.x - lever * b.z;
  const glm::dvec3 ca(1.0, dt, 0.5 * dt * dt - lever);
  // Augmented by the error of the point. GLM stores columns.
  const glm::dmat4 a_all(glm::dvec4(1, 0, 0, 0),
                         glm::dvec4(ca.x, 1, 0, 0),
                         glm::dvec4(ca.y, dt, 1, 0),
                         glm::dvec4(ca.z, 0.5 * dt * dt, dt, 1));
  const glm::dvec4 b_all(cb, b.x, b.y, b.z);
  const glm::dvec4 first(1, 0, 0, 0);
  const glm::dmat4 cost = options.error_weight * glm::outerProduct(first, first);
  glm::dmat4 p = cost;
  for (int i = 0; i < kMaxRiccatiSteps; ++i) {
    const double scale = options.jerk_weight + glm::dot(b_all, p * b_all);
    const glm::dvec4 gain = (glm::transpose(a_all) * (p * b_all)) / scale;
    glm::dmat4 next =
        glm::transpose(a_all) * p * a_all - scale * glm::outerProduct(gain, gain) + cost;
    next = 0.5 * (next + glm::transpose(next));
    const double change = largest_entry(next - p);
    p = next;
    if (change <= kRiccatiChange * largest_entry(p)) break;
  }
  const double scale = options.jerk_weight + glm::dot(b_all, p * b_all);
  const glm::dvec4 gain = (glm::transpose(a_all) * (p * b_all)) / scale;
  PreviewGains out;
  out.of_error = gain[0];
  out.of_state = {gain[1], gain[2], gain[3]};
  // Closed loop: the influence of a later point fades with its powers.
  const glm::dmat4 closed = a_all - glm::outerProduct(b_all, gain);
  glm::dvec4 influence = -(glm::transpose(closed) * (p * first));
  const auto frames = static_cast<std::size_t>(std::lround(options.preview_s * rate.hz));
  for (std::size_t i = 0; i < std::max<std::size_t>(frames, 1); ++i) {
    if (i == 0) {
      out.of_preview.push_back(-gain[0]);
      continue;
    }
    out.of_preview.push_back(glm::dot(b_all, influence) / scale);
    influence = glm::transpose(closed) * influence;
  }
  // The last known points stand for all later ones, so a body at rest over them stays.
  // They count more gradually towards the end: a point that becomes known moves the body
  // without a jerk.
  const double sum =
      std::accumulate(out.of_preview.begin(), out.of_preview.end(), gain[1]);
  const std::size_t count = out.of_preview.size();
  const std::size_t tail = std::max<std::size_t>(count / 2, 1);
  const auto share = [&](std::size_t i) {
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(tail);
    return at * (1.0 - at);
  };
  double total = 0.0;
  for (std::size_t i = 0; i < tail; ++i) total += share(i);
  for (std::size_t i = 0; i < tail; ++i) {
    out.of_preview[count - 1 - i] -= sum * share(i) / total;
  }
  return out;
}

PreviewControl::PreviewControl(FrameRate rate,
                               double height_m,
                               const PreviewOptions& options)
    : period_s_(1.0 / rate.hz),
      lever_s2_(height_m / options.gravity_m_s2),
      gains_(preview_gains(rate, height_m, options)) {}

void PreviewControl::reset(const glm::dvec2& p_xz_m) {
  position_ = p_xz_m;
  velocity_ = glm::dvec2(0.0);
  acceleration_ = glm::dvec2(0.0);
  error_sum_ = glm::dvec2(0.0);
}

glm::dvec2 PreviewControl::zmp_xz_m() const {
  return position_ - lever_s2_ * acceleration_;
}

void PreviewControl::step(std::span<const glm::dvec2> wanted_xz_m) {
  MAREY_ASSERT(!wanted_xz_m.empty());
  error_sum_ += zmp_xz_m() - wanted_xz_m.front();
  glm::dvec2 jerk = -gains_.of_error * error_sum_ - gains_.of_state[0] * position_ -
                    gains_.of_state[1] * velocity_ - gains_.of_state[2] * acceleration_;
  for (std::size_t i = 0; i < gains_.of_preview.size(); ++i) {
    const std::size_t at = std::min(i + 1, wanted_xz_m.size() - 1);
    jerk -= gains_.of_preview[i] * wanted_xz_m[at];
  }
  const double dt = period_s_;
  position_ += dt * velocity_ + 0.5 * dt * dt * acceleration_ + dt * dt * dt / 6.0 * jerk;
  velocity_ += dt * acceleration_ + 0.5 * dt * dt * jerk;
  acceleration_ += dt * jerk;
}

PreviewBalance::PreviewBalance(FrameRate rate,
                               double height_m,
                               const PreviewOptions& options)
    : control_(rate, height_m, options),
      known_(control_.preview_frames() + 1, glm::dvec2(0.0)) {
  reset();
}

void PreviewBalance::reset() {
  std::fill(known_.begin(), known_.end(), glm::dvec2(0.0));
  control_.reset(glm::dvec2(0.0));
  received_ = 0;
}

glm::dvec2 PreviewBalance::step(const glm::dvec2& zmp_shift_xz_m) {
  std::move(known_.begin() + 1, known_.end(), known_.begin());
  known_.back() = zmp_shift_xz_m;
  const glm::dvec2 shift = control_.com_xz_m();
  control_.step(known_);
  ++received_;
  return received_ > latency_frames() ? shift : glm::dvec2(0.0);
}

}  // namespace marey::dynamics
