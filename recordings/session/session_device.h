// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "recordings/base/toml_reader.h"
#include "recordings/session/session.h"

namespace marey::recordings {

/// Keys of [[camera]] for recording.
inline constexpr std::array<std::string_view, 8> kCameraKeys{
    "name", "device", "width", "height", "fps", "exposure_s", "focus", "gain"};

/// Reads the device of a [[camera]]; returns nullopt if it names none. Mistakes: settings
/// without a device; a device that another camera uses.
[[nodiscard]] std::optional<SessionDevice> read_device(TomlReader& camera,
                                                       const Session& session);

/// Sets the videos of a trial without `videos` to the output of `marey record`:
/// TRIAL/CAMERA.mkv next to session.toml, for every camera with a device. Returns false
/// if no camera has one.
[[nodiscard]] bool add_recorded_videos(const Session& session, Trial& trial);

}  // namespace marey::recordings
