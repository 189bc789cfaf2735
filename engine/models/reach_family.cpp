// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/reach_family.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

constexpr double kSamePlace_m = 1e-3;
// For the spread of the places, squared: the cost of changing a weight. Small against 1,
// so that the place is met to micrometres where it can be.
constexpr double kWeightCost = 1e-6;
constexpr std::size_t kMost = kMaxFamilyShares;

using Shares = std::array<double, kMost>;

// The places that are blended, from the target.
struct NearMembers {
  std::array<std::size_t, kMost> index{};
  std::array<double, kMost> distance_m{};
  std::array<glm::dvec3, kMost> from_target{};
  std::size_t count = 0;
};

NearMembers nearest_members(std::span<const FamilyMember> members,
                            const glm::dvec3& target,
                            std::size_t max_count) {
  NearMembers near;
  const std::size_t most = std::min(max_count, kMost);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const glm::dvec3 from_target = members[m].arrival_in_heading_m - target;
    const double distance_m = glm::length(from_target);
    std::size_t at = near.count;
    while (at > 0 && distance_m < near.distance_m[at - 1]) --at;
    if (at >= most) continue;
    near.count = std::min(near.count + 1, most);
    for (std::size_t i = near.count - 1; i > at; --i) {
      near.index[i] = near.index[i - 1];
      near.distance_m[i] = near.distance_m[i - 1];
      near.from_target[i] = near.from_target[i - 1];
    }
    near.index[at] = m;
    near.distance_m[at] = distance_m;
    near.from_target[at] = from_target;
  }
  return near;
}

// Minimizes the cost over weights of the members in `subset` with sum 1, by its normal
// equations with a Lagrange multiplier. Returns false if a weight is negative.
bool solve_subset(const NearMembers& near,
                  const Shares& first,
                  double change_cost,
                  unsigned subset,
                  Shares& weights) {
  constexpr std::size_t kSize = kMost + 1;
  std::array<std::array<double, kSize + 1>, kSize> m{};
  std::array<std::size_t, kMost> member{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < near.count; ++i) {
    if ((subset >> i & 1U) != 0U) member[n++] = i;
  }
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = 0; c < n; ++c) {
      m[r][c] = glm::dot(near.from_target[member[r]], near.from_target[member[c]]);
    }
    m[r][r] += change_cost;
    m[r][n] = m[n][r] = 1.0;
    m[r][n + 1] = change_cost * first[member[r]];
  }
  m[n][n + 1] = 1.0;
  for (std::size_t p = 0; p <= n; ++p) {
    std::size_t best = p;
    for (std::size_t r = p + 1; r <= n; ++r) {
      if (std::abs(m[r][p]) > std::abs(m[best][p])) best = r;
    }
    std::swap(m[p], m[best]);
    if (m[p][p] == 0.0) return false;
    for (std::size_t r = 0; r <= n; ++r) {
      if (r == p) continue;
      const double factor = m[r][p] / m[p][p];
      for (std::size_t c = p; c <= n + 1; ++c) m[r][c] -= factor * m[p][c];
    }
  }
  weights = {};
  for (std::size_t r = 0; r < n; ++r) {
    const double weight = m[r][n + 1] / m[r][r];
    if (!(weight >= 0.0)) return false;
    weights[member[r]] = weight;
  }
  return true;
}

double blend_cost(const NearMembers& near,
                  const Shares& first,
                  double change_cost,
                  const Shares& weights) {
  glm::dvec3 mean(0.0);
  double cost = 0.0;
  for (std::size_t i = 0; i < near.count; ++i) {
    mean += weights[i] * near.from_target[i];
    cost += change_cost * (weights[i] - first[i]) * (weights[i] - first[i]);
  }
  return cost + glm::dot(mean, mean);
}

// The convex problem has few weights: its minimum is that of one of the subsets.
Shares refined_weights(const NearMembers& near) {
  Shares first{};
  double sum = 0.0;
  double spread_m = 0.0;
  for (std::size_t i = 0; i < near.count; ++i) {
    first[i] = 1.0 / (near.distance_m[i] + kSamePlace_m);
    sum += first[i];
    spread_m = std::max(spread_m, near.distance_m[i]);
  }
  for (double& weight : first) weight /= sum;
  const double change_cost = kWeightCost * spread_m * spread_m;
  Shares best{};
  double least = std::numeric_limits<double>::infinity();
  for (unsigned subset = 1; subset < 1U << near.count; ++subset) {
    Shares weights{};
    if (!solve_subset(near, first, change_cost, subset, weights)) continue;
    const double cost = blend_cost(near, first, change_cost, weights);
    if (cost < least) {
      least = cost;
      best = weights;
    }
  }
  return best;
}

bool is_valid_member(const FamilyMember& m) {
  return std::isfinite(glm::length(m.arrival_in_heading_m)) &&
         std::isfinite(m.duration_s) && m.arrive_s > 0.0 && m.arrive_s <= m.duration_s;
}

}  // namespace

double FamilyBlend::missing_m(const glm::dvec3& target_in_heading_m) const {
  return glm::distance(arrival_in_heading_m, target_in_heading_m);
}

Result<ReachFamily> ReachFamily::make(std::vector<FamilyMember> members) {
  if (members.empty()) {
    return bad_input("reach family", "it has no clip", "name at least one clip");
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (is_valid_member(members[i])) continue;
    return bad_input("reach family: clip " + std::to_string(i + 1),
                     "its arrival is not a finite place and a time within the clip",
                     "give the clip an event \"arrive\"");
  }
  ReachFamily family;
  family.members_ = std::move(members);
  return family;
}

FamilyBlend ReachFamily::blend(const glm::dvec3& target_in_heading_m,
                               std::size_t max_shares,
                               const glm::dvec3& correction_m) const {
  MAREY_ASSERT(max_shares >= 1 && std::isfinite(glm::length(target_in_heading_m)));
  NearMembers near =
      nearest_members(members_, target_in_heading_m + correction_m, max_shares);
  if (near.distance_m[0] <= kSamePlace_m) near.count = 1;
  const Shares weights = refined_weights(near);
  std::array<std::size_t, kMost> order{};
  FamilyBlend blend;
  for (std::size_t i = 0; i < near.count; ++i) {
    if (weights[i] <= 0.0) continue;
    std::size_t at = blend.count++;
    for (; at > 0 && weights[i] > weights[order[at - 1]]; --at) order[at] = order[at - 1];
    order[at] = i;
  }
  for (std::size_t s = 0; s < blend.count; ++s) {
    const FamilyMember& member = members_[near.index[order[s]]];
    blend.shares[s] = {member.clip, weights[order[s]], 1.0};
    blend.arrive_s += weights[order[s]] * member.arrive_s;
    blend.arrival_in_heading_m += weights[order[s]] * member.arrival_in_heading_m;
  }
  blend.duration_s = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < blend.count; ++s) {
    const FamilyMember& member = members_[near.index[order[s]]];
    blend.shares[s].rate = member.arrive_s / blend.arrive_s;
    blend.duration_s =
        std::min(blend.duration_s, member.duration_s / blend.shares[s].rate);
  }
  return blend;
}

}  // namespace marey::engine
