// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <utility>

#include "core/base/input_file.h"
#include "recordings/base/sqlite.h"
#include "recordings/takes/live_take.h"
#include "recordings/takes/live_take_schema.h"
#include "recordings/takes/view_bytes.h"

namespace marey::recordings {
namespace {

bool read_head(sqlite3* database, LiveTake& take) {
  Statement live(database,
                 "SELECT session, started, rate_hz, settings, finished FROM live");
  if (!live.next_row()) return false;
  take.head.session = live.text(0);
  take.head.started = live.text(1);
  take.head.rate.hz = live.number(2);
  take.head.settings = live.text(3);
  take.finished = live.integer(4) != 0;
  constexpr double kMaxRate_hz = 1e4;  // Limit for any camera.
  if (!(take.head.rate.hz > 0.0 && take.head.rate.hz <= kMaxRate_hz)) return false;
  Statement cameras(database, "SELECT camera, name FROM camera ORDER BY camera");
  while (cameras.next_row()) {
    const auto next = static_cast<std::int64_t>(take.head.cameras.size());
    if (cameras.integer(0) != next) return false;
    take.head.cameras.push_back(cameras.text(1));
  }
  return !cameras.failed();
}

/// Returns true if the values of the next instant are impossible.
bool is_impossible(const LiveInstant& instant, const LiveTake& take) {
  // Clocks count from the computer's start: 30 years; and frames in that time, at 1000
  // per second.
  constexpr Timestamp kMaxTime = std::chrono::hours(24 * 366 * 30);
  constexpr std::int64_t kMaxNumber = 1'000'000'000'000;
  if (instant.number < -kMaxNumber || instant.number > kMaxNumber) return true;
  if (instant.time < -kMaxTime || instant.time > kMaxTime) return true;
  constexpr Timestamp kMaxApart = std::chrono::seconds(10);
  for (const CameraTags& view : instant.views) {
    if (view.time < instant.time - kMaxApart || view.time > instant.time + kMaxApart) {
      return true;
    }
  }
  return !take.instants.empty() && instant.number <= take.instants.back().seen.number;
}

bool read_instants(sqlite3* database, LiveTake& take) {
  Statement rows(database,
                 "SELECT number, time_ns, views, requests, results FROM instant "
                 "ORDER BY number");
  while (rows.next_row()) {
    LiveTakeInstant one;
    one.seen.number = rows.integer(0);
    if (!take.instants.empty() && one.seen.number <= take.instants.back().seen.number) {
      return false;
    }
    one.seen.time = Timestamp{rows.integer(1)};
    auto views = read_views(rows.bytes(2), take.head.cameras.size());
    if (!views) return false;
    one.seen.views = *std::move(views);
    if (is_impossible(one.seen, take)) return false;
    one.requests = rows.text(3);
    const auto results = rows.bytes(4);
    one.results.assign(results.begin(), results.end());
    take.instants.push_back(std::move(one));
  }
  return !rows.failed();
}

}  // namespace

Result<LiveTake> read_live_take(const std::filesystem::path& path) {
  const std::string file = path.string();
  if (const Status ok = check_input_file(path); !ok) {
    return bad_input(
        file, ok.error().cause, "name a folder that marey live --record made");
  }
  const auto opened = open_recorded(path);
  if (!opened) return opened.error();
  const Database& database = *opened;
  const Error damaged =
      bad_input(file,
                "it is not the database of a live take, or it is damaged",
                "copy it again from where it was recorded, with the files " +
                    std::string(kLiveTakeFile) + "-wal and -shm if they exist");
  if (!database || setting_of(database.get(), "application_id") != kLiveTakeApplication) {
    return damaged;
  }
  if (setting_of(database.get(), "user_version") > kLiveTakeVersion) {
    return bad_input(file,
                     "it was recorded by a newer version of marey",
                     "replay it with that version");
  }
  LiveTake take;
  if (!has_schema(database.get(), kLiveTakeSchema) || !read_head(database.get(), take) ||
      !read_instants(database.get(), take)) {
    return damaged;
  }
  return take;
}

}  // namespace marey::recordings
