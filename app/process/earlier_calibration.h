// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace marey::app {

/// State of calibration.toml before a run begins.
struct EarlierCalibration {
  std::filesystem::path file;
  /// Time of its last change; nullopt if the file does not exist.
  std::optional<std::filesystem::file_time_type> written;
};

[[nodiscard]] EarlierCalibration find_calibration(const std::filesystem::path& out);

/// Returns the warning for a run that failed and left the file unchanged. Empty if there
/// was no file, or if the run wrote a new one.
[[nodiscard]] std::string kept_text(const EarlierCalibration& earlier);

/// Returns the message for a run that reads its cameras from the file: the time at which
/// it was written, and whether the session was changed after that. Empty if there is no
/// file.
[[nodiscard]] std::string used_text(const EarlierCalibration& earlier,
                                    const std::filesystem::path& session);

}  // namespace marey::app
