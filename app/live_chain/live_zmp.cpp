// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_zmp.h"

#include <algorithm>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/base/assert.h"

namespace marey::app {
namespace {

constexpr double kZmpGravity_m_s2 = 9.81;
constexpr double kZmpLoadedShare = 0.2;
constexpr std::size_t kMinZmpSamples = 5;

}  // namespace

void LiveZmp::step(const glm::dvec3& com_in_world, double since_last_s) {
  MAREY_ASSERT(since_last_s > 0.0);
  // A small tolerance: ages are sums.
  while (count_ > 0 && samples_[count_ - 1].age_s + since_last_s > kWindow_s + 1e-6) {
    --count_;
  }
  count_ = std::min(count_, samples_.size() - 1);
  for (std::size_t i = count_; i > 0; --i) {
    samples_[i] = samples_[i - 1];
    samples_[i].age_s += since_last_s;
  }
  samples_[0] = {0.0, com_in_world};
  ++count_;
}

std::optional<glm::dvec2> LiveZmp::on_floor(double floor_height_m) const {
  if (count_ < kMinZmpSamples) return std::nullopt;
  if (samples_[count_ - 1].age_s < 0.5 * kWindow_s) return std::nullopt;
  // Normal equations of 1, u, u^2, with u = -age / kWindow_s, about the newest position.
  glm::dmat3 normal(0.0);
  glm::dmat3 right(0.0);
  const glm::dvec3 com_in_world = samples_[0].com_in_world;
  for (std::size_t i = 0; i < count_; ++i) {
    const double u = -samples_[i].age_s / kWindow_s;
    const glm::dvec3 row(1.0, u, u * u);
    normal += glm::outerProduct(row, row);
    right += glm::outerProduct(row, samples_[i].com_in_world - com_in_world);
  }
  const glm::dmat3 fit = glm::inverse(normal) * right;
  const double scale = 2.0 / (kWindow_s * kWindow_s);
  const glm::dvec3 acceleration_m_s2 =
      scale * glm::dvec3(fit[0][2], fit[1][2], fit[2][2]);
  const double push_m_s2 = acceleration_m_s2.y + kZmpGravity_m_s2;
  // Also false if a position is not finite.
  if (!(push_m_s2 >= kZmpLoadedShare * kZmpGravity_m_s2)) return std::nullopt;
  const double lever_s2 = (com_in_world.y - floor_height_m) / push_m_s2;
  return glm::dvec2(com_in_world.x - lever_s2 * acceleration_m_s2.x,
                    com_in_world.z - lever_s2 * acceleration_m_s2.z);
}

}  // namespace marey::app
