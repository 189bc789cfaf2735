// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/markers/repair_json.h"

namespace marey::app {

/// Origin of a written sample.
enum class SampleFate : std::uint8_t {
  kMeasured,   ///< As it was read.
  kExchanged,  ///< Measured under another marker's label, and corrected.
  kCluster,    ///< Filled: reconstruct::RepairMethod::kCluster.
  kStructure,  ///< Filled: reconstruct::RepairMethod::kStructure.
  kSpline,     ///< Filled: reconstruct::RepairMethod::kSpline.
  kPredicted,  ///< Computed from the solved body.
  kLeftEmpty,  ///< Unknown.
};
inline constexpr std::size_t kSampleFateCount = 7;

/// Returns "measured", "swapped", "cluster", "structure", "spline", "predicted" or
/// "left-empty": the words of OUT.repair.csv where that file has one.
[[nodiscard]] std::string_view name(SampleFate fate);

/// A trial's markers as they are written, and the origin of each sample.
struct MarkerHistory {
  MarkerTracks after;
  std::vector<SampleFate> fates;  ///< Indexed like after.samples.
  std::vector<bool> is_removed;   ///< Indexed like `fates`: a wrong sample was removed.

  [[nodiscard]] SampleFate fate(std::size_t frame, std::size_t marker) const {
    return fates[frame * after.markers() + marker];
  }
  [[nodiscard]] bool removed(std::size_t frame, std::size_t marker) const {
    return is_removed[frame * after.markers() + marker];
  }
};

/// Returns the history of a trial. `after` are the repaired tracks, optionally completed
/// by a skeleton. Linear in samples.
/// Precondition: `after` has as many frames and markers as the tracks that were read.
[[nodiscard]] MarkerHistory history_of(const Repair& repair, MarkerTracks after);

/// Returns for each marker its label, the number of samples of each fate, and every run
/// of samples that differ from the samples read; docs/formats/marker_pages.md.
[[nodiscard]] nlohmann::ordered_json timeline_json(const Repair& repair,
                                                   const MarkerHistory& history);

}  // namespace marey::app
