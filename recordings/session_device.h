// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "recordings/session.h"
#include "recordings/toml_reader.h"

namespace marey::recordings {

/// Keys of [[camera]] that say how to record from it.
inline constexpr std::array<std::string_view, 8> kCameraKeys{
    "name", "device", "width", "height", "fps", "exposure_s", "focus", "gain"};

/// What a [[camera]] says of its device; nullopt when it names none. Mistake: settings
/// without a device; a device that another camera has.
[[nodiscard]] std::optional<SessionDevice> read_device(TomlReader& camera,
                                                       const Session& session);

/// Gives a trial without `videos` those that `marey record` makes: TRIAL/CAMERA.mkv of
/// every camera with a device, beside session.toml. False when no camera has one.
[[nodiscard]] bool add_recorded_videos(const Session& session, Trial& trial);

}  // namespace marey::recordings
