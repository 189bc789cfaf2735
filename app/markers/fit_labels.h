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

/// The labels of all trials, united by their names, and what they mean.
struct FitLabels {
  std::vector<std::string> labels;  ///< In the order in which they first come.
  reconstruct::MarkerNames names;
  std::vector<std::size_t> samples;  ///< Per label: how often it was seen.
};

/// Names the labels of `trials`, which have none of `prefixes` before them; what `map`
/// says, with or without these, goes before what they seem to say.
/// Errors (kBadInput): apply_map()'s; none of the labels is known.
[[nodiscard]] Result<FitLabels> name_labels(std::span<const MarkerTracks> trials,
                                            std::span<const std::string> prefixes,
                                            const std::optional<MarkerMap>& map);

/// Returns the labels that a fit looks at: without those to be ignored and computed ones.
[[nodiscard]] std::vector<reconstruct::NamedMarker> used_labels(const FitLabels& labels);

/// A subject, and what speaks against the labels.
struct SubjectFit {
  reconstruct::MarkersFit fit;
  /// How far markers are from where they are on others, over how far people differ: the
  /// median; about 1.
  double places_off = 0.0;
  /// The same if left were right: given where that is far better.
  std::optional<double> mirrored_places_off;
};

/// fit_markers() of all labels but those that are to be ignored. Where it fails, or
/// puts markers where they are on nobody, it looks whether left and right are exchanged.
///
/// Errors (kBadInput, `where` empty): fit_markers()'s; markers of a body of no human
/// size; left and right exchanged.
[[nodiscard]] Result<SubjectFit> fit_subject_to(const reconstruct::MarkerSubject& subject,
                                                std::span<const MarkerTracks> trials,
                                                const FitLabels& labels,
                                                const Progress& progress);

}  // namespace marey::app
