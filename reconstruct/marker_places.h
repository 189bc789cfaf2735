// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: with which bone a marker moves, and where on it.

#include <cstddef>
#include <optional>
#include <span>

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

/// What moves with a segment but lies farther from it than a limb is long is on somebody
/// else, or on the floor.
[[nodiscard]] inline bool within_reach(const MarkerPlace& place) {
  constexpr double kReach_m = 0.6;
  return place.p_in_bone.norm() < kReach_m;
}

/// Of a label's marker on a bone; nullopt where fewer than three solved snapshots show
/// it.
[[nodiscard]] std::optional<MarkerPlace> place_on(std::span<const Snapshot> snapshots,
                                                  const MarkerModel& model,
                                                  std::size_t label,
                                                  HumanBone bone);

/// On the bone from which it strays least.
[[nodiscard]] std::optional<MarkerPlace> best_segment(std::span<const Snapshot> snapshots,
                                                      const MarkerModel& model,
                                                      std::size_t label);

}  // namespace marey::reconstruct
