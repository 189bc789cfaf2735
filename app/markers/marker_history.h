// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/markers/repair_figures.h"

namespace marey::app {

/// What a written sample is.
enum class SampleFate : std::uint8_t {
  kMeasured,   ///< As it was read.
  kSwapped,    ///< Measured under another marker's name, and put right.
  kCluster,    ///< Filled: reconstruct::RepairMethod::kCluster.
  kStructure,  ///< kStructure.
  kSpline,     ///< kSpline.
  kPredicted,  ///< Where the solved body has it.
  kLeftEmpty,  ///< Not known.
};
inline constexpr std::size_t kSampleFateCount = 7;

/// "measured", "swapped", "cluster", "structure", "spline", "predicted", "left-empty":
/// the words of OUT.repair.csv where it has one.
[[nodiscard]] std::string_view name(SampleFate fate);

/// A trial's markers as they are written, and what each sample is.
struct MarkerHistory {
  MarkerTracks after;
  std::vector<SampleFate> fates;  ///< Like after.samples.
  std::vector<bool> is_removed;   ///< Likewise: one that was read here was wrong.

  [[nodiscard]] SampleFate fate(std::size_t frame, std::size_t marker) const {
    return fates[frame * after.markers() + marker];
  }
  [[nodiscard]] bool removed(std::size_t frame, std::size_t marker) const {
    return is_removed[frame * after.markers() + marker];
  }
};

/// `after`: the repaired tracks, completed by a skeleton or not. Linear in samples.
/// Precondition: `after` is as large as what was read.
[[nodiscard]] MarkerHistory history_of(const Repair& repair, MarkerTracks after);

/// Per marker its label, how many samples it has of each fate, and every run of samples
/// that are not as they were read; docs/formats/README.md, "The pages of labelled markers".
[[nodiscard]] nlohmann::ordered_json timeline_figures(const Repair& repair,
                                                      const MarkerHistory& history);

}  // namespace marey::app
