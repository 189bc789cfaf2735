// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/earlier_calibration.h"

#include <array>
#include <chrono>
#include <ctime>

namespace marey::app {
namespace {

namespace fs = std::filesystem;

std::optional<fs::file_time_type> time_of(const fs::path& file) {
  std::error_code failed;
  const auto time = fs::last_write_time(file, failed);
  if (failed) return std::nullopt;
  return time;
}

/// Returns a time as "2026-11-21 18:05", in local time.
std::string time_words(fs::file_time_type time) {
  const auto seconds =
      std::chrono::floor<std::chrono::seconds>(std::chrono::file_clock::to_sys(time));
  const std::time_t at = std::chrono::system_clock::to_time_t(seconds);
  std::tm local{};
  std::array<char, 40> text{};
  if (localtime_r(&at, &local) == nullptr) return "unknown";
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M", &local);
  return text.data();
}

}  // namespace

EarlierCalibration find_calibration(const fs::path& out) {
  const fs::path file = out / "calibration.toml";
  return {file, time_of(file)};
}

std::string kept_text(const EarlierCalibration& earlier) {
  if (!earlier.written || time_of(earlier.file) != earlier.written) return {};
  return earlier.file.string() + " was written by an earlier run (" +
         time_words(*earlier.written) +
         "). It is kept, and marey solve would use its cameras";
}

std::string used_text(const EarlierCalibration& earlier, const fs::path& session) {
  if (!earlier.written) return {};
  std::error_code ignored;
  const fs::path file =
      fs::is_directory(session, ignored) ? session / "session.toml" : session;
  std::string words = "cameras are those of " + earlier.file.string() + ", written " +
                      time_words(*earlier.written);
  const auto edited = time_of(file);
  if (edited && *edited > *earlier.written) {
    words += ", before " + file.string() + " was changed";
  }
  return words;
}

}  // namespace marey::app
