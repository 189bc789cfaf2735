// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_stream.h"

#include <algorithm>
#include <cerrno>
#include <limits>
#include <utility>

#include <linux/videodev2.h>

namespace marey::capture {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr auto kVideoCapture = static_cast<std::uint32_t>(V4L2_BUF_TYPE_VIDEO_CAPTURE);
constexpr auto kMapped = static_cast<std::uint32_t>(V4L2_MEMORY_MMAP);

/// Time stamps further from the present are not CLOCK_MONOTONIC. Only a handful of
/// buffers wait for the reader, and drivers that stamp a frame's end are ahead by a
/// frame.
constexpr seconds kOldestStamp{10};
constexpr seconds kNewestStamp{1};

/// While a refused buffer, or a failing device, may still recover.
constexpr milliseconds kRetryPause{5};

v4l2_buffer empty_buffer(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = kVideoCapture;
  buffer.memory = kMapped;
  return buffer;
}

bool begins_as_jpeg(std::span<const std::byte> bytes) {
  return bytes.size() >= 2 && bytes[0] == std::byte{0xFF} && bytes[1] == std::byte{0xD8};
}

std::size_t whole_picture(const DeviceSettings& settings) {
  const auto rows = static_cast<std::size_t>(settings.height_px);
  const auto width = static_cast<std::size_t>(settings.width_px);
  switch (settings.format) {
    case PixelFormat::kMjpg:
      return 2;
    case PixelFormat::kYuyv:
      return 2 * width * rows;
    case PixelFormat::kNv12:
    case PixelFormat::kGrey:
      return width * rows;  // For NV12 only the luma is read.
  }
  return 1;
}

}  // namespace

int frames_between(std::uint32_t before, std::uint32_t after) {
  const std::uint32_t steps = after - before;
  constexpr std::uint32_t kHalf = 1U << 31U;
  return steps == 0 || steps >= kHalf ? 0 : static_cast<int>(steps - 1);
}

V4l2Stream::V4l2Stream(V4l2Kernel& kernel,
                       int fd,
                       std::string path,
                       const DeviceSettings& settings)
    : kernel_(&kernel),
      fd_(fd),
      path_(std::move(path)),
      format_(settings.format),
      min_bytes_(whole_picture(settings)) {}

V4l2Stream::V4l2Stream(V4l2Stream&& other) noexcept
    : kernel_(other.kernel_),
      fd_(other.fd_),
      path_(std::move(other.path_)),
      format_(other.format_),
      min_bytes_(other.min_bytes_),
      buffers_(std::exchange(other.buffers_, {})),
      started_(other.started_),
      stale_to_skip_(other.stale_to_skip_),
      last_sequence_(other.last_sequence_),
      monotonic_clock_(other.monotonic_clock_),
      streaming_(std::exchange(other.streaming_, false)) {}

V4l2Stream::~V4l2Stream() {
  auto type = static_cast<int>(kVideoCapture);
  if (streaming_) kernel_->ioctl(fd_, VIDIOC_STREAMOFF, &type);
  for (const Buffer& buffer : buffers_) {
    kernel_->unmap(buffer.memory.data(), buffer.memory.size());
  }
}

Error V4l2Stream::error(V4l2Step step, int refused) const {
  return device_error(path_, step, -refused);
}

Result<V4l2Stream> V4l2Stream::start(V4l2Kernel& kernel,
                                     int fd,
                                     const std::string& path,
                                     const DeviceSettings& settings,
                                     int buffers) {
  V4l2Stream stream(kernel, fd, path, settings);
  if (auto mapped = stream.map_buffers(buffers); !mapped) return mapped.error();
  if (const int refused = stream.queue_buffers(); refused < 0) {
    return stream.error(V4l2Step::kQueueBuffer, refused);
  }
  stream.started_ = kernel.now();
  auto type = static_cast<int>(kVideoCapture);
  if (const int refused = kernel.ioctl(fd, VIDIOC_STREAMON, &type); refused < 0) {
    return stream.error(V4l2Step::kStart, refused);
  }
  stream.streaming_ = true;
  stream.stale_to_skip_ = stream.buffers();
  return stream;
}

Status V4l2Stream::map_buffers(int count) {
  v4l2_requestbuffers wanted{};
  wanted.count = static_cast<std::uint32_t>(count);
  wanted.type = kVideoCapture;
  wanted.memory = kMapped;
  if (const int refused = kernel_->ioctl(fd_, VIDIOC_REQBUFS, &wanted); refused < 0) {
    return error(V4l2Step::kRequestBuffers, refused);
  }
  if (wanted.count == 0) return error(V4l2Step::kRequestBuffers, -ENOMEM);
  for (std::uint32_t i = 0; i < wanted.count; ++i) {
    v4l2_buffer buffer = empty_buffer(i);
    if (const int refused = kernel_->ioctl(fd_, VIDIOC_QUERYBUF, &buffer); refused < 0) {
      return error(V4l2Step::kMapBuffer, refused);
    }
    std::byte* memory = kernel_->map(fd_, buffer.length, buffer.m.offset);
    if (memory == nullptr) return error(V4l2Step::kMapBuffer, -ENOMEM);
    buffers_.push_back({{memory, buffer.length}, false});
    monotonic_clock_ = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) ==
                       V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  }
  return Done{};
}

