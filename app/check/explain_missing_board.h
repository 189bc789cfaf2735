// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/result.h"
#include "core/detection.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Returns an error for a camera that does not see the session's board in any frame of
/// the trial, if other frames of its video show that board, or if the video shows it
/// mirrored or in another tag family. Otherwise nullopt. Precondition: the target is a
/// board. Cost: reads the video.
[[nodiscard]] std::optional<Error> explain_missing_board(
    const recordings::Session& session,
    const recordings::Trial& trial,
    const CameraDetections& camera);

}  // namespace marey::app
