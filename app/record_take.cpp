// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/record_take.h"

#include <array>
#include <atomic>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "app/frame_queue.h"
#include "core/assert.h"
#include "recordings/jpeg_encoder.h"
#include "recordings/mjpg_video.h"
#include "recordings/take_file.h"

namespace marey::app {
namespace {

using capture::DeviceSettings;
using capture::PixelFormat;
using capture::RawFrame;
using std::chrono::milliseconds;

constexpr milliseconds kListen{200};
constexpr milliseconds kCommitEvery{250};

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

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

recordings::RawLayout layout_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::kYuyv:
      return recordings::RawLayout::kYuyv;
    case PixelFormat::kNv12:
      return recordings::RawLayout::kNv12;
    case PixelFormat::kMjpg:
    case PixelFormat::kGrey:
      break;
  }
  return recordings::RawLayout::kGrey;
}

bool pack_alike(const DeviceSettings& a, const DeviceSettings& b) {
  return a.format == b.format && a.width_px == b.width_px && a.height_px == b.height_px &&
         a.stride == b.stride;
}

FrameRate rate_of(const DeviceSettings& settings) {
  return settings.rate.hz > 0.0 ? settings.rate : FrameRate{30.0};
}

/// The time of the take's first frame, whichever camera has it.
class TakeStart {
 public:
  Timestamp since(Timestamp time) {
    std::int64_t expected = kUnset;
    start_.compare_exchange_strong(expected, time.count());
    return time - Timestamp{start_.load()};
  }

 private:
  static constexpr std::int64_t kUnset = std::numeric_limits<std::int64_t>::min();
  std::atomic<std::int64_t> start_ = kUnset;
};

/// One camera's way into its files: listen() and write() run in a thread each.
class CameraRecorder {
 public:
  CameraRecorder(int number,
                 const RecordedCamera& camera,
                 std::size_t queue_frames,
                 recordings::TakeWriter& take,
                 TakeStart& start)
      : number_(number),
        name_(camera.name),
        feed_(*camera.feed),
        settings_(camera.feed->settings()),
        queue_(queue_frames),
        take_(take),
        start_(start) {}

  [[nodiscard]] Status open(const std::filesystem::path& folder) {
    recordings::MjpgVideoOptions options;
    options.width_px = settings_.width_px;
    options.height_px = settings_.height_px;
    options.rate = rate_of(settings_);
    auto video = recordings::MjpgVideo::create(folder / (name_ + ".mkv"), options);
    if (!video) return video.error();
    video_.emplace(std::move(*video));
    if (settings_.format == PixelFormat::kMjpg) return Done{};
    auto encoder = recordings::JpegEncoder::create(layout_of(settings_.format),
                                                   settings_.width_px,
                                                   settings_.height_px,
                                                   settings_.stride);
    if (!encoder) return encoder.error();
    encoder_.emplace(std::move(*encoder));
    return Done{};
  }

  void listen(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const auto frame = feed_.next(kListen);
      for (std::string& event : feed_.events()) {
        take_.note({number_, last_time_, std::move(event)});
      }
      if (frame) hear(*frame);
    }
    queue_.close();
  }

  void write() {
    while (const QueuedFrame* frame = queue_.pop()) {
      if (!error_) write_one(*frame);
    }
    if (error_) return;
    if (const Status ended = video_->finish(); !ended) error_ = ended.error();
  }

  [[nodiscard]] long frames() const { return frames_; }
  [[nodiscard]] CameraSummary summary() const {
    CameraSummary out{name_, frames_, dropped_ + unencoded_, unsaved_, error_};
    if (!out.error && frames_ == 0) {
      out.error = Error{Errc::kDevice,
                        "camera " + name_,
                        "not a single frame came from it",
                        "see what marey doctor says of it"};
    }
    return out;
  }

 private:
  void hear(const RawFrame& frame) {
    last_time_ = frame.time;
    dropped_ += frame.dropped_before;
    lost_ += frame.dropped_before;
    const bool fits = pack_alike(feed_.settings(), settings_);
    if (!fits && !told_of_change_) {
      take_.note({number_, frame.time, "it came back with another size or format"});
      told_of_change_ = true;
    }
    recordings::TakeFrame stamp;
    stamp.time = frame.time;
    stamp.time_is_arrival = frame.time_is_arrival;
    stamp.sequence = frame.sequence;
    stamp.damaged = frame.damaged;
    stamp.dropped_before = lost_;
    const bool usable = fits && !frame.bytes.empty();
    if (usable && queue_.push(frame.bytes, stamp)) {
      lost_ = 0;
      return;
    }
    ++lost_;
    ++dropped_;
    if (usable) ++unsaved_;
  }

  void write_one(const QueuedFrame& frame) {
    const auto jpeg = encoder_ ? encoder_->encode(frame.bytes)
                               : std::span<const std::byte>(frame.bytes);
    recordings::TakeFrame stamp = frame.stamp;
    stamp.dropped_before += unencoded_pending_;
    if (jpeg.empty()) {
      unencoded_pending_ = stamp.dropped_before + 1;
      ++unencoded_;
      return;
    }
    unencoded_pending_ = 0;
    if (const Status ok = video_->write(jpeg, start_.since(stamp.time)); !ok) {
      error_ = ok.error();
      take_.note({number_, stamp.time, error_->message()});
      return;
    }
    take_.add(number_, stamp);
    ++frames_;
  }

  const int number_;
  const std::string name_;
  FrameFeed& feed_;
  const DeviceSettings settings_;  ///< As the recording began.
  FrameQueue queue_;
  recordings::TakeWriter& take_;
  TakeStart& start_;
  std::optional<recordings::MjpgVideo> video_;
  std::optional<recordings::JpegEncoder> encoder_;
  // Of listen().
  Timestamp last_time_{0};
  int lost_ = 0;  ///< Since the last frame that was taken.
  bool told_of_change_ = false;
  long dropped_ = 0;
  long unsaved_ = 0;
  // Of write().
  int unencoded_pending_ = 0;
  long unencoded_ = 0;
  std::optional<Error> error_;
  std::atomic<long> frames_ = 0;
};

