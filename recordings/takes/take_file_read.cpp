// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <limits>
#include <system_error>
#include <utility>

#include "recordings/base/sqlite.h"
#include "recordings/takes/take_file.h"
#include "recordings/takes/take_schema.h"

namespace marey::recordings {
namespace {

Error damaged(const std::string& file) {
  return bad_input(file,
                   "it is not the database of a take, or it is damaged",
                   "copy it again from where it was recorded, with the files " +
                       std::string(kTakeFile) + "-wal and -shm if they exist");
}

bool read_head(sqlite3* database, Take& take) {
  Statement head(database, "SELECT trial, started, finished FROM take");
  if (!head.next_row()) return false;
  take.trial = head.text(0);
  take.started = head.text(1);
  take.finished = head.integer(2) != 0;
  return true;
}

bool read_cameras(sqlite3* database, Take& take) {
  Statement rows(database,
                 "SELECT camera, name, file, width_px, height_px, rate_hz, device, "
                 "settings FROM camera ORDER BY camera");
  while (rows.next_row()) {
    if (rows.integer(0) != static_cast<std::int64_t>(take.cameras.size())) return false;
    TakeCamera camera;
    camera.name = rows.text(1);
    camera.file = rows.text(2);
    camera.width_px = static_cast<int>(rows.integer(3));
    camera.height_px = static_cast<int>(rows.integer(4));
    camera.rate.hz = rows.number(5);
    camera.device = rows.text(6);
    camera.settings = rows.text(7);
    // Limits for any camera; a size of zero is that of a camera that never sent a frame.
    constexpr double kMaxRate_hz = 1e4;
    constexpr std::int64_t kMaxSide_px = 100'000;
    const auto is_side = [](std::int64_t px) { return px >= 0 && px <= kMaxSide_px; };
    const bool can_be = camera.rate.hz > 0.0 && camera.rate.hz <= kMaxRate_hz &&
                        is_side(rows.integer(3)) && is_side(rows.integer(4)) &&
                        camera.file.find('/') == std::string::npos;
    if (!can_be) return false;
    take.cameras.push_back(std::move(camera));
  }
  return !rows.failed();
}

/// Returns true if the values of `frame` are impossible after the frames before it.
bool is_impossible(const TakeFrame& frame, const std::vector<TakeFrame>& before) {
  // 70 years: differences of such times do not overflow.
  constexpr Timestamp kMaxTime{std::int64_t{1} << 61};
  const Timestamp min_time = before.empty() ? Timestamp{0} : before.back().time;
  return frame.time < min_time || frame.time > kMaxTime;
}

bool read_frames(sqlite3* database, Take& take) {
  constexpr std::int64_t kMax = std::numeric_limits<int>::max();
  Statement rows(database,
                 "SELECT camera, number, time_ns, sequence, dropped_before, "
                 "time_is_arrival, damaged FROM frame ORDER BY camera, number");
  while (rows.next_row()) {
    const auto camera = static_cast<std::size_t>(rows.integer(0));
    if (camera >= take.cameras.size()) return false;
    std::vector<TakeFrame>& frames = take.cameras[camera].frames;
    if (rows.integer(1) != static_cast<std::int64_t>(frames.size())) return false;
    TakeFrame frame;
    frame.time = Timestamp{rows.integer(2)};
    const std::int64_t dropped = rows.integer(4);
    if (is_impossible(frame, frames) || dropped < 0 || dropped > kMax) return false;
    frame.sequence = static_cast<std::uint32_t>(rows.integer(3));
    frame.dropped_before = static_cast<int>(dropped);
    frame.time_is_arrival = rows.integer(5) != 0;
    frame.damaged = rows.integer(6) != 0;
    frames.push_back(frame);
  }
  return !rows.failed();
}

bool read_events(sqlite3* database, std::int64_t max_events, Take& take) {
  Statement rows(database, "SELECT camera, time_ns, text FROM event ORDER BY time_ns");
  while (rows.next_row()) {
    const auto camera = static_cast<std::size_t>(rows.integer(0));
    if (camera >= take.cameras.size() || --max_events < 0) return false;
    take.events.push_back(
        {static_cast<int>(camera), Timestamp{rows.integer(1)}, rows.text(2)});
  }
  return !rows.failed();
}

}  // namespace

Result<Take> read_take(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return bad_input(file,
                     "the file does not exist, so the times of the frames are unknown",
                     "copy it from where the take was recorded; or name the videos in "
                     "the trial's `videos`, outside of the take: then frames are matched "
                     "by their numbers");
  }
  const auto opened = open_recorded(path);
  if (!opened) return opened.error();
  const Database& database = *opened;
  if (!database || setting_of(database.get(), "application_id") != kTakeApplication) {
    return damaged(file);
  }
  const std::int64_t version = setting_of(database.get(), "user_version");
  if (version > kTakeVersion) {
    return bad_input(file,
                     "it was recorded by a newer version of marey (format " +
                         std::to_string(version) + ", this version reads " +
                         std::to_string(kTakeVersion) + ")",
                     "install that version");
  }
  Take take;
  sqlite3* const raw = database.get();
  const bool whole = version == kTakeVersion && has_schema(raw, kTakeSchema) &&
                     read_head(raw, take) && read_cameras(raw, take) &&
                     read_frames(raw, take) && read_events(raw, max_rows(path), take);
  if (!whole) return damaged(file);
  return take;
}

}  // namespace marey::recordings
