// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/v4l2/fake_kernel.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <poll.h>

namespace marey::capture {
namespace {

template <std::size_t N>
void put_text(std::uint8_t (&field)[N], const std::string& text) {
  std::memcpy(field, text.data(), std::min(text.size(), N - 1));
}

int describe(const FakeCamera& camera, v4l2_capability& says) {
  put_text(says.card, camera.card);
  put_text(says.bus_info, camera.bus);
  put_text(says.driver, camera.driver);
  says.device_caps = camera.can;
  says.capabilities = camera.can | V4L2_CAP_DEVICE_CAPS | V4L2_CAP_META_CAPTURE;
  return 0;
}

const FakeFormat* find(const FakeCamera& camera, std::uint32_t fourcc) {
  const auto found = std::ranges::find(camera.formats, fourcc, &FakeFormat::fourcc);
  return found == camera.formats.end() ? nullptr : &*found;
}

int list_size(const FakeCamera& camera, v4l2_frmsizeenum& entry) {
  const FakeFormat* format = find(camera, entry.pixel_format);
  if (format == nullptr || entry.index >= format->sizes.size()) return -EINVAL;
  entry.type = V4L2_FRMSIZE_TYPE_DISCRETE;
  entry.discrete = {format->sizes[entry.index].width_px,
                    format->sizes[entry.index].height_px};
  return 0;
}

int list_rate(const FakeCamera& camera, v4l2_frmivalenum& entry) {
  const FakeFormat* format = find(camera, entry.pixel_format);
  if (format == nullptr) return -EINVAL;
  for (const FakeFormat::Size& size : format->sizes) {
    if (size.width_px != entry.width || size.height_px != entry.height) continue;
    if (entry.index >= size.rates_hz.size()) return -EINVAL;
    entry.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    entry.discrete = {1, size.rates_hz[entry.index]};
    return 0;
  }
  return -EINVAL;
}

/// Like real drivers: sets another format and the nearest size, and returns success.
int set_format(FakeCamera& camera, v4l2_pix_format& wanted) {
  const std::uint32_t code = camera.always_gives.value_or(wanted.pixelformat);
  const FakeFormat* format = find(camera, code);
  if (format == nullptr) format = &camera.formats.front();
  FakeFormat::Size size = format->sizes.front();
  for (const FakeFormat::Size& other : format->sizes) {
    if (other.width_px == wanted.width && other.height_px == wanted.height) size = other;
  }
  wanted.pixelformat = camera.always_gives.value_or(format->fourcc);
  wanted.width = size.width_px;
  wanted.height = size.height_px;
  wanted.bytesperline =
      wanted.pixelformat == V4L2_PIX_FMT_YUYV ? 2 * wanted.width : wanted.width;
  if (camera.keeps_stride) wanted.bytesperline = 0;
  wanted.sizeimage = 2 * wanted.width * wanted.height;
  camera.format = wanted;
  return 0;
}

int control_ioctl(FakeCamera& camera, unsigned long request, void* argument) {
  if (request == VIDIOC_QUERYCTRL) {
    auto& query = *static_cast<v4l2_queryctrl*>(argument);
    const auto control = camera.controls.find(query.id);
    if (control == camera.controls.end()) return -EINVAL;
    query.type = V4L2_CTRL_TYPE_INTEGER;
    query.minimum = control->second.minimum;
    query.maximum = control->second.maximum;
    return 0;
  }
  auto& wanted = *static_cast<v4l2_control*>(argument);
  const auto control = camera.controls.find(wanted.id);
  if (control == camera.controls.end()) return -EINVAL;
  if (request == VIDIOC_G_CTRL) {
    wanted.value = control->second.value;
  } else if (!control->second.stubborn) {
    control->second.value = wanted.value;
  }
  return 0;
}

}  // namespace

std::deque<FakeFrame> frames_from(std::uint32_t first, int count) {
  std::deque<FakeFrame> frames(static_cast<std::size_t>(count));
  for (FakeFrame& frame : frames) frame.sequence = first++;
  return frames;
}

void FakeKernel::refuse(unsigned long request, int error, int times) {
  refusals_[request] = {error, times};
}

FakeCamera* FakeKernel::camera_of(int fd) {
  const auto file = files_.find(fd);
  if (file == files_.end()) return nullptr;
  const auto camera = std::ranges::find(cameras, file->second, &FakeCamera::path);
  return camera == cameras.end() ? nullptr : &*camera;
}

std::vector<std::string> FakeKernel::video_paths() {
  std::vector<std::string> paths;
  for (const FakeCamera& camera : cameras) {
    if (camera.plugged) paths.push_back(camera.path);
  }
  return paths;
}

int FakeKernel::open(const std::string& path) {
  auto& [error, times] = refusals_[0];
  if (times > 0) {
    --times;
    return -error;
  }
  const auto camera = std::ranges::find(cameras, path, &FakeCamera::path);
  if (camera == cameras.end() || !camera->plugged) return -ENOENT;
  ++open_files;
  files_[++opened] = path;
  return opened;
}

int FakeKernel::close(int fd) {
  --open_files;
  return files_.erase(fd) == 1 ? 0 : -EBADF;
}

int FakeKernel::ioctl(int fd, unsigned long request, void* argument) {
  auto& [error, times] = refusals_[request];
  if (times > 0) {
    --times;
    return -error;
  }
  FakeCamera* camera = camera_of(fd);
  if (camera == nullptr || !camera->plugged) return -ENODEV;
  switch (request) {
    case VIDIOC_QUERYCAP:
      return describe(*camera, *static_cast<v4l2_capability*>(argument));
    case VIDIOC_ENUM_FMT: {
      auto& entry = *static_cast<v4l2_fmtdesc*>(argument);
      if (entry.index >= camera->formats.size()) return -EINVAL;
      entry.pixelformat = camera->formats[entry.index].fourcc;
      return 0;
    }
    case VIDIOC_ENUM_FRAMESIZES:
      return list_size(*camera, *static_cast<v4l2_frmsizeenum*>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return list_rate(*camera, *static_cast<v4l2_frmivalenum*>(argument));
    case VIDIOC_S_FMT:
      return set_format(*camera, static_cast<v4l2_format*>(argument)->fmt.pix);
    case VIDIOC_G_FMT:
      static_cast<v4l2_format*>(argument)->fmt.pix = camera->format;
      return 0;
    case VIDIOC_S_PARM:
      camera->interval = camera->always_every.value_or(
          static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe);
      return 0;
    case VIDIOC_G_PARM:
      static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe =
          camera->interval;
      return 0;
    case VIDIOC_QUERYCTRL:
    case VIDIOC_G_CTRL:
    case VIDIOC_S_CTRL:
      return control_ioctl(*camera, request, argument);
    default:
      return stream_ioctl(*camera, request, argument);
  }
}

int FakeKernel::stream_ioctl(FakeCamera& camera, unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_REQBUFS: {
      const auto& wanted = *static_cast<v4l2_requestbuffers*>(argument);
      camera.memory.assign(wanted.count, std::vector<std::byte>(camera.format.sizeimage));
      camera.queued.clear();
      return 0;
    }
    case VIDIOC_QUERYBUF: {
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      buffer.length = camera.format.sizeimage;
      buffer.m.offset = buffer.index;
      buffer.flags = camera.stamp_flags;
      return 0;
    }
    case VIDIOC_QBUF:
      camera.queued.push_back(static_cast<v4l2_buffer*>(argument)->index);
      return 0;
    case VIDIOC_STREAMON:
      camera.streaming = true;
      camera.next_frame.reset();
      return 0;
    case VIDIOC_STREAMOFF:
      camera.streaming = false;
      return 0;
    case VIDIOC_DQBUF:
      return take_frame(camera, *static_cast<v4l2_buffer*>(argument));
    default:
      return -ENOTTY;
  }
}

int FakeKernel::take_frame(FakeCamera& camera, v4l2_buffer& buffer) {
  if (camera.frames.empty() || camera.queued.empty()) return -EAGAIN;
  if (!camera.next_frame || time < *camera.next_frame) return -EAGAIN;
  const FakeFrame frame = camera.frames.front();
  camera.frames.pop_front();
  camera.next_frame.reset();
  buffer.index = camera.queued.front();
  camera.queued.pop_front();
  std::vector<std::byte>& memory = camera.memory[buffer.index];
  std::memcpy(memory.data(), frame.first_bytes, 2);
  buffer.bytesused = frame.bytes_used.value_or(camera.format.sizeimage);
  buffer.sequence = frame.sequence;
  buffer.flags = camera.stamp_flags | frame.flags;
  const auto stamp =
      std::chrono::duration_cast<std::chrono::microseconds>(frame.stamp.value_or(time));
  buffer.timestamp.tv_sec = frame.stamp_s.value_or(stamp.count() / 1'000'000);
  buffer.timestamp.tv_usec = stamp.count() % 1'000'000;
  return 0;
}

int FakeKernel::poll(int fd, std::chrono::milliseconds timeout) {
  FakeCamera* camera = camera_of(fd);
  const Timestamp deadline = time + timeout;
  if (camera == nullptr || !camera->plugged) {
    if (camera == nullptr || !camera->leaves_silently) return POLLERR | POLLHUP;
    time = deadline;
    return 0;
  }
  if (events != 0) return events;
  if (camera->frames.empty() || camera->queued.empty()) {
    time = deadline;
    return 0;
  }
  if (!camera->next_frame) camera->next_frame = time + camera->frames.front().wait;
  time = std::max(time, std::min(deadline, *camera->next_frame));
  return time >= *camera->next_frame ? POLLIN : 0;
}

std::byte* FakeKernel::map(int fd, std::size_t, std::int64_t offset) {
  FakeCamera* camera = camera_of(fd);
  if (camera == nullptr) return nullptr;
  ++camera->maps;
  return camera->memory[static_cast<std::size_t>(offset)].data();
}

void FakeKernel::unmap(std::byte* memory, std::size_t) {
  for (FakeCamera& camera : cameras) {
    for (const auto& own : camera.memory) camera.maps -= own.data() == memory ? 1 : 0;
  }
}

}  // namespace marey::capture
