// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/open_live_take.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "recordings/session/subject_file.h"

namespace marey::app {
namespace {

/// Returns the cameras with these names, in this order; nullopt if one is missing.
std::optional<recordings::Calibration> cameras_of(const recordings::Calibration& all,
                                                  const std::vector<std::string>& names) {
  if (all.cameras.size() != names.size()) return std::nullopt;
  recordings::Calibration out;
  out.rms_px = all.rms_px;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all.cameras, name, &Camera::name);
    if (found == all.cameras.end()) return std::nullopt;
    const auto place = static_cast<std::size_t>(found - all.cameras.begin());
    out.cameras.push_back(*found);
    out.quality.push_back(all.quality[place]);
    out.clocks.push_back(all.clocks[place]);
  }
  return out;
}

}  // namespace

Result<OpenedTake> open_live_take(const std::filesystem::path& folder) {
  const auto file = folder / recordings::kLiveTakeFile;
  auto take = recordings::read_live_take(file);
  if (!take) return take.error();
  OpenedTake out;
  out.take = *std::move(take);
  auto settings = parse_live_settings(out.take.head.settings, file.string());
  if (!settings) return settings.error();
  out.settings = *std::move(settings);
  auto calibration = recordings::read_calibration(folder / "calibration.toml");
  if (!calibration) return calibration.error();
  const auto& names = out.take.head.cameras;
  auto cameras = cameras_of(*calibration, names);
  if (!cameras || out.settings.lag_known.size() > names.size()) {
    return bad_input((folder / "calibration.toml").string(),
                     "it does not hold the cameras of the take",
                     "copy it again from where the take was recorded");
  }
  out.calibration = *std::move(cameras);
  auto body = recordings::read_subject(folder / "subject.toml");
  if (!body) return body.error();
  out.body = *std::move(body);
  const bool is_early = out.settings.avatar_files.empty();
  for (const std::string& name :
       is_early ? out.settings.avatars : out.settings.avatar_files) {
    auto avatar =
        open_avatar(folder / kLiveTakeAvatars / std::filesystem::path(name).filename());
    if (!avatar) return avatar.error();
    out.avatars.push_back(*std::move(avatar));
  }
  return out;
}

}  // namespace marey::app
