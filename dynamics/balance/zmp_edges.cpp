// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/zmp_edges.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

namespace marey::dynamics {
namespace {

constexpr double kWidthShare = 0.25;
constexpr double kMinWidth_m = 1e-6;

double signed_area(std::span<const glm::dvec2> corners) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2& a = corners[i];
    const glm::dvec2& b = corners[(i + 1) % corners.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return 0.5 * sum;
}

}  // namespace

bool add_support_edges(std::size_t frame,
                       std::span<const glm::dvec2> corners,
                       double margin_m,
                       std::vector<ZmpEdge>& out) {
  if (corners.size() < 3) return false;
  const double sense = signed_area(corners) > 0.0 ? 1.0 : -1.0;
  const std::size_t first = out.size();
  double width_m = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 along = corners[(i + 1) % corners.size()] - corners[i];
    const double length_m = glm::length(along);
    if (length_m < kMinWidth_m) continue;
    ZmpEdge edge;
    edge.frame = frame;
    edge.normal = sense / length_m * glm::dvec2(along.y, -along.x);
    edge.bound_m = glm::dot(edge.normal, corners[i]);
    double across_m = 0.0;
    for (const glm::dvec2& p : corners) {
      across_m = std::max(across_m, edge.bound_m - glm::dot(edge.normal, p));
    }
    width_m = std::min(width_m, across_m);
    out.push_back(edge);
  }
  if (out.size() < first + 3 || width_m < kMinWidth_m) {
    out.resize(first);
    return false;
  }
  for (std::size_t k = first; k < out.size(); ++k) {
    out[k].bound_m -= std::min(margin_m, kWidthShare * width_m);
  }
  return true;
}

void add_shift_limits(std::size_t frame, double limit_m, std::vector<ZmpEdge>& out) {
  for (const glm::dvec2& normal :
       {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
    ZmpEdge edge;
    edge.frame = frame;
    edge.of_zmp = false;
    edge.normal = normal;
    edge.bound_m = limit_m;
    out.push_back(edge);
  }
}

}  // namespace marey::dynamics
