// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/view/view_recording.h"
#include "core/base/result.h"

namespace marey::app {

/// Returns true for a take of `marey live`: its folder, or its live.sqlite.
[[nodiscard]] bool is_live_take(const std::filesystem::path& what);

/// Computes the performer and the avatars of a live take again from its detections, with
/// the source of each segment. An instant that the run skipped repeats the one before. A
/// pause longer than ten seconds is cut, with a remark.
/// Errors: those of open_live_take() and LiveChain::make(); no instant has a body
/// (kBadInput). Cost: a few milliseconds per instant.
[[nodiscard]] Result<ViewedRecording> read_live_take_view(
    const std::filesystem::path& what);

}  // namespace marey::app
