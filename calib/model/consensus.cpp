// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/consensus.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::calib {

double disagreement(const RigidTransform& x, const RigidTransform& y) {
  return glm::length(x.translation - y.translation) +
         glm::length(rotation_vector(glm::conjugate(x.rotation) * y.rotation));
}

Link medoid_transform(std::size_t a,
                      std::size_t b,
                      std::span<const RigidTransform> a_from_b) {
  MAREY_ASSERT(!a_from_b.empty());
  constexpr std::size_t kMax = 400;
  const std::size_t stride = (a_from_b.size() + kMax - 1) / kMax;
  double best_cost = std::numeric_limits<double>::infinity();
  Link link{a, b, {}, 0, 0.0};
  for (std::size_t i = 0; i < a_from_b.size(); i += stride) {
    double cost = 0.0;
    double near = 0.0;
    int support = 0;
    for (std::size_t j = 0; j < a_from_b.size(); j += stride) {
      const double d = disagreement(a_from_b[i], a_from_b[j]);
      cost += std::min(d, kMaxDisagreement);
      if (d >= kMaxDisagreement) continue;
      ++support;
      near += d;
    }
    if (cost < best_cost) {
      best_cost = cost;
      link.a_from_b = a_from_b[i];
      link.support = support;
      link.spread = near / support;
    }
  }
  return link;
}

std::vector<std::optional<RigidTransform>> propagate_poses(std::size_t first,
                                                           std::span<const Link> links,
                                                           std::size_t count) {
  std::vector<std::optional<RigidTransform>> x_from_first(count);
  if (first >= count) return x_from_first;
  x_from_first[first] = RigidTransform{};
  while (true) {
    const Link* best = nullptr;
    for (const Link& link : links) {
      const bool is_new =
          x_from_first[link.a].has_value() != x_from_first[link.b].has_value();
      if (is_new && (!best || link.support > best->support)) best = &link;
    }
    if (!best) return x_from_first;
    if (x_from_first[best->a]) {
      x_from_first[best->b] = inverse(best->a_from_b) * *x_from_first[best->a];
    } else {
      x_from_first[best->a] = best->a_from_b * *x_from_first[best->b];
    }
  }
}

}  // namespace marey::calib
