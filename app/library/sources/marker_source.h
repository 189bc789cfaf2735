// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/library/sources/source_motion.h"
#include "core/base/result.h"
#include "recordings/markers/labelled_markers.h"

namespace marey::app {

/// Options of a library for labelled markers.
struct MarkerSourceOptions {
  std::optional<double> rate_hz;  ///< Instead of the file's.
};

/// Solves the motions of labelled markers as `marey repair` and `marey fit` do, one for
/// each person whose labels have a name of their own ("Bob:LASI"). Each person's body is
/// fitted to these markers alone, unless the folder of `path` has a kMarkerSubjectFile;
/// kMarkerMapFile there gives the meaning of labels. Writes nothing.
///
/// Figures: residual_mm (root mean square distance of the markers from the body),
/// removed_samples and filled_samples of the repair. Findings of the fit are remarks.
/// Events of the file become events of the motion.
/// Errors (kBadInput), with the file: more than 2000 markers; those of read_fit_givens()
/// and solve_fit(), if no person can be solved. The result does not depend on the number
/// of cores.
[[nodiscard]] Result<std::vector<SourceMotion>> solve_marker_source(
    const std::filesystem::path& path,
    recordings::MarkerFile file,
    const MarkerSourceOptions& options = {});

/// Applies solve_marker_source() to a .c3d or .trc file.
[[nodiscard]] Result<std::vector<SourceMotion>> read_marker_source(
    const std::filesystem::path& path, const MarkerSourceOptions& options = {});

}  // namespace marey::app
