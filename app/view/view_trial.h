// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/view/view_recording.h"
#include "core/base/result.h"

namespace marey::app {

/// Reads one trial's folder of results: the part of read_view() for it.
[[nodiscard]] Result<ViewedRecording> read_trial_view(
    const std::filesystem::path& trial_folder);

/// The trials of a folder of results, by name: subfolders that hold a solved motion.
[[nodiscard]] std::vector<std::string> solved_trials(const std::filesystem::path& folder);

}  // namespace marey::app
