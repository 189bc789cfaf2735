// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_recorder.h"

#include <chrono>
#include <condition_variable>
#include <system_error>
#include <utility>

#include "app/live_results.h"
#include "app/utc_now.h"
#include "recordings/subject_file.h"

namespace marey::app {
namespace {

using recordings::LiveTakeWriter;

constexpr std::chrono::milliseconds kCommitEvery{250};
constexpr const char* kAvatars = "avatars";

Error disk(const std::filesystem::path& path, const std::error_code& problem) {
  return {Errc::kDevice,
          path.string(),
          "it cannot be written: " + problem.message(),
          "make room on the disk, or choose a folder that may be written to"};
}

/// An avatar, and the bone map beside it.
Status copy_avatar(const std::filesystem::path& file,
                   const std::filesystem::path& folder) {
  if (file.extension() == ".gltf") {
    return bad_input(file.string(),
                     "a .gltf has its buffers and pictures in other files, which a take "
                     "does not copy",
                     "give the avatar as .glb or .vrm");
  }
  std::error_code problem;
  std::filesystem::path map = file;
  map.replace_extension(".bones.toml");
  for (const std::filesystem::path& one : {file, map}) {
    if (one == map && !std::filesystem::exists(one, problem)) continue;
    const auto to = folder / one.filename();
    std::filesystem::copy_file(one, to, problem);
    if (problem) return disk(to, problem);
  }
  return Done{};
}

/// Takes away what create() made of a folder.
void forget(const std::filesystem::path& folder, bool was_there) {
  std::error_code ignored;
  if (!was_there) {
    std::filesystem::remove_all(folder, ignored);
    return;
  }
  for (const char* name : {"calibration.toml", "subject.toml", kAvatars}) {
    std::filesystem::remove_all(folder / name, ignored);
  }
}

Status write_surroundings(const std::filesystem::path& folder,
                          const OpenedLive& live,
                          const Body& body) {
  std::error_code problem;
  std::filesystem::create_directories(folder / kAvatars, problem);
  if (problem) return disk(folder, problem);
  const auto calibration = folder / "calibration.toml";
  if (const Status ok = recordings::write_calibration(calibration, live.calibration);
      !ok) {
    return ok;
  }
  if (const Status ok = recordings::write_subject(folder / "subject.toml", body); !ok) {
    return ok;
  }
  for (const OpenedAvatar& avatar : live.avatars) {
    if (const Status ok = copy_avatar(avatar.file, folder / kAvatars); !ok) return ok;
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
  if (was_there && !std::filesystem::is_empty(folder, ignored)) {
    return bad_input(folder.string(),
                     "the folder is not empty, or is a file",
                     "record into a new folder");
  }
  const auto give_up = [&](const Error& error) {
    forget(folder, was_there);
    return error;
  };
  if (const Status ok = write_surroundings(folder, live, body); !ok) {
    return give_up(ok.error());
  }
  recordings::LiveTakeHead head;
  head.session = live.session;
  head.started = utc_now();
  head.rate = live.settings.rate;
  for (const Camera& camera : live.calibration.cameras) {
    head.cameras.push_back(camera.name);
  }
  head.settings = live_settings_text(settings);
  auto writer = LiveTakeWriter::create(folder / recordings::kLiveTakeFile, head);
  if (!writer) return give_up(writer.error());
  auto recorder = std::unique_ptr<LiveRecorder>(new LiveRecorder(*std::move(writer)));
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

void LiveRecorder::add_lead_in(const LiveInstant& instant,
                               const LiveRequests& requests) {
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

Status LiveRecorder::finish() {
  committer_.request_stop();
  if (committer_.joinable()) committer_.join();
  if (const auto error = trouble()) return *error;
  return writer_.finish();
}

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
  out.calibration = *std::move(calibration);
  if (out.calibration.cameras.size() != out.take.head.cameras.size() ||
      out.settings.lag_known.size() > out.calibration.cameras.size()) {
    return bad_input((folder / "calibration.toml").string(),
                     "it does not hold the cameras of the take",
                     "copy it again from where the take was recorded");
  }
  auto body = recordings::read_subject(folder / "subject.toml");
  if (!body) return body.error();
  out.body = *std::move(body);
  for (const std::string& name : out.settings.avatars) {
    auto avatar =
        open_avatar(folder / kAvatars / std::filesystem::path(name).filename());
    if (!avatar) return avatar.error();
    out.avatars.push_back(*std::move(avatar));
  }
  return out;
}

}  // namespace marey::app
