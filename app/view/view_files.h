// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/view/view_recording.h"
#include "core/base/result.h"

namespace marey::app {

/// What to show.
struct ViewChoice {
  std::filesystem::path what;  ///< A file, a folder of results, or one trial's in it.
  std::string trial;           ///< Of a folder with several; empty: the first.
  std::vector<std::filesystem::path> avatars;  ///< To put the motion on.
};

/// Reads a motion (.bvh, .amc, .glb, .gltf, .vrm, .vrma), labelled markers (.c3d, .trc),
/// a calibration (calibration.toml), a take of `marey live`, or the results of `marey
/// process` or `marey fit`:
/// the performer with its doubt, avatars, markers, cameras, gaps, contacts and the
/// residual over time, as far as they are there.
///
/// Errors (kBadInput): those of reading; another kind of file; a folder that holds no
/// results; a trial that is not there; an avatar without a motion to put on it.
[[nodiscard]] Result<ViewedRecording> read_view(const ViewChoice& choice);

}  // namespace marey::app
