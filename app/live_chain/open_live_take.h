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

/// An opened take, ready for a replay.
struct OpenedTake {
  recordings::LiveTake take;
  recordings::Calibration calibration;
  Body body;
  std::vector<OpenedAvatar> avatars;
  LiveSettings settings;
};

/// Opens a take. Errors (kBadInput): a file of the folder is missing or was changed.
[[nodiscard]] Result<OpenedTake> open_live_take(const std::filesystem::path& folder);

}  // namespace marey::app
