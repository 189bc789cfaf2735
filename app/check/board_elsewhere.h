// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/result.h"
#include "core/detection.h"
#include "recordings/session/session.h"

namespace marey::app {

/// What to say of a camera that sees the session's board in none of a trial's frames,
/// where its video shows that board in others, mirrored, or of another family (nullopt
/// where it does not). Precondition: the target is a board. Cost: reads the video.
[[nodiscard]] std::optional<Error> board_elsewhere(const recordings::Session& session,
                                                   const recordings::Trial& trial,
                                                   const CameraDetections& camera);

}  // namespace marey::app
