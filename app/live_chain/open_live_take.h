// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/live_chain/live_settings.h"
#include "app/motion/retarget_files.h"
#include "core/base/result.h"
#include "core/body.h"
#include "recordings/session/calibration_file.h"
#include "recordings/takes/live_take.h"

namespace marey::app {

/// Folder in a take that holds its avatars.
inline constexpr const char* kLiveTakeAvatars = "avatars";

/// The take of a run again: what is to be replayed.
struct OpenedTake {
  recordings::LiveTake take;
  recordings::Calibration calibration;
  Body body;
  std::vector<OpenedAvatar> avatars;
  LiveSettings settings;
};

/// Errors (kBadInput): a file of the folder that is missing or not as it was written.
[[nodiscard]] Result<OpenedTake> open_live_take(const std::filesystem::path& folder);

}  // namespace marey::app