int V4l2Stream::queue_buffers() {
  int refusal = 0;
  for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
    if (buffers_[i].queued) continue;
    v4l2_buffer buffer = empty_buffer(i);
    const int result = kernel_->ioctl(fd_, VIDIOC_QBUF, &buffer);
    buffers_[i].queued = result == 0;
    if (result < 0) refusal = result;
  }
  return refusal;
}

Result<std::optional<RawFrame>> V4l2Stream::next(milliseconds timeout) {
  const Timestamp deadline = kernel_->now() + timeout;
  while (true) {
    const int refused = queue_buffers();
    if (is_disconnect_errno(-refused)) return error(V4l2Step::kQueueBuffer, refused);
    const bool some = std::ranges::any_of(buffers_, &Buffer::queued);
    const auto left = std::max(std::chrono::ceil<milliseconds>(deadline - kernel_->now()),
                               milliseconds{0});
    const int events = some ? kernel_->poll(fd_, left) : refused;
    if (events < 0 && events != -EINTR && some) {
      return error(V4l2Step::kTakeFrame, events);
    }
    if (events > 0) {
      auto frame = take();
      if (!frame || *frame) return frame;
    }
    if (kernel_->now() >= deadline) {
      if (!some) return error(V4l2Step::kQueueBuffer, refused);
      // Some drivers deliver no error when their device is unplugged.
      v4l2_capability capabilities{};
      const int alive = kernel_->ioctl(fd_, VIDIOC_QUERYCAP, &capabilities);
      if (is_disconnect_errno(-alive)) return error(V4l2Step::kTakeFrame, alive);
      return std::optional<RawFrame>();
    }
    if (events != 0) kernel_->sleep(std::min(kRetryPause, left));
  }
}

Result<std::optional<RawFrame>> V4l2Stream::take() {
  v4l2_buffer buffer = empty_buffer(0);
  const int result = kernel_->ioctl(fd_, VIDIOC_DQBUF, &buffer);
  if (result == -EAGAIN) return std::optional<RawFrame>();
  if (result < 0) return error(V4l2Step::kTakeFrame, result);
  if (buffer.index >= buffers_.size()) return error(V4l2Step::kTakeFrame, -EPROTO);
  buffers_[buffer.index].queued = false;
  RawFrame frame = frame_in(buffer);
  if (stale_to_skip_ > 0 && is_stale(frame)) {
    --stale_to_skip_;
    return std::optional<RawFrame>();
  }
  stale_to_skip_ = 0;
  if (last_sequence_) {
    frame.dropped_before = frames_between(*last_sequence_, frame.sequence);
  }
  last_sequence_ = frame.sequence;
  return std::optional(frame);
}

RawFrame V4l2Stream::frame_in(const v4l2_buffer& buffer) {
  const std::span<std::byte> memory = buffers_[buffer.index].memory;
  RawFrame frame;
  frame.bytes = memory.first(std::min<std::size_t>(buffer.bytesused, memory.size()));
  frame.sequence = buffer.sequence;
  frame.damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0 ||
                  frame.bytes.size() < min_bytes_ ||
                  (format_ == PixelFormat::kMjpg && !begins_as_jpeg(frame.bytes));
  const Timestamp now = kernel_->now();
  // An invalid time stamp may also be too large for a conversion to nanoseconds.
  const std::int64_t now_s = std::chrono::floor<seconds>(now).count();
  const std::int64_t whole_s = buffer.timestamp.tv_sec;
  const std::int64_t part_us = buffer.timestamp.tv_usec;
  const bool is_near = whole_s >= now_s - kOldestStamp.count() - 1 &&
                       whole_s <= now_s + kNewestStamp.count() + 1 && part_us >= 0 &&
                       part_us < 1'000'000;
  const Timestamp stamp =
      is_near ? Timestamp(seconds{whole_s} + std::chrono::microseconds{part_us}) : now;
  frame.time_is_arrival =
      !is_near || stamp < now - kOldestStamp || stamp > now + kNewestStamp;
  frame.time = frame.time_is_arrival ? now : stamp;
  return frame;
}

/// v4l2loopback first delivers a buffer that was never written. It is marked as full, and
/// its time stamp and sequence number are from its allocation. Cameras begin with
/// incomplete images.
bool V4l2Stream::is_stale(const RawFrame& frame) const {
  const bool before = !frame.time_is_arrival && frame.time < started_;
  return before || frame.bytes.empty() ||
         (format_ == PixelFormat::kMjpg && !begins_as_jpeg(frame.bytes));
}

}  // namespace marey::capture
