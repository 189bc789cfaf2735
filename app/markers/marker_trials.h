// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/markers/repair_json.h"
#include "app/shell/console.h"
#include "core/body.h"
#include "reconstruct/markers/solve_markers.h"
#include "recordings/markers/marker_file.h"

namespace marey::app {

/// A file of labelled markers, and its results.
struct MarkerTrial {
  std::string name;  ///< Name of its folder among the results.
  std::filesystem::path path;
  recordings::MarkerFile file;  ///< Without its tracks, which are in `repair`.
  std::string prefix;           ///< Text before the subject's labels: "Bob:".
  /// The labels without the prefix. They identify a marker over several trials.
  /// repair.repaired has these labels too; repair.as_read has the file's.
  std::vector<std::string> labels;
  Repair repair;
  std::optional<reconstruct::SolvedMarkers> solved;  ///< nullopt: too few markers.
  std::vector<std::string> avatars;                  ///< Result files of the avatars.
  std::size_t samples_predicted = 0;                 ///< Samples of the written markers.
  std::size_t samples_empty = 0;
};

/// Makes a trial of a file that was read, and prints its notes. Errors (kBadInput): no
/// marker is seen in any frame.
[[nodiscard]] Result<MarkerTrial> make_marker_trial(const std::filesystem::path& path,
                                                    std::string name,
                                                    recordings::MarkerFile file,
                                                    Console& console);

/// Reads every file and prints its notes. A trial's name is its file's stem; the second
/// file with the same stem, in the order given, is STEM-2.
///
/// Errors (kBadInput): a file that cannot be read, is given twice, or is a result that
/// would be overwritten; a file without markers in any frame.
[[nodiscard]] Result<std::vector<MarkerTrial>> read_trials(
    std::span<const std::filesystem::path> paths,
    const recordings::MarkerReadOptions& options,
    const std::filesystem::path& out,
    Console& console);

/// Removes or corrects wrong samples and fills gaps, trials in parallel. Returns the
/// checked tracks without filled samples, one per trial, with MarkerTrial::labels.
[[nodiscard]] std::vector<MarkerTracks> repair_trials(std::vector<MarkerTrial>& trials,
                                                      const Progress& progress);

/// Solves every trial, in parallel. The results do not depend on the number of cores.
void solve_trials(const Body& body,
                  std::vector<MarkerTrial>& trials,
                  const Progress& progress);

/// Returns the number of frames of the file with at least one marker.
[[nodiscard]] std::size_t frames_with_markers(const MarkerTrial& trial);

}  // namespace marey::app
