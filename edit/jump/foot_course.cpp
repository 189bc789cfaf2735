// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/jump/foot_course.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"

namespace marey::edit {
namespace {

/// Ankle, rotation of the foot, rotation of the toes.
constexpr std::size_t kFootChannels = 11;
using FootChannels = std::array<double, kFootChannels>;

FootChannels channels_of(const retarget::FootPlace& place) {
  const auto& [ankle, foot, toes] = place;
  return {ankle.x,
          ankle.y,
          ankle.z,
          foot.w,
          foot.x,
          foot.y,
          foot.z,
          toes.w,
          toes.x,
          toes.y,
          toes.z};
}

/// Changes the sign of a quaternion so that it is near another one.
void align_sign(const FootChannels& to, std::size_t first, FootChannels& q) {
  double dot = 0.0;
  for (std::size_t k = first; k < first + 4; ++k) dot += to[k] * q[k];
  if (dot >= 0.0) return;
  for (std::size_t k = first; k < first + 4; ++k) q[k] = -q[k];
}

double harmonic_slope(double before, double after) {
  if (before * after <= 0.0) return 0.0;
  return 2.0 * before * after / (before + after);
}

double hermite(double a, double b, double slope_a, double slope_b, double x) {
  const double rest = 1.0 - x;
  return a * rest * rest * (1.0 + 2.0 * x) + b * x * x * (3.0 - 2.0 * x) +
         slope_a * x * rest * rest - slope_b * x * x * rest;
}

retarget::FootPlace place_of(const FootChannels& c) {
  retarget::FootPlace out;
  out.ankle_in_world = {c[0], c[1], c[2]};
  out.foot = glm::normalize(glm::dquat(c[3], c[4], c[5], c[6]));
  out.toes = glm::normalize(glm::dquat(c[7], c[8], c[9], c[10]));
  return out;
}

}  // namespace

std::vector<retarget::FootPlace> foot_course(std::span<const retarget::FootPlace> places,
                                             std::span<const double> at_frame) {
  MAREY_ASSERT(!places.empty());
  std::vector<FootChannels> channels;
  channels.reserve(places.size());
  for (const retarget::FootPlace& place : places) {
    channels.push_back(channels_of(place));
    if (channels.size() < 2) continue;
    const FootChannels& last = channels[channels.size() - 2];
    align_sign(last, 3, channels.back());
    align_sign(last, 7, channels.back());
  }
  const auto slope = [&](std::size_t frame, std::size_t k) {
    if (frame == 0 || frame + 1 >= channels.size()) return 0.0;
    return harmonic_slope(channels[frame][k] - channels[frame - 1][k],
                          channels[frame + 1][k] - channels[frame][k]);
  };
  std::vector<retarget::FootPlace> out;
  out.reserve(at_frame.size());
  for (const double at : at_frame) {
    const auto before = static_cast<std::size_t>(at);
    MAREY_ASSERT(at >= 0.0 && before < places.size());
    const double share = at - static_cast<double>(before);
    if (share == 0.0) {
      out.push_back(places[before]);
      continue;
    }
    FootChannels made{};
    for (std::size_t k = 0; k < kFootChannels; ++k) {
      made[k] = hermite(channels[before][k],
                        channels[before + 1][k],
                        slope(before, k),
                        slope(before + 1, k),
                        share);
    }
    out.push_back(place_of(made));
  }
  return out;
}

}  // namespace marey::edit
