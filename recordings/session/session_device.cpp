// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/session_device.h"

#include <algorithm>

#include "core/base/in_quotes.h"
#include "recordings/base/text_reader.h"

namespace marey::recordings {
namespace {

// These detect wrong units; the device itself reports its capabilities.
constexpr Limits kSide{16, 16384, "px"};
constexpr Limits kDeviceRate{1, 1000, "frames per second"};
constexpr Limits kExposure{1e-6, 1.0, "s"};
constexpr Limits kDriverUnits{-1e6, 1e6};

}  // namespace

std::optional<SessionDevice> read_device(TomlReader& camera, const Session& session) {
  if (!camera.has("device")) {
    for (const std::string& key : camera.keys()) {
      if (key == "name") continue;
      camera.fail(key,
                  in_quotes(key) + " is for a camera to record from, and none is named",
                  "add device = \"/dev/video0\", or remove the key");
    }
    return std::nullopt;
  }
  SessionDevice device;
  device.line = camera.line("device");
  device.path = camera.text("device");
  if (camera.has("width") || camera.has("height")) {
    device.width_px = camera.integer("width", kSide);
    device.height_px = camera.integer("height", kSide);
  }
  if (camera.has("fps")) device.rate = {camera.number("fps", kDeviceRate)};
  if (camera.has("exposure_s"))
    device.exposure_s = camera.number("exposure_s", kExposure);
  if (camera.has("focus")) device.focus = camera.integer("focus", kDriverUnits);
  if (camera.has("gain")) device.gain = camera.integer("gain", kDriverUnits);
  if (!camera.ok()) return std::nullopt;
  if (device.path.empty()) {
    camera.fail("device", "the device has no name", "name it: \"/dev/video0\"");
  }
  const auto same = [&](const std::optional<SessionDevice>& other) {
    return other && other->path == device.path;
  };
  if (std::any_of(session.devices.begin(), session.devices.end(), same)) {
    camera.fail("device",
                "two cameras have the device " + in_quotes(device.path),
                "name each camera's own: marey doctor lists them");
  }
  return device;
}

bool add_recorded_videos(const Session& session, Trial& trial) {
  const auto folder = session.file.parent_path() / trial.name;
  for (std::size_t c = 0; c < session.devices.size(); ++c) {
    if (!session.devices[c]) continue;
    trial.videos.push_back({CameraId{static_cast<int>(c)},
                            folder / (session.cameras[c] + ".mkv"),
                            std::nullopt,
                            trial.line});
  }
  trial.is_recorded = !trial.videos.empty();
  return trial.is_recorded;
}

}  // namespace marey::recordings
