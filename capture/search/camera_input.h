// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/frame_range.h"
#include "core/base/ids.h"
#include "core/base/time.h"

namespace marey::capture {

/// One camera's recording of a trial.
struct CameraInput {
  std::filesystem::path path;  ///< A video, or a folder of images.
  CameraId camera{};
  std::string name;                 ///< Name for messages; the path if empty.
  std::optional<FrameRate> rate;    ///< Overrides the container's; a folder needs it.
  Timestamp offset{0};              ///< Frame k was exposed at k / rate + offset.
  std::optional<FrameRange> range;  ///< All frames when absent.
};

}  // namespace marey::capture
