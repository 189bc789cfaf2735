// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/view/view_recording.h"
#include "core/base/result.h"

namespace marey::app {

/// Choice of the data to show.
struct ViewChoice {
  std::filesystem::path what;  ///< A file, a folder of results or of one trial.
  std::string trial;           ///< In a folder of results; empty: the first.
  std::vector<std::filesystem::path> avatars;  ///< Retargeting targets.
};

/// Reads a motion (.bvh, .amc, .glb, .gltf, .vrm, .vrma), labelled markers (.c3d, .trc),
/// a calibration (calibration.toml), a take of `marey live`, or the results of `marey
/// process` or `marey fit`. Returns the available data: the performer with its
/// uncertainty, avatars, markers, cameras, gaps, contacts and the residual over time.
///
/// Errors (kBadInput): those of the readers; another kind of file; a folder without
/// results; an unknown trial; an avatar without a motion.
[[nodiscard]] Result<ViewedRecording> read_view(const ViewChoice& choice);

}  // namespace marey::app
