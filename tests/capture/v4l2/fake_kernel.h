// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <linux/videodev2.h>

#include "capture/v4l2/v4l2_kernel.h"

namespace marey::capture {

struct FakeFormat {
  struct Size {
    std::uint32_t width_px = 640;
    std::uint32_t height_px = 480;
    std::vector<std::uint32_t> rates_hz{30};
  };
  std::uint32_t fourcc = V4L2_PIX_FMT_YUYV;
  std::vector<Size> sizes{{}};
};

struct FakeControl {
  int minimum = 0;
  int maximum = 10000;
  int value = 0;
  bool stubborn = false;  ///< Accepts a value and keeps its own.
};

struct FakeFrame {
  std::uint32_t sequence = 0;
  std::uint32_t flags = 0;
  std::optional<std::uint32_t> bytes_used;  ///< nullopt: a whole image.
  std::optional<Timestamp> stamp;           ///< nullopt: the time of arrival.
  std::optional<std::int64_t> stamp_s;      ///< Replaces the whole seconds of the stamp.
  Timestamp wait = std::chrono::milliseconds(33);
  std::uint8_t first_bytes[2] = {0xFF, 0xD8};
};

struct FakeCamera {
  std::string path = "/dev/video0";
  std::string card = "Fake Cam";
  std::string bus = "usb-1.2";
  std::string driver = "fake";
  std::uint32_t can = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<FakeFormat> formats{{}};
  std::optional<std::uint32_t> always_gives;  ///< For any requested format.
  std::optional<v4l2_fract> always_every;     ///< For any requested rate.
  bool keeps_stride = false;                  ///< Does not report the length of a row.
  std::map<std::uint32_t, FakeControl> controls;
  std::uint32_t stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  bool plugged = true;
  /// The driver does not wake a waiting reader when its device is unplugged.
  bool leaves_silently = false;

  /// Frames to come. If none are left, the camera is silent.
  std::deque<FakeFrame> frames;
  v4l2_pix_format format{};
  v4l2_fract interval{1, 30};
  bool streaming = false;
  std::vector<std::vector<std::byte>> memory;
  std::deque<std::uint32_t> queued;
  std::optional<Timestamp> next_frame;
  int maps = 0;  ///< Present number.
};

/// A kernel of a few cameras whose time advances only in poll() and sleep(), and that
/// fails calls on request.
class FakeKernel final : public V4l2Kernel {
 public:
  std::vector<FakeCamera> cameras{1};
  Timestamp time = std::chrono::seconds(100);
  int open_files = 0;
  int opened = 0;  ///< In total.

  /// Makes the next `times` of these calls fail.
  void refuse(unsigned long request, int error, int times = 1);
  void refuse_to_open(int error, int times = 1) { refuse(0, error, times); }
  /// Events that a vivid or UVC device reports at the next poll(), in addition to frames.
  int events = 0;

  int open(const std::string& path) override;
  int close(int fd) override;
  int ioctl(int fd, unsigned long request, void* argument) override;
  int poll(int fd, std::chrono::milliseconds timeout) override;
  std::byte* map(int fd, std::size_t size, std::int64_t offset) override;
  void unmap(std::byte* memory, std::size_t size) override;
  std::vector<std::string> video_paths() override;
  Timestamp now() override { return time; }
  void sleep(std::chrono::milliseconds duration) override { time += duration; }

 private:
  FakeCamera* camera_of(int fd);
  int stream_ioctl(FakeCamera& camera, unsigned long request, void* argument);
  int take_frame(FakeCamera& camera, v4l2_buffer& buffer);

  std::map<unsigned long, std::pair<int, int>> refusals_;  ///< Error, times left.
  std::map<int, std::string> files_;
};

/// Returns `count` frames numbered from `first`, 33 ms apart.
[[nodiscard]] std::deque<FakeFrame> frames_from(std::uint32_t first, int count);

}  // namespace marey::capture
