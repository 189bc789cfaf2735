// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: with which bone a marker moves, and where on it.

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "core/skeleton.h"
#include "reconstruct/marker_instants.h"

namespace marey::reconstruct {

/// Where a marker was on a bone over the snapshots that show it.
struct MarkerPlace {
  HumanBone bone{};
  Eigen::Vector3d p_in_bone{0.0, 0.0, 0.0};  ///< The median, coordinate by coordinate.
  /// How far it strays from there: root mean square over coordinates, of the nearer nine
  /// tenths.
  double stray_m = 0.0;
};

/// How far a marker strays with skin before anything is measured. [m]
inline constexpr double kUsualStray_m = 0.010;

/// Measures how far every marker of the model strays from its place over the solved
/// snapshots, into its sigma. Returns the distance of all of them, root mean square. [m]
double measure_strays(std::span<const Snapshot> snapshots,
                      const ModelLabels& labels,
                      MarkerModel& model);

/// Which segments a marker without a known place may belong to.
struct SegmentRules {
  Proportions proportions;
  double stature_m = 0.0;
  /// Per bone: markers that were named for it and move with it.
  std::array<int, kHumanBoneCount> named_markers{};
};

/// Of a label's marker on a bone; nullopt where fewer than three solved snapshots show
/// it.
[[nodiscard]] std::optional<MarkerPlace> place_on(std::span<const Snapshot> snapshots,
                                                  const MarkerModel& model,
                                                  std::size_t label,
                                                  HumanBone bone);

/// Returns the place on the bone from which the marker strays least, among bones with two
/// named markers at least and with the place within their flesh. Returns nullopt where
/// there is none, and where it strays as little from two bones that are no neighbours.
[[nodiscard]] std::optional<MarkerPlace> best_segment(std::span<const Snapshot> snapshots,
                                                      const MarkerModel& model,
                                                      std::size_t label,
                                                      const SegmentRules& rules);

}  // namespace marey::reconstruct