recordings::Take describe(std::span<const RecordedCamera> cameras,
                          const RecordOptions& options) {
  recordings::Take take;
  take.trial = options.trial;
  take.started = utc_now();
  for (const RecordedCamera& camera : cameras) {
    const DeviceSettings& settings = camera.feed->settings();
    recordings::TakeCamera& one = take.cameras.emplace_back();
    one.name = camera.name;
    one.file = camera.name + ".mkv";
    one.width_px = settings.width_px;
    one.height_px = settings.height_px;
    one.rate = rate_of(settings);
    one.device = camera.feed->device();
    one.settings = text_of(settings);
  }
  return take;
}

/// Commits and counts until it is over.
Status attend(recordings::TakeWriter& take,
              const std::vector<std::unique_ptr<CameraRecorder>>& recorders,
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
    if (!progress) continue;
    long frames = 0;
    for (const auto& recorder : recorders) frames += recorder->frames();
    progress(static_cast<int>(frames), kUnknownTotal);
  }
  return Done{};
}

}  // namespace

Result<std::vector<CameraSummary>> record_take(std::span<const RecordedCamera> cameras,
                                               const RecordOptions& options,
                                               const std::function<bool()>& stop,
                                               const Progress& progress) {
  MAREY_ASSERT(!cameras.empty() && options.queue_frames > 0);
  std::error_code problem;
  std::filesystem::create_directories(options.folder, problem);
  if (problem) {
    return Error{Errc::kDevice,
                 options.folder.string(),
                 "the folder cannot be made: " + problem.message(),
                 "choose a folder that may be written to"};
  }
  auto take = recordings::TakeWriter::create(options.folder / recordings::kTakeFile,
                                             describe(cameras, options));
  if (!take) return take.error();
  TakeStart start;
  std::vector<std::unique_ptr<CameraRecorder>> recorders;
  for (const RecordedCamera& camera : cameras) {
    recorders.push_back(std::make_unique<CameraRecorder>(
        static_cast<int>(recorders.size()), camera, options.queue_frames, *take, start));
    if (const Status ok = recorders.back()->open(options.folder); !ok) return ok.error();
  }
  Status attended = Done{};
  {
    std::vector<std::jthread> writers;
    writers.reserve(recorders.size());
    for (auto& one : recorders) {
      writers.emplace_back([&recorder = *one] { recorder.write(); });
    }
    // Destroyed first: they are stopped, close their queues, and the writers end.
    std::vector<std::jthread> listeners;
    listeners.reserve(recorders.size());
    for (auto& one : recorders) {
      listeners.emplace_back(
          [&recorder = *one](const std::stop_token& end) { recorder.listen(end); });
    }
    attended = attend(*take, recorders, options, stop, progress);
    for (std::jthread& listener : listeners) listener.request_stop();
  }
  if (!attended) return attended.error();
  if (const Status ok = take->finish(); !ok) return ok.error();
  std::vector<CameraSummary> summaries;
  summaries.reserve(recorders.size());
  for (const auto& recorder : recorders) summaries.push_back(recorder->summary());
  return summaries;
}

}  // namespace marey::app
