// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/view/view_recording.h"
#include "core/base/result.h"

namespace marey::app {

/// Is this a take of `marey live`: its folder, or the live.sqlite in it?
[[nodiscard]] bool is_live_take(const std::filesystem::path& what);

/// The performer and the avatars of a live take as they were live, made again of what the
/// cameras saw, and what was measured of whom. Instants that the run passed over show the
/// one before; of a longer pause than ten seconds the rest is left out, and told.
/// Errors: open_live_take()'s, LiveChain::make()'s; no instant has a body (kBadInput).
/// Cost: a few milliseconds an instant.
[[nodiscard]] Result<ViewedRecording> read_live_take_view(
    const std::filesystem::path& what);

}  // namespace marey::app
