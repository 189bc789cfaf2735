// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/record/camera_recorder.h"

#include <algorithm>
#include <utility>

namespace marey::app {
namespace {

using capture::DeviceSettings;
using capture::PixelFormat;
using capture::RawFrame;
using std::chrono::milliseconds;

constexpr milliseconds kReceiveTimeout{200};
/// If no frame follows within this time, the written frames are flushed to the disk. With
/// MjpgVideoOptions::flush_every, the delay is at most half a second.
constexpr milliseconds kIdle{100};

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

/// Returns true if the picture layout that the driver states is valid.
bool is_recordable(const DeviceSettings& settings) {
  if (settings.width_px <= 0 || settings.height_px <= 0) return false;
  if (settings.format == PixelFormat::kMjpg) return true;
  const int bytes = settings.format == PixelFormat::kYuyv ? 2 : 1;
  return settings.width_px % 2 == 0 && settings.stride / bytes >= settings.width_px &&
         (settings.format != PixelFormat::kNv12 || settings.height_px % 2 == 0);
}

}  // namespace

FrameRate rate_of(const DeviceSettings& settings) {
  return settings.rate.hz > 0.0 ? settings.rate : FrameRate{30.0};
}

CameraRecorder::CameraRecorder(int number,
                               const RecordedCamera& camera,
                               const RecordOptions& options,
                               recordings::TakeWriter& take)
    : number_(number),
      name_(camera.name),
      feed_(*camera.feed),
      settings_(camera.feed->settings()),
      queue_(options.queue_frames, options.queue_bytes),
      take_(take) {}

Status CameraRecorder::open(const std::filesystem::path& video) {
  if (!is_recordable(settings_)) {
    return Error{Errc::kDevice,
                 "camera " + name_,
                 "its driver announces " + std::to_string(settings_.width_px) + "x" +
                     std::to_string(settings_.height_px) + " pictures in " +
                     capture::name(settings_.format) + " with " +
                     std::to_string(settings_.stride) +
                     " bytes a row, which cannot be recorded",
                 "choose another width and height for it in session.toml; marey doctor "
                 "lists those it has"};
  }
  if (settings_.format != PixelFormat::kMjpg) {
    auto encoder = recordings::JpegEncoder::create(layout_of(settings_.format),
                                                   settings_.width_px,
                                                   settings_.height_px,
                                                   settings_.stride);
    if (!encoder) return encoder.error();
    encoder_.emplace(std::move(*encoder));
  }
  recordings::MjpgVideoOptions options;
  options.width_px = settings_.width_px;
  options.height_px = settings_.height_px;
  options.rate = rate_of(settings_);
  auto made = recordings::MjpgVideo::create(video, options);
  if (!made) return made.error();
  video_.emplace(std::move(*made));
  return Done{};
}

void CameraRecorder::receive(const std::stop_token& stop, Timestamp begin) {
  while (!stop.stop_requested()) {
    const auto frame = feed_.next(kReceiveTimeout);
    for (capture::FeedEvent& event : feed_.events()) {
      take_.note({number_, event.time, std::move(event.text)});
    }
    // Cameras stream from the time they are opened, into buffers that were not read.
    // Frames in these buffers, and frames dropped because the buffers were full, precede
    // the take.
    if (frame && frame->time >= begin) take_frame(*frame);
  }
  queue_.close();
}

void CameraRecorder::take_frame(const RawFrame& frame) {
  const int dropped_before = has_received_ ? frame.dropped_before : 0;
  has_received_ = true;
  dropped_ += dropped_before;
  lost_ += dropped_before;
  const bool fits = pack_alike(feed_.settings(), settings_);
  if (!fits && !has_warned_of_change_) {
    take_.note({number_, frame.time, "it came back with another size or format"});
    has_warned_of_change_ = true;
  }
  recordings::TakeFrame stamp;
  stamp.time = frame.time;
  stamp.time_is_arrival = frame.time_is_arrival;
  stamp.sequence = frame.sequence;
  stamp.damaged = frame.damaged;
  stamp.dropped_before = lost_;
  const bool usable = fits && !frame.bytes.empty();
  if (usable) last_time_ = frame.time;
  if (usable && queue_.push(frame.bytes, stamp)) {
    lost_ = 0;
    return;
  }
  ++lost_;
  ++dropped_;
  if (usable) ++unsaved_;
}

void CameraRecorder::write(Timestamp begin) {
  while (!queue_.is_over()) {
    const QueuedFrame* frame = queue_.pop(kIdle);
    if (error_) {
      unwritten_ += frame != nullptr ? 1 : 0;
    } else if (frame != nullptr) {
      write_one(*frame, begin);
    } else if (const Status ok = video_->flush(); !ok) {
      fail(ok.error());
    }
  }
  if (error_) return;
  if (const Status ended = video_->finish(); !ended) fail(ended.error());
}

void CameraRecorder::write_one(const QueuedFrame& frame, Timestamp begin) {
  const auto jpeg = encoder_ ? encoder_->encode(frame.bytes) : frame.bytes;
  recordings::TakeFrame stamp = frame.stamp;
  stamp.dropped_before += unencoded_pending_;
  if (jpeg.empty()) {
    unencoded_pending_ = stamp.dropped_before + 1;
    ++unwritten_;
    return;
  }
  unencoded_pending_ = 0;
  // The time of an arrival may be later than the time stamp of the next frame.
  stamp.time = last_written_ = std::max(last_written_, stamp.time);
  if (const Status ok = video_->write(jpeg, stamp.time - begin); !ok) {
    ++unwritten_;
    fail(ok.error());
    return;
  }
  take_.add(number_, stamp);
  ++frames_;
}

void CameraRecorder::fail(const Error& error) {
  error_ = error;
  take_.note({number_, last_written_, error.message()});
}

std::optional<Error> CameraRecorder::trouble(Timestamp end) const {
  const std::string where = "camera " + name_;
  if (error_) return error_;
  if (has_warned_of_change_) {
    return Error{
        Errc::kDevice,
        where,
        "after a reconnect its pictures have another size or format; these frames were "
        "not kept",
        "check the camera with marey doctor, and record again"};
  }
  if (frames_ == 0) {
    return Error{
        Errc::kDevice, where, "it sent no frames", "check the camera with marey doctor"};
  }
  constexpr double kMaxSilence_s = 1.0;
  constexpr double kMaxPeriods = 3.0;
  const double missing_s = seconds(end - *last_time_);
  if (missing_s <= std::max(kMaxSilence_s, kMaxPeriods / rate_of(settings_).hz)) {
    return std::nullopt;
  }
  return Error{Errc::kDevice,
               where,
               "no frames came from it in the last " +
                   std::to_string(static_cast<long>(missing_s)) + " s of the take",
               "check its plug and cable, and record again; the take has its frames "
               "until then"};
}

CameraSummary CameraRecorder::summary(Timestamp end) const {
  return {name_, frames_, dropped_ + unwritten_, unsaved_, trouble(end)};
}

}  // namespace marey::app
