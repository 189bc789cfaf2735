// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/mannequin_figure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace marey::recordings {

void Figure::add_ball(HumanBone bone, double radius) {
  Ring ring;
  ring.centre = at(bone);
  ring.half_width = ring.half_depth = radius * thickness_m;
  ring.skin = carried_by({{bone, 1.0}});
  ring.part = kJoint;
  builder.add_ellipsoid(ring, radius * thickness_m, 16);
}

Section section_at(std::span<const Section> keys, double at) {
  std::size_t i = 0;
  while (i + 2 < keys.size() && at > keys[i + 1].at) ++i;
  const Section& a = keys[i];
  const Section& b = keys[i + 1];
  const Section& before = keys[i > 0 ? i - 1 : i];
  const Section& after = keys[std::min(i + 2, keys.size() - 1)];
  const double span = b.at - a.at;
  const double t = std::clamp((at - a.at) / span, 0.0, 1.0);
  const auto value = [&](double Section::*field) {
    const double slope_a = (b.*field - before.*field) / (b.at - before.at) * span;
    const double slope_b = (after.*field - a.*field) / (after.at - a.at) * span;
    return (1 + 2 * t) * (1 - t) * (1 - t) * a.*field + t * (1 - t) * (1 - t) * slope_a +
           t * t * (3 - 2 * t) * b.*field + t * t * (t - 1) * slope_b;
  };
  return {at,
          std::max(0.0, value(&Section::half_width)),
          std::max(0.0, value(&Section::half_depth)),
          value(&Section::shift)};
}

double ease(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

glm::dvec3 direction(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 1e-9 ? v / length : otherwise;
}

glm::dvec3 unit_across(const glm::dvec3& wanted, const glm::dvec3& along) {
  const glm::dvec3 v = wanted - glm::dot(wanted, along) * along;
  if (glm::length(v) > 1e-3) return glm::normalize(v);
  const glm::dvec3 other =
      std::abs(along.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  return glm::normalize(other - glm::dot(other, along) * along);
}

std::vector<double> places_along(std::span<const Section> keys, int count) {
  std::vector<double> places;
  for (int i = 0; i <= count; ++i) {
    const double even = static_cast<double>(i) / count;
    const double crowded = 0.5 - 0.5 * std::cos(std::numbers::pi * even);
    places.push_back(
        glm::mix(keys.front().at, keys.back().at, 0.4 * even + 0.6 * crowded));
  }
  return places;
}

}  // namespace marey::recordings
