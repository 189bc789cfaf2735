// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/correlated_error_share.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "reconstruct/tags/body_model.h"

namespace marey::reconstruct {
namespace {

// Simulated sessions with errors of cameras show 0.03 and more, corners without any 0.01.
constexpr double kMinShare = 0.01;
constexpr double kMaxShare = 1.0 / 7.0;
constexpr double kOutlierMedians = 6.0;
constexpr double kCoordinates = 8.0;
constexpr double kTagFreedom = 6.0;

using Corners = Eigen::Matrix<double, 8, 1>;

/// All sightings of one tag by one camera.
struct Cell {
  double sightings = 0.0;
  Corners sum = Corners::Zero();
  double squares = 0.0;
};

/// Computes the residual of one sighting over its sigma; nullopt for an outlier.
std::optional<Corners> residual(const SubjectBundle& bundle,
                                const TagSighting& sighting,
                                std::span<const Camera> cameras,
                                const Posture& posture) {
  const auto predicted = predicted_corners_px(bundle.model, sighting, cameras, posture);
  if (!predicted) return std::nullopt;
  Corners out;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2 off = (*predicted)[i] - sighting.detection->corners_px[i];
    if (glm::length(off) > kOutlierMedians * bundle.median_px) return std::nullopt;
    const auto row = static_cast<Eigen::Index>(2 * i);
    out[row] = off.x / sighting.detection->sigma_px;
    out[row + 1] = off.y / sighting.detection->sigma_px;
  }
  return out;
}

}  // namespace

double estimate_correlated_error_share(const SubjectBundle& bundle,
                                       std::span<const Camera> cameras) {
  std::map<std::pair<std::size_t, CameraId>, Cell> cells;
  for (const BundleFrame& frame : bundle.frames) {
    for (const TagSighting& s : frame.sightings) {
      if (!bundle.model.place(s.tag)) continue;
      const auto off = residual(bundle, s, cameras, frame.posture);
      if (!off) continue;
      Cell& cell = cells[{s.tag, s.camera}];
      cell.sightings += 1.0;
      cell.sum += *off;
      cell.squares += off->squaredNorm();
    }
  }
  double between = 0.0;
  double within = 0.0;
  double within_freedom = 0.0;
  double sightings = 0.0;
  double coordinates = 0.0;
  std::set<std::size_t> tags;
  for (const auto& [key, cell] : cells) {
    if (cell.sightings < 2.0) continue;
    const double mean_squares = cell.sum.squaredNorm() / cell.sightings;
    between += mean_squares;
    within += cell.squares - mean_squares;
    within_freedom += kCoordinates * (cell.sightings - 1.0);
    sightings += cell.sightings;
    coordinates += kCoordinates;
    tags.insert(key.first);
  }
  const double left =
      coordinates - kTagFreedom * static_cast<double>(tags.size()) - kShapeCount;
  if (left <= 0.0 || within <= 0.0) return kMaxShare;
  const double own = within / within_freedom;
  // E[between] = left (own + common n), n being the mean number of sightings in a cell.
  const double mean_sightings = sightings * kCoordinates / coordinates;
  const double common = (between / left - own) / mean_sightings;
  return std::clamp(common / (common + own), kMinShare, kMaxShare);
}

}  // namespace marey::reconstruct
