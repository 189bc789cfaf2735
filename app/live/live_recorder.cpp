// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_recorder.h"

#include <chrono>
#include <condition_variable>
#include <optional>
#include <system_error>
#include <utility>

#include "app/live_chain/live_results.h"
#include "app/live_chain/open_live_take.h"
#include "app/shell/utc_now.h"
#include "recordings/session/subject_file.h"

namespace marey::app {
namespace {

using recordings::LiveTakeWriter;

constexpr std::chrono::milliseconds kCommitEvery{250};

Error disk(const std::filesystem::path& path, const std::error_code& problem) {
  if (problem == std::errc::not_a_directory || problem == std::errc::file_exists) {
    return bad_input(path.string(),
                     "a part of this path is a file, and a take needs a folder",
                     "name a new folder");
  }
  if (problem == std::errc::permission_denied ||
      problem == std::errc::read_only_file_system) {
    return bad_input(path.string(),
                     "it cannot be written: " + problem.message(),
                     "choose a folder that may be written to");
  }
  return {Errc::kDevice,
          path.string(),
          "it cannot be written: " + problem.message(),
          "free some disk space, or choose a folder on another disk"};
}

/// Returns the file name of an avatar in the take, from its index: the original names may
/// be equal, and may contain any bytes.
std::string name_in_take(std::size_t place, const std::filesystem::path& file) {
  return std::to_string(place + 1) + file.extension().string();
}

/// Copies an avatar to the path `to`, and its bone map next to it.
Status copy_avatar(const std::filesystem::path& file, const std::filesystem::path& to) {
  if (file.extension() == ".gltf") {
    return bad_input(file.string(),
                     "a .gltf has its buffers and pictures in other files, which a take "
                     "does not copy",
                     "give the avatar as .glb or .vrm");
  }
  std::error_code problem;
  std::filesystem::copy_file(file, to, problem);
  if (problem) return disk(to, problem);
  std::filesystem::path map = file;
  map.replace_extension(".bones.toml");
  if (!std::filesystem::exists(map, problem)) return Done{};
  std::filesystem::path map_to = to;
  map_to.replace_extension(".bones.toml");
  std::filesystem::copy_file(map, map_to, problem);
  if (problem) return disk(map_to, problem);
  return Done{};
}

/// Removes the files that create() made in a folder, and the folder itself if it is
/// empty.
void remove_take_files(const std::filesystem::path& folder, bool was_there) {
  std::error_code ignored;
  const std::string take = recordings::kLiveTakeFile;
  for (const std::string& name : {std::string("calibration.toml"),
                                  std::string("subject.toml"),
                                  std::string(kLiveTakeAvatars),
                                  take,
                                  take + "-wal",
                                  take + "-shm"}) {
    std::filesystem::remove_all(folder / name, ignored);
  }
  if (!was_there) std::filesystem::remove(folder, ignored);
}

Status write_surroundings(const std::filesystem::path& folder,
                          const OpenedLive& live,
                          const Body& body,
                          const std::vector<std::string>& avatar_files) {
  std::error_code problem;
  std::filesystem::create_directories(folder / kLiveTakeAvatars, problem);
  if (problem) return disk(folder, problem);
  const auto calibration = folder / "calibration.toml";
  if (const Status ok = recordings::write_calibration(calibration, live.calibration);
      !ok) {
    return ok;
  }
  if (const Status ok = recordings::write_subject(folder / "subject.toml", body); !ok) {
    return ok;
  }
  for (std::size_t a = 0; a < live.avatars.size(); ++a) {
    const auto to = folder / kLiveTakeAvatars / avatar_files[a];
    if (const Status ok = copy_avatar(live.avatars[a].file, to); !ok) return ok;
  }
  return Done{};
}

}  // namespace

Result<std::unique_ptr<LiveRecorder>> LiveRecorder::create(
    const std::filesystem::path& folder,
    const OpenedLive& live,
    const Body& body,
    const LiveSettings& settings) {
  std::error_code ignored;
  const bool was_there = std::filesystem::exists(folder, ignored);
  if (was_there && !std::filesystem::is_directory(folder, ignored)) {
    return bad_input(folder.string(),
                     "this is a file, and a take needs a folder",
                     "name a new folder");
  }
  if (was_there && !std::filesystem::is_empty(folder, ignored)) {
    return bad_input(
        folder.string(), "the folder is not empty", "record into a new folder");
  }
  const auto give_up = [&](const Error& error) {
    remove_take_files(folder, was_there);
    return error;
  };
  LiveSettings kept = settings;
  kept.avatar_files.clear();
  for (std::size_t a = 0; a < live.avatars.size(); ++a) {
    kept.avatar_files.push_back(name_in_take(a, live.avatars[a].file));
  }
  if (const Status ok = write_surroundings(folder, live, body, kept.avatar_files); !ok) {
    return give_up(ok.error());
  }
  recordings::LiveTakeHead head;
  head.session = live.session;
  head.started = utc_now();
  head.rate = live.settings.rate;
  for (const Camera& camera : live.calibration.cameras) {
    head.cameras.push_back(camera.name);
  }
  head.settings = live_settings_text(kept);
  auto writer = LiveTakeWriter::create(folder / recordings::kLiveTakeFile, head);
  if (!writer) return give_up(writer.error());
  auto recorder = std::unique_ptr<LiveRecorder>(new LiveRecorder(*std::move(writer)));
  recorder->folder_ = folder;
  recorder->was_there_ = was_there;
  LiveRecorder* const raw = recorder.get();
  raw->committer_ =
      std::jthread([raw](const std::stop_token& stop) { raw->commit_often(stop); });
  return recorder;
}

LiveRecorder::LiveRecorder(LiveTakeWriter writer) : writer_(std::move(writer)) {}
LiveRecorder::~LiveRecorder() = default;

void LiveRecorder::add(const LiveInstant& instant,
                       const LiveRequests& requests,
                       const LiveResult& result) {
  if (trouble()) return;
  instant_.seen = instant;
  instant_.requests = live_requests_text(requests);
  write_results(result, instant_.results);
  keep();
}

void LiveRecorder::add_lead_in(const LiveInstant& instant, const LiveRequests& requests) {
  if (trouble()) return;
  instant_.seen = instant;
  instant_.requests = live_requests_text(requests);
  instant_.results.clear();
  keep();
}

void LiveRecorder::keep() {
  const Status ok = writer_.add(instant_);
  if (ok) return;
  const std::lock_guard lock(mutex_);
  trouble_ = ok.error();
}

std::optional<Error> LiveRecorder::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

void LiveRecorder::commit_often(const std::stop_token& stop) {
  std::mutex sleeping;
  std::condition_variable_any woken;
  std::unique_lock lock(sleeping);
  while (!stop.stop_requested()) {
    (void)woken.wait_for(lock, stop, kCommitEvery, [] { return false; });
    if (const Status ok = writer_.commit(); !ok) {
      const std::lock_guard guard(mutex_);
      trouble_ = ok.error();
      return;
    }
  }
}

void LiveRecorder::end_commits() {
  committer_.request_stop();
  if (committer_.joinable()) committer_.join();
}

void LiveRecorder::discard() {
  end_commits();
  { const LiveTakeWriter closed = std::move(writer_); }
  remove_take_files(folder_, was_there_);
}

Status LiveRecorder::finish() {
  end_commits();
  if (const auto error = trouble()) return *error;
  return writer_.finish();
}

}  // namespace marey::app
