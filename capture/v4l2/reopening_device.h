// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "capture/v4l2/v4l2_device.h"
#include "core/base/result.h"
#include "core/base/time.h"

// Part of the library marey::v4l2.
namespace marey::capture {

enum class CameraState {
  kStreaming,  ///< Frames arrive.
  kSilent,     ///< The camera is connected but delivers no frames.
  kLost,       ///< Unplugged, or failing: reconnection is attempted repeatedly.
};

/// Returns "streaming", "silent" or "lost".
[[nodiscard]] const char* name(CameraState state);

/// Connection status of a camera.
struct CameraStatus {
  CameraState state = CameraState::kStreaming;
  /// The reason if it is not streaming; for a lost camera, the error of the last attempt
  /// to open it.
  std::optional<Error> trouble;
  Timestamp since{0};       ///< Start of this state, CLOCK_MONOTONIC.
  int losses = 0;           ///< Number of times it was lost.
  int restarts = 0;         ///< Number of times it was opened again.
  long frames = 0;          ///< All returned frames, including damaged ones.
  long dropped_frames = 0;  ///< Sum of RawFrame::dropped_before; outages do not count.
  long damaged_frames = 0;
};

struct ReopeningOptions {
  /// A connected camera becomes silent after this time without a frame,
  std::chrono::milliseconds silent_after{1000};
  /// and is closed and opened again after this time.
  std::chrono::milliseconds restart_after{5000};
  /// Pause between two attempts to find a lost camera.
  std::chrono::milliseconds retry_every{500};
};

/// Keeps one camera connected: detects within a second that it was unplugged, and
/// reconnects within three seconds after it was plugged into the same port, under any
/// path.
///
/// Use one worker thread for each: a blocking device then blocks only its own worker.
/// Opening may take as long as the kernel needs (5 s for a USB device that does not
/// respond). The search for a lost camera opens every device of the machine in turn. No
/// frames of the outage are kept; sequence numbers restart, and `status().restarts`
/// distinguishes frames before from frames after.
class ReopeningDevice {
 public:
  /// Called on the worker's thread, inside next(), on each change of the state.
  using Listener = std::function<void(const CameraStatus&)>;

  /// Opens the camera for the first time. Errors as for V4l2Device::open(), so that a
  /// session does not start without one of its cameras. `kernel` must outlive the device.
  [[nodiscard]] static Result<ReopeningDevice> open(const DeviceRequest& request,
                                                    Listener listener = {},
                                                    const ReopeningOptions& options = {},
                                                    V4l2Kernel& kernel = system_kernel());

  /// Returns the next frame, or nullopt if none arrived within about `timeout`, for any
  /// reason: see status(). Never fails permanently. Use a timeout of about 100 ms, so
  /// that a worker can be stopped. The frame is valid until the next call.
  [[nodiscard]] std::optional<RawFrame> next(std::chrono::milliseconds timeout);

  [[nodiscard]] const CameraStatus& status() const { return status_; }
  /// From the last time that the device was opened. After a restart the settings may
  /// differ from before: see DeviceSettings::differences.
  [[nodiscard]] const DeviceInfo& info() const { return info_; }
  [[nodiscard]] const DeviceSettings& settings() const { return settings_; }

 private:
  ReopeningDevice(const DeviceRequest& request,
                  Listener listener,
                  const ReopeningOptions& options,
                  V4l2Kernel& kernel,
                  V4l2Device device);
  void change(CameraState state, std::optional<Error> trouble);
  void close();
  void mark_disconnected(const Error& error);
  void update_silence();
  void try_to_open();
  void count(const RawFrame& frame);

  V4l2Kernel* kernel_;
  DeviceRequest request_;
  ReopeningOptions options_;
  Listener listener_;
  std::optional<V4l2Device> device_;  ///< nullopt while closed.
  DeviceInfo info_;
  DeviceSettings settings_;
  CameraStatus status_;
  Timestamp last_frame_{0};    ///< Or the time of the opening.
  Timestamp next_attempt_{0};  ///< While closed.
};

}  // namespace marey::capture
