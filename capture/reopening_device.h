// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "capture/v4l2_device.h"
#include "core/result.h"
#include "core/time.h"

// Of the library marey::v4l2.
namespace marey::capture {

enum class CameraState {
  kStreaming,  ///< Frames come.
  kSilent,     ///< The camera is there, and no frame comes.
  kLost,       ///< Unplugged, or failing: it is looked for again and again.
};

/// "streaming", "silent", "lost".
[[nodiscard]] const char* name(CameraState state);

/// How a camera fares, as a session should tell and report it.
struct CameraStatus {
  CameraState state = CameraState::kStreaming;
  /// Why, when not streaming; of a lost camera what its last opening said.
  std::optional<Error> trouble;
  Timestamp since{0};       ///< When this state began, CLOCK_MONOTONIC.
  int losses = 0;           ///< Times that it was lost.
  int restarts = 0;         ///< Times that it was opened again.
  long frames = 0;          ///< All that were handed out, damaged ones too.
  long dropped_frames = 0;  ///< Sum of RawFrame::dropped_before: outages do not count.
  long damaged_frames = 0;
};

struct ReopeningOptions {
  /// A camera that is there is called silent after so long without a frame,
  std::chrono::milliseconds silent_after{1000};
  /// and is closed and opened again after so long.
  std::chrono::milliseconds restart_after{5000};
  /// Pause between two attempts to find a lost camera.
  std::chrono::milliseconds retry_every{500};
};

/// Keeps one camera alive: notices within a second that it was unplugged, and has it back
/// within three after it was plugged into the same port, whatever path it has then.
///
/// One worker thread for each: a sick device blocks its own worker, never one whose
/// camera streams. Opening may take as long as the kernel needs (a USB device that does
/// not answer: 5 s), and who looks for a lost camera opens every device of the machine in
/// turn. Nothing is kept of the time between; sequence numbers begin anew,
/// and `status().restarts` tells frames before from those after.
class ReopeningDevice {
 public:
  /// Called on the worker's thread, out of next(), whenever the state changes.
  using Listener = std::function<void(const CameraStatus&)>;

  /// Opens the camera for the first time. Errors as V4l2Device::open(): a session should
  /// not begin without one of its cameras. `kernel` must outlive the device.
  [[nodiscard]] static Result<ReopeningDevice> open(const DeviceRequest& request,
                                                    Listener listener = {},
                                                    const ReopeningOptions& options = {},
                                                    V4l2Kernel& kernel = system_kernel());

  /// The next frame, or nullopt when none came within about `timeout`, whatever the
  /// reason: see status(). Never fails for good. Give it some 100 ms, so that a worker
  /// can be stopped. The frame is valid until the next call.
  [[nodiscard]] std::optional<RawFrame> next(std::chrono::milliseconds timeout);

  [[nodiscard]] const CameraStatus& status() const { return status_; }
  /// Of the last time that it was opened. After a restart the camera may do otherwise
  /// than before: see DeviceSettings::differences.
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
  void be_lost(const Error& error);
  void listen_to_silence();
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
  Timestamp last_frame_{0};    ///< Or when it was opened.
  Timestamp next_attempt_{0};  ///< While closed.
};

}  // namespace marey::capture
