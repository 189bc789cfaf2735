// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/marker_tracks.h"
#include "reconstruct/markers/fit_markers.h"

namespace marey::reconstruct {

/// Labels that look exchanged in all trials.
struct LabelExchange {
  std::vector<std::pair<std::string, std::string>> labels;
  /// "the legs", "the arms", if all their labels are exchanged; empty: single labels.
  std::string limbs;
  double cost_before = 0.0;  ///< label_cost() without the exchange.
  double cost_after = 0.0;   ///< label_cost() with the exchange.
};

/// Computes the misfit between a body and its labels: squared distances of markers from
/// their landmarks over their variance between people, squared strays over 10 mm, and a
/// constant for each label that is left out or moved to another segment. About 2 per
/// label if all are right.
[[nodiscard]] double label_cost(const MarkersFit& fit,
                                std::span<const NamedMarker> labels);

/// Finds the exchange of labels that explains the markers far better than `fit` does, if
/// there is one: left and right legs or arms, or two single labels, one of which is at
/// the other's expected place. Every candidate is fitted again to some frames of every
/// trial; there are none if no label is suspicious, and at most eight.
/// Deterministic. Precondition: `fit` is that of these trials and labels.
[[nodiscard]] std::optional<LabelExchange> find_exchange(
    const MarkerSubject& subject,
    std::span<const MarkerTracks> trials,
    std::span<const NamedMarker> labels,
    const MarkersFit& fit);

}  // namespace marey::reconstruct
