// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/marker_map.h"
#include "core/marker_tracks.h"
#include "reconstruct/labels/name_markers.h"
#include "reconstruct/markers/fit_markers.h"

namespace marey::app {

/// The labels of all trials, merged by name, and their meaning.
struct FitLabels {
  std::vector<std::string> labels;  ///< In order of first appearance.
  reconstruct::MarkerNames names;
  std::vector<std::size_t> samples;  ///< Number of samples of each label.
};

/// Determines the meaning of the labels of `trials`, which are without their `prefixes`.
/// Entries of `map`, with or without a prefix, override the meaning derived from a label.
/// Errors (kBadInput): apply_map()'s; none of the labels is known.
[[nodiscard]] Result<FitLabels> name_labels(std::span<const MarkerTracks> trials,
                                            std::span<const std::string> prefixes,
                                            const std::optional<MarkerMap>& map);

/// Returns the labels used by a fit: all except ignored and computed ones.
[[nodiscard]] std::vector<reconstruct::NamedMarker> used_labels(const FitLabels& labels);

/// A fitted subject, and evidence for wrong labels.
struct LabelledFit {
  reconstruct::MarkersFit fit;
  /// Distances of the markers from their average places on the body, divided by the
  /// standard deviation between people: the median over markers; about 1 for right
  /// labels.
  double places_off = 0.0;
  /// The same with left and right exchanged; set if it is much smaller.
  std::optional<double> mirrored_places_off;
};

/// Runs fit_markers() on the labels of used_labels(). If it fails, or puts markers at
/// implausible places, it checks whether left and right are exchanged.
///
/// Errors (kBadInput, `where` empty): fit_markers()'s; markers of a body that is not of
/// human size; left and right exchanged.
[[nodiscard]] Result<LabelledFit> fit_subject_to(
    const reconstruct::MarkerSubject& subject,
    std::span<const MarkerTracks> trials,
    const FitLabels& labels,
    const Progress& progress);

}  // namespace marey::app
