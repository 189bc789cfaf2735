// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/view/view_recording.h"
#include "core/base/result.h"

namespace marey::app {

/// Reads the folder of results of one trial; part of read_view().
[[nodiscard]] Result<ViewedRecording> read_trial_view(
    const std::filesystem::path& trial_folder);

/// Returns the names of the trials of a folder of results: subfolders with a solved
/// motion.
[[nodiscard]] std::vector<std::string> solved_trials(const std::filesystem::path& folder);

}  // namespace marey::app
