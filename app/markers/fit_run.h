// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/markers/fit_json.h"
#include "app/markers/marker_trials.h"
#include "app/shell/console.h"
#include "core/base/result.h"
#include "core/finding.h"
#include "core/marker_map.h"

namespace marey::app {

/// Arguments of `marey fit`.
struct FitArguments {
  std::vector<std::filesystem::path> in;  ///< C3D or TRC, of one subject.
  std::filesystem::path out;              ///< Folder of the results.
  std::filesystem::path map;              ///< Meaning of the labels; may be empty.
  std::filesystem::path subject;          ///< subject.toml of an earlier fit, or empty.
  std::string name;
  std::optional<double> stature_m;
  std::optional<double> mass_kg;
  std::vector<std::filesystem::path> avatars;
  std::string up;    ///< "+Z", checked; empty: as in the files.
  std::string unit;  ///< "mm", checked; empty: as in the files.
  bool json = false;
};

/// Reads FitArguments::map and FitArguments::subject, where given: the map is returned,
/// the subject becomes the run's body. Errors (kBadInput): a file that cannot be read; a
/// subject without markers.
[[nodiscard]] Result<std::optional<MarkerMap>> read_fit_givens(const FitArguments& args,
                                                               FitRun& run);

/// Repairs the trials of a run, fits the subject to them unless it was given, and solves
/// their motions. Writes no files. The result does not depend on the number of cores.
/// Errors (kBadInput), with the files of FitArguments::in: labels of which none is known;
/// trials of different units; a body that is not of human size; exchanged sides; no frame
/// with six of the subject's markers. Precondition: FitRun::trials has at least one.
[[nodiscard]] Status solve_fit(const FitArguments& args,
                               const std::optional<MarkerMap>& map,
                               Console& console,
                               FitRun& run);

/// Returns the poor findings on a solved run, and sets FitRun::checks. Exchanged sides
/// and wrong axes are the cause of others and are returned alone.
[[nodiscard]] std::vector<Finding> assess_fit_run(const FitArguments& args, FitRun& run);

}  // namespace marey::app
