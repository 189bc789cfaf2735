// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tracks/enforce_rigid_distances.h"

#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace marey::reconstruct {
namespace {

constexpr double kStable_m = 0.005;
constexpr int kMinShared = 60;
constexpr double kNoise_m = 0.001;
constexpr int kSweeps = 5;
constexpr double kMaxSigmas = 1.5;

struct Bone {
  std::size_t other = 0;
  double length_m = 0.0;
  double variance_m2 = 0.0;
};

std::vector<std::vector<Bone>> stable_bones(const MarkerTracks& tracks,
                                            const MarkerDistances& distances) {
  std::vector<std::vector<Bone>> bones(tracks.markers());
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    for (const std::size_t other : distances.companions(m)) {
      const auto& pair = distances.between(m, other);
      if (pair.variance_m2 > kStable_m * kStable_m) break;
      if (pair.shared < kMinShared || pair.mean_m < kStable_m) continue;
      bones[m].push_back({other, pair.mean_m, pair.variance_m2 + kNoise_m * kNoise_m});
    }
  }
  return bones;
}

/// Computes one Gauss-Newton step of one marker, its fellows held.
glm::dvec3 pull(const MarkerSample& marker,
                const glm::dvec3& from,
                const std::vector<Bone>& bones,
                const MarkerTracks& tracks,
                std::size_t frame) {
  const double sigma_m = static_cast<double>(marker.sigma_m);
  const double own = 1.0 / (sigma_m * sigma_m);
  glm::dmat3 hessian(own);
  glm::dvec3 gradient = own * (marker.p_in_world - from);
  // All bones together count as three distances, because they are correlated.
  const double share = 1.0 / std::max<double>(3.0, static_cast<double>(bones.size()));
  for (const Bone& bone : bones) {
    const auto& other = tracks.at(frame, bone.other);
    if (!other) continue;
    const glm::dvec3 way = marker.p_in_world - other->p_in_world;
    const double apart_m = glm::length(way);
    if (apart_m < 1e-6) continue;
    const glm::dvec3 unit = way / apart_m;
    // A filled sample of a fellow constrains only as far as its sigma allows.
    const double other_sigma_m = static_cast<double>(other->sigma_m);
    const double precision = share / (bone.variance_m2 + other_sigma_m * other_sigma_m);
    hessian += precision * glm::outerProduct(unit, unit);
    gradient += precision * (apart_m - bone.length_m) * unit;
  }
  // Contradicting bones with nearly the same direction would move it far across: limited
  // by its sigma.
  const glm::dvec3 moved = marker.p_in_world - glm::inverse(hessian) * gradient - from;
  const double far_m = glm::length(moved);
  const double max_m = kMaxSigmas * sigma_m;
  return far_m > max_m ? from + (max_m / far_m) * moved : from + moved;
}

}  // namespace

void enforce_rigid_distances(const MarkerTracks& measured,
                             const MarkerDistances& distances,
                             MarkerTracks& repaired) {
  const auto bones = stable_bones(measured, distances);
  std::vector<glm::dvec3> from(repaired.markers());
  for (std::size_t f = 0; f < repaired.frames(); ++f) {
    std::vector<std::size_t> loose;
    for (std::size_t m = 0; m < repaired.markers(); ++m) {
      if (measured.at(f, m) || !repaired.at(f, m) || bones[m].empty()) continue;
      loose.push_back(m);
      from[m] = repaired.at(f, m)->p_in_world;
    }
    for (int sweep = 0; sweep < kSweeps && !loose.empty(); ++sweep) {
      for (const std::size_t m : loose) {
        auto& sample = *repaired.at(f, m);
        sample.p_in_world = pull(sample, from[m], bones[m], repaired, f);
      }
    }
  }
}

}  // namespace marey::reconstruct
