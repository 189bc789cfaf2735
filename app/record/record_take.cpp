// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/record/record_take.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "app/record/camera_recorder.h"
#include "app/shell/utc_now.h"
#include "core/base/assert.h"
#include "core/base/monotonic_clock.h"
#include "recordings/takes/take_file.h"

namespace marey::app {
namespace {

using capture::DeviceSettings;
using std::chrono::milliseconds;

constexpr milliseconds kCommitEvery{250};

template <class T>
void add_line(std::string& text, const char* key, const std::optional<T>& value) {
  if (!value) return;
  std::array<char, 80> line{};
  std::snprintf(
      line.data(), line.size(), "%s = %.9g\n", key, static_cast<double>(*value));
  text += line.data();
}

std::string text_of(const DeviceSettings& settings) {
  std::string text = std::string("format = ") + capture::name(settings.format) + "\n";
  add_line(text, "rate_hz", std::optional(settings.rate.hz));
  add_line(text, "exposure_s", settings.exposure_s);
  if (settings.exposure_is_automatic) text += "exposure_is_automatic = true\n";
  add_line(text, "focus", settings.focus);
  add_line(text, "gain", settings.gain);
  if (!settings.monotonic_clock) text += "monotonic_clock = false\n";
  for (const std::string& difference : settings.differences) {
    text += "# " + difference + "\n";
  }
  return text;
}

std::string video_name(const std::string& camera) {
  return camera + ".mkv";
}

recordings::Take describe(std::span<const RecordedCamera> cameras,
                          const RecordOptions& options) {
  recordings::Take take;
  take.trial = options.trial;
  take.started = utc_now();
  for (const RecordedCamera& camera : cameras) {
    const DeviceSettings& settings = camera.feed->settings();
    recordings::TakeCamera& one = take.cameras.emplace_back();
    one.name = camera.name;
    one.file = video_name(camera.name);
    one.width_px = settings.width_px;
    one.height_px = settings.height_px;
    one.rate = rate_of(settings);
    one.device = camera.feed->device();
    one.settings = text_of(settings);
  }
  return take;
}

/// Files of a recording. The destructor removes them unless keep() was called.
class TakeFiles {
 public:
  explicit TakeFiles(const std::filesystem::path& folder) : folder_(folder) {}
  TakeFiles(const TakeFiles&) = delete;
  TakeFiles& operator=(const TakeFiles&) = delete;
  ~TakeFiles() {
    std::error_code ignored;
    for (const auto& file : made_) std::filesystem::remove(file, ignored);
    if (made_folder_) std::filesystem::remove(folder_, ignored);
  }

  [[nodiscard]] Status make_folder() {
    std::error_code problem;
    made_folder_ = std::filesystem::create_directories(folder_, problem);
    if (!problem) return Done{};
    return Error{Errc::kDevice,
                 folder_.string(),
                 "the folder cannot be created: " + problem.message(),
                 "choose a folder that may be written to"};
  }

  void add(const std::filesystem::path& file) { made_.push_back(file); }

  void keep() {
    made_.clear();
    made_folder_ = false;
  }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;
  bool made_folder_ = false;
};

using Recorders = std::vector<std::unique_ptr<CameraRecorder>>;

long frames_of(const Recorders& recorders) {
  long frames = 0;
  for (const auto& recorder : recorders) frames += recorder->frames();
  return frames;
}

/// Commits the file of the take and reports progress, until the recording is over.
Status commit_until_over(recordings::TakeWriter& take,
                         const Recorders& recorders,
                         const RecordOptions& options,
                         const std::function<bool()>& stop,
                         const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  while (!stop()) {
    const std::chrono::duration<double> elapsed = Clock::now() - begin;
    if (options.seconds && elapsed.count() >= *options.seconds) break;
    std::this_thread::sleep_for(kCommitEvery);
    if (Status ok = take.commit(); !ok) return ok;
    if (progress) progress(static_cast<int>(frames_of(recorders)), kUnknownTotal);
  }
  return Done{};
}

/// Runs all threads until the recording is over and every frame is written. Returns the
/// end of the recording on the clock of the cameras.
Result<Timestamp> run(recordings::TakeWriter& take,
                      const Recorders& recorders,
                      const RecordOptions& options,
                      const std::function<bool()>& stop,
                      const Progress& progress) {
  const auto now = options.now ? options.now : monotonic_now;
  const Timestamp begin = now();
  std::vector<std::jthread> writers;
  writers.reserve(recorders.size());
  for (const auto& one : recorders) {
    writers.emplace_back([&recorder = *one, begin] { recorder.write(begin); });
  }
  // These threads are destroyed first: they stop and close their queues, so the writers
  // end.
  std::vector<std::jthread> receivers;
  receivers.reserve(recorders.size());
  for (const auto& one : recorders) {
    receivers.emplace_back([&recorder = *one, begin](const std::stop_token& end) {
      recorder.receive(end, begin);
    });
  }
  const Status committed = commit_until_over(take, recorders, options, stop, progress);
  const Timestamp end = now();
  for (std::jthread& receiver : receivers) receiver.request_stop();
  if (!committed) return committed.error();
  return end;
}

}  // namespace

Status check_unrecorded(const std::filesystem::path& folder,
                        std::span<const std::string> cameras) {
  std::vector<std::filesystem::path> files{folder / recordings::kTakeFile};
  for (const std::string& name : cameras) files.push_back(folder / video_name(name));
  for (const std::filesystem::path& file : files) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) continue;
    return bad_input(file.string(),
                     "a recording already exists",
                     "record under another trial's name, or move the old one away");
  }
  return Done{};
}

Result<std::vector<CameraSummary>> record_take(std::span<const RecordedCamera> cameras,
                                               const RecordOptions& options,
                                               const std::function<bool()>& stop,
                                               const Progress& progress) {
  MAREY_ASSERT(!cameras.empty() && options.queue_frames > 0 && options.queue_bytes > 0);
  std::vector<std::string> names;
  for (const RecordedCamera& camera : cameras) names.push_back(camera.name);
  if (const Status ok = check_unrecorded(options.folder, names); !ok) return ok.error();
  TakeFiles files(options.folder);
  if (const Status ok = files.make_folder(); !ok) return ok.error();
  const auto take_file = options.folder / recordings::kTakeFile;
  auto take = recordings::TakeWriter::create(take_file, describe(cameras, options));
  if (!take) return take.error();
  files.add(take_file);
  Recorders recorders;
  for (const RecordedCamera& camera : cameras) {
    recorders.push_back(std::make_unique<CameraRecorder>(
        static_cast<int>(recorders.size()), camera, options, *take));
    const auto video = options.folder / video_name(camera.name);
    if (const Status ok = recorders.back()->open(video); !ok) return ok.error();
    files.add(video);
  }
  files.keep();
  const Result<Timestamp> end = run(*take, recorders, options, stop, progress);
  if (!end) return end.error();
  if (const Status ok = take->finish(); !ok) return ok.error();
  const int frames = static_cast<int>(frames_of(recorders));
  if (progress) progress(frames, frames);
  std::vector<CameraSummary> summaries;
  summaries.reserve(recorders.size());
  for (const auto& recorder : recorders) summaries.push_back(recorder->summary(*end));
  return summaries;
}

}  // namespace marey::app
