// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the bone that a marker moves with, and its place there.

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "core/skeleton.h"
#include "reconstruct/markers/marker_instants.h"

namespace marey::reconstruct {

/// Place of a marker on a bone over the snapshots that show it.
struct MarkerPlace {
  HumanBone bone{};
  Eigen::Vector3d p_in_bone{0.0, 0.0, 0.0};  ///< The median, coordinate by coordinate.
  /// Its stray from there: root mean square over coordinates, of the nearer nine tenths.
  double stray_m = 0.0;
};

/// Prior of a marker's stray with skin. [m]
inline constexpr double kUsualStray_m = 0.010;

/// Measures the stray of every marker of the model from its place over the solved
/// snapshots, and sets its sigma. Returns the root mean square distance of all of them.
/// [m]
double measure_strays(std::span<const Snapshot> snapshots,
                      const ModelLabels& labels,
                      MarkerModel& model);

/// The segments that a marker without a known place may belong to.
struct SegmentRules {
  Proportions proportions;
  double stature_m = 0.0;
  /// Per bone: markers that were named for it and move with it.
  std::array<int, kHumanBoneCount> named_markers{};
};

/// Computes the place of a label's marker on a bone; nullopt if fewer than three solved
/// snapshots show it.
[[nodiscard]] std::optional<MarkerPlace> place_on(std::span<const Snapshot> snapshots,
                                                  const MarkerModel& model,
                                                  std::size_t label,
                                                  HumanBone bone);

/// Returns the place on the bone from which the marker strays least, among bones with at
/// least two named markers and with the place within their soft tissue. Returns nullopt
/// if there is none, or if it strays equally little from two bones that are not
/// neighbours.
[[nodiscard]] std::optional<MarkerPlace> best_segment(std::span<const Snapshot> snapshots,
                                                      const MarkerModel& model,
                                                      std::size_t label,
                                                      const SegmentRules& rules);

}  // namespace marey::reconstruct
