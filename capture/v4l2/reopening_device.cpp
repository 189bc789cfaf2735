// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/reopening_device.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "capture/v4l2/v4l2_errors.h"
#include "capture/v4l2/v4l2_kernel.h"

namespace marey::capture {
namespace {

using std::chrono::milliseconds;

/// Limits the wait, so that a loss is detected within a second for any timeout.
constexpr milliseconds kMaxReopenWait{500};

}  // namespace

const char* name(CameraState state) {
  switch (state) {
    case CameraState::kStreaming:
      return "streaming";
    case CameraState::kSilent:
      return "silent";
    case CameraState::kLost:
      return "lost";
  }
  return "?";
}

Result<ReopeningDevice> ReopeningDevice::open(const DeviceRequest& request,
                                              Listener listener,
                                              const ReopeningOptions& options,
                                              V4l2Kernel& kernel) {
  auto device = V4l2Device::open(request, kernel);
  if (!device) return device.error();
  return ReopeningDevice(
      request, std::move(listener), options, kernel, *std::move(device));
}

ReopeningDevice::ReopeningDevice(const DeviceRequest& request,
                                 Listener listener,
                                 const ReopeningOptions& options,
                                 V4l2Kernel& kernel,
                                 V4l2Device device)
    : kernel_(&kernel),
      request_(request),
      options_(options),
      listener_(std::move(listener)),
      device_(std::move(device)),
      info_(device_->info()),
      settings_(device_->settings()) {
  last_frame_ = kernel.now();
  status_.since = last_frame_;
}

void ReopeningDevice::change(CameraState state, std::optional<Error> trouble) {
  status_.trouble = std::move(trouble);
  if (status_.state == state) return;
  status_.state = state;
  status_.since = kernel_->now();
  if (listener_) listener_(status_);
}

void ReopeningDevice::close() {
  device_.reset();  // The kernel releases a device only when its last user closes it.
  next_attempt_ = std::max(next_attempt_, kernel_->now());
}

void ReopeningDevice::mark_disconnected(const Error& error) {
  if (status_.state != CameraState::kLost) ++status_.losses;
  change(CameraState::kLost, error);
}

void ReopeningDevice::update_silence() {
  const Timestamp silence = kernel_->now() - last_frame_;
  if (silence < options_.silent_after) return;
  change(
      CameraState::kSilent,
      Error{Errc::kDevice,
            request_.path,
            "the camera is there and sends no frames",
            "wait: it is opened again every few seconds; if that does not help, unplug "
            "it and plug it into the same port again"});
  if (silence >= options_.restart_after) close();
}

void ReopeningDevice::try_to_open() {
  next_attempt_ = kernel_->now() + options_.retry_every;
  const auto path = find_again(info_, *kernel_);
  if (!path) {
    mark_disconnected(device_error(request_.path, V4l2Step::kTakeFrame, ENODEV));
    return;
  }
  DeviceRequest request = request_;
  request.path = *path;
  auto device = V4l2Device::open(request, *kernel_);
  if (!device) {
    mark_disconnected(device.error());
    return;
  }
  device_.emplace(*std::move(device));
  info_ = device_->info();
  settings_ = device_->settings();
  last_frame_ = kernel_->now();
  ++status_.restarts;
}

void ReopeningDevice::count(const RawFrame& frame) {
  last_frame_ = kernel_->now();
  ++status_.frames;
  status_.dropped_frames += frame.dropped_before;
  status_.damaged_frames += frame.damaged ? 1 : 0;
  change(CameraState::kStreaming, std::nullopt);
}

std::optional<RawFrame> ReopeningDevice::next(milliseconds timeout) {
  const Timestamp deadline = kernel_->now() + timeout;
  while (true) {
    if (!device_ && kernel_->now() >= next_attempt_) try_to_open();
    const Timestamp until = device_ ? deadline : std::min(deadline, next_attempt_);
    const auto left = std::clamp(
        std::chrono::ceil<milliseconds>(until - kernel_->now()), {}, kMaxReopenWait);
    if (device_) {
      auto frame = device_->next(left);
      if (!frame) {
        close();
        mark_disconnected(frame.error());
      } else if (*frame) {
        count(**frame);
        return *frame;
      } else {
        update_silence();
      }
    } else {
      kernel_->sleep(left);
    }
    if (kernel_->now() >= deadline) return std::nullopt;
  }
}

}  // namespace marey::capture
