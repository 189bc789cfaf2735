// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "app/markers/marker_trials.h"
#include "core/base/result.h"
#include "core/body.h"

namespace marey::app {

/// Writes what is known of a trial into `folder`: markers.c3d and markers.trc without
/// gaps and, where it is solved, the motion as write_motion() has it, motion.mot, and the
/// motion on every avatar. Fills the trial's avatars and counts of samples. Each file
/// appears whole or not at all. Errors: the disk; an avatar that cannot be read.
[[nodiscard]] Status write_trial(const Body& body,
                                 std::span<const std::filesystem::path> avatars,
                                 const std::filesystem::path& folder,
                                 MarkerTrial& trial);

/// Errors (kBadInput): an avatar that cannot take a motion, or two of them whose results
/// would have one name, or a name that other results have.
[[nodiscard]] Status check_avatars(std::span<const std::filesystem::path> avatars);

}  // namespace marey::app
