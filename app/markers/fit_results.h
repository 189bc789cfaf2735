// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "app/markers/marker_trials.h"
#include "core/base/result.h"
#include "core/body.h"

namespace marey::app {

/// Writes the results of a trial into `folder`: markers.c3d and markers.trc with gaps
/// filled and, if the trial is solved, the motion by write_motion(), motion.mot, and the
/// motion on every avatar. Sets the trial's avatars and sample counts. Each file appears
/// whole or not at all. Errors: the disk; an avatar that cannot be read.
[[nodiscard]] Status write_trial(const Body& body,
                                 std::span<const std::filesystem::path> avatars,
                                 const std::filesystem::path& folder,
                                 MarkerTrial& trial);

/// Checks the avatars. Errors (kBadInput): an avatar that cannot take a motion; two
/// avatars whose results would have one name; a name that other results have.
[[nodiscard]] Status check_avatars(std::span<const std::filesystem::path> avatars);

}  // namespace marey::app
