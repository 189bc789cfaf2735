// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/turned_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

double signed_power(double base, double exponent) {
  return std::copysign(std::pow(std::abs(base), exponent), base);
}

}  // namespace

SkinWeights carried_by(std::initializer_list<std::pair<HumanBone, double>> bones) {
  std::vector<std::pair<HumanBone, double>> carriers;
  double sum = 0.0;
  for (const auto& [bone, weight] : bones) {
    // A smaller weight has no visible effect and would occupy one of four slots.
    if (weight < 1e-3) continue;
    carriers.emplace_back(bone, weight);
    sum += weight;
  }
  MAREY_ASSERT(!carriers.empty() && carriers.size() <= 4);
  std::ranges::stable_sort(
      carriers, [](const auto& a, const auto& b) { return a.second > b.second; });
  SkinWeights skin;
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    skin.joints[i] = JointIndex{static_cast<int>(carriers[i].first)};
    skin.weights[i] = carriers[i].second / sum;
  }
  return skin;
}

MeshBuilder::MeshBuilder(std::vector<MeshMaterial> materials) {
  for (MeshMaterial& material : materials) {
    mesh_.parts.push_back({std::move(material), {}});
  }
}

void MeshBuilder::add_ring(const Ring& ring, std::size_t segments) {
  const glm::dvec3 side = glm::cross(ring.front, ring.along);
  for (std::size_t s = 0; s < segments; ++s) {
    // Exact quarter turns, independent of the rounding of pi.
    const std::size_t quarter = segments / 4;
    const double angle = 0.5 * std::numbers::pi * static_cast<double>(s % quarter) /
                         static_cast<double>(quarter);
    double c = std::cos(angle);
    double d = std::sin(angle);
    for (std::size_t turn = 0; turn < s / quarter; ++turn) {
      c = -std::exchange(d, c);
    }
    const double x = ring.half_width * signed_power(c, 2.0 / ring.exponent);
    const double y = ring.half_depth * signed_power(d, 2.0 / ring.exponent);
    mesh_.p_in_world.push_back(ring.centre + x * side + y * ring.front);
    mesh_.skin.push_back(ring.skin);
  }
}

void MeshBuilder::add_pole(const Ring& ring) {
  mesh_.p_in_world.push_back(ring.centre);
  mesh_.skin.push_back(ring.skin);
}

void MeshBuilder::add_triangle(std::size_t part,
                               std::size_t a,
                               std::size_t b,
                               std::size_t c) {
  for (const std::size_t vertex : {a, b, c}) {
    mesh_.parts[part].triangles.push_back(static_cast<std::uint32_t>(vertex));
  }
  const auto& p = mesh_.p_in_world;
  // Not normalized: large triangles have a larger weight.
  const glm::dvec3 normal = glm::cross(p[b] - p[a], p[c] - p[a]);
  for (const std::size_t vertex : {a, b, c}) mesh_.normal_in_world[vertex] += normal;
}

std::pair<std::size_t, std::size_t> MeshBuilder::add_turned(std::span<const Ring> rings,
                                                            std::size_t segments) {
  MAREY_ASSERT(rings.size() >= 3 && segments >= 4 && segments % 4 == 0);
  const std::size_t first = mesh_.p_in_world.size();
  add_pole(rings.front());
  for (const Ring& ring : rings.subspan(1, rings.size() - 2)) add_ring(ring, segments);
  add_pole(rings.back());
  const std::size_t last = mesh_.p_in_world.size() - 1;
  mesh_.normal_in_world.resize(last + 1, glm::dvec3(0.0));

  const auto vertex = [&](std::size_t ring, std::size_t segment) {
    return first + 1 + (ring - 1) * segments + segment % segments;
  };
  for (std::size_t s = 0; s < segments; ++s) {
    add_triangle(rings.front().part, first, vertex(1, s + 1), vertex(1, s));
    for (std::size_t r = 1; r + 2 < rings.size(); ++r) {
      const std::size_t part = rings[r].part;
      add_triangle(part, vertex(r, s), vertex(r, s + 1), vertex(r + 1, s + 1));
      add_triangle(part, vertex(r, s), vertex(r + 1, s + 1), vertex(r + 1, s));
    }
    const std::size_t r = rings.size() - 2;
    add_triangle(rings[r].part, vertex(r, s), vertex(r, s + 1), last);
  }
  finish_normals(first);
  return {first, last + 1};
}

void MeshBuilder::finish_normals(std::size_t first) {
  for (std::size_t v = first; v < mesh_.normal_in_world.size(); ++v) {
    glm::dvec3& normal = mesh_.normal_in_world[v];
    const double length = glm::length(normal);
    normal = length > 0.0 ? normal / length : glm::dvec3(0.0, 1.0, 0.0);
  }
}

void MeshBuilder::add_ellipsoid(const Ring& frame,
                                double half_height,
                                std::size_t segments) {
  const std::size_t rows = segments / 2;
  std::vector<Ring> rings;
  for (std::size_t row = 0; row <= rows; ++row) {
    const double angle =
        std::numbers::pi * static_cast<double>(row) / static_cast<double>(rows);
    Ring ring = frame;
    ring.centre -= half_height * std::cos(angle) * frame.along;
    ring.half_width *= std::sin(angle);
    ring.half_depth *= std::sin(angle);
    rings.push_back(ring);
  }
  (void)add_turned(rings, segments);
}

}  // namespace marey::recordings
