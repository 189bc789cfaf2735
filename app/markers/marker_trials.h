// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/markers/repair_figures.h"
#include "app/shell/console.h"
#include "core/body.h"
#include "reconstruct/markers/solve_markers.h"
#include "recordings/markers/marker_file.h"

namespace marey::app {

/// One file of labelled markers, and what was made of it.
struct MarkerTrial {
  std::string name;  ///< Of its folder among the results.
  std::filesystem::path path;
  recordings::MarkerFile file;  ///< Without its tracks, which are in `repair`.
  std::string prefix;           ///< What stands before the subject's labels: "Bob:".
  /// The labels without it: by these a marker is the same in several trials. They are
  /// those of repair.repaired, too; repair.as_read has the file's.
  std::vector<std::string> labels;
  Repair repair;
  std::optional<reconstruct::SolvedMarkers> solved;  ///< None: too few markers.
  std::vector<std::string> avatars;                  ///< Files of other bodies.
  std::size_t samples_predicted = 0;  ///< Of the markers that were written.
  std::size_t samples_empty = 0;
};

/// Reads every file and tells its notes. Each trial is called by its file's stem; of
/// files of one stem the second is STEM-2, in the order given.
///
/// Errors (kBadInput): a file that cannot be read, is given twice, or is a result that
/// would be written over; no marker is seen in any frame.
[[nodiscard]] Result<std::vector<MarkerTrial>> read_trials(
    std::span<const std::filesystem::path> paths,
    const recordings::MarkerReadOptions& options,
    const std::filesystem::path& out,
    Console& console);

/// Takes out or puts right wrong samples and fills gaps, trials side by side. Gives the
/// checked tracks without what was filled, trial by trial, with MarkerTrial::labels.
[[nodiscard]] std::vector<MarkerTracks> repair_trials(std::vector<MarkerTrial>& trials,
                                                      const Progress& progress);

/// Solves every trial, side by side. The same results whatever the number of cores.
void solve_trials(const Body& body,
                  std::vector<MarkerTrial>& trials,
                  const Progress& progress);

/// Frames in which any marker was seen, in the file.
[[nodiscard]] std::size_t frames_with_markers(const MarkerTrial& trial);

}  // namespace marey::app
