// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/foot_judge.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace marey::testing {
namespace {

using B = HumanBone;

/// The yaw of a foot over the floor [deg]; nullopt: it is steep, or has no toe joint.
std::optional<double> foot_yaw(const Landmarks& marks, B foot, B toes) {
  if (!marks.contains(foot) || !marks.contains(toes)) return std::nullopt;
  const glm::dvec3 way = marks.at(toes) - marks.at(foot);
  const double level = std::hypot(way.x, way.z);
  if (level < 0.5 * glm::length(way) || level < 1e-6) return std::nullopt;
  return glm::degrees(std::atan2(way.x, way.z));
}

}  // namespace

void compare_feet(const std::vector<Landmarks>& source,
                  const std::vector<Landmarks>& body,
                  double hz,
                  BodyFigures& out) {
  constexpr double kOnEnd_s = 0.25;
  const auto run = static_cast<std::size_t>(std::ceil(kOnEnd_s * hz));
  for (const auto& [foot, toes] :
       {std::pair{B::kLeftFoot, B::kLeftToes}, std::pair{B::kRightFoot, B::kRightToes}}) {
    std::vector<double> apart_deg;
    for (std::size_t t = 0; t < source.size(); ++t) {
      const auto a = foot_yaw(source[t], foot, toes);
      const auto b = foot_yaw(body[t], foot, toes);
      const double apart =
          a && b ? std::abs(std::remainder(*b - *a - out.heading_deg, 360.0)) : 0.0;
      apart_deg.push_back(apart);
    }
    for (std::size_t t = 0; t + run <= apart_deg.size(); ++t) {
      const auto from = apart_deg.begin() + static_cast<std::ptrdiff_t>(t);
      const double minimum =
          *std::min_element(from, from + static_cast<std::ptrdiff_t>(run));
      if (minimum <= out.foot_yaw_deg) continue;
      out.foot_yaw_deg = minimum;
      out.foot_yaw_bone = name(foot);
      out.foot_yaw_frame = static_cast<int>(t);
    }
  }
}

}  // namespace marey::testing
