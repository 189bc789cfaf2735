// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace marey::app {

/// calibration.toml as a run finds it before it begins.
struct EarlierCalibration {
  std::filesystem::path file;
  /// When it was written; nullopt: there is none.
  std::optional<std::filesystem::file_time_type> written;
};

[[nodiscard]] EarlierCalibration find_calibration(const std::filesystem::path& out);

/// What to say after a run that failed and left the file as it was; empty where there was
/// none, or the run wrote another.
[[nodiscard]] std::string kept_text(const EarlierCalibration& earlier);

/// What to say before a run that takes its cameras from the file: when it was made, and
/// whether the session was changed since. Empty where there is none.
[[nodiscard]] std::string used_text(const EarlierCalibration& earlier,
                                    const std::filesystem::path& session);

}  // namespace marey::app
