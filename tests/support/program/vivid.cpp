// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/program/vivid.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <utility>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace marey::guest {

bool set_vivid(const std::string& device, const std::string& control, int value) {
  const int fd = ::open(device.c_str(), O_RDWR | O_NONBLOCK);
  if (fd < 0) return false;
  bool set = false;
  v4l2_queryctrl query{};
  query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (!set && ::ioctl(fd, VIDIOC_QUERYCTRL, &query) == 0) {
    if (control == reinterpret_cast<const char*>(query.name)) {
      v4l2_control wanted{query.id, value};
      set = ::ioctl(fd, VIDIOC_S_CTRL, &wanted) == 0;
    }
    query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  ::close(fd);
  return set;
}

bool write_file(const std::string& path, const std::string& text) {
  return (std::ofstream(path) << text).flush().good();
}

std::vector<std::byte> read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::byte> bytes(text.size());
  std::ranges::transform(
      text, bytes.begin(), [](char c) { return static_cast<std::byte>(c); });
  return bytes;
}

LoopbackFeeder::LoopbackFeeder(std::string device,
                               std::vector<std::vector<std::byte>> pictures)
    : pictures_(std::move(pictures)) {
  fd_ = ::open(device.c_str(), O_RDWR);
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = 320;
  format.fmt.pix.height = 180;
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_MJPEG;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.sizeimage = 2 * 320 * 180;
  if (fd_ >= 0 && ::ioctl(fd_, VIDIOC_S_FMT, &format) < 0) {
    ::close(std::exchange(fd_, -1));
  }
  if (works()) thread_ = std::thread([this] { feed(); });
}

LoopbackFeeder::~LoopbackFeeder() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  if (fd_ >= 0) ::close(fd_);
}

void LoopbackFeeder::feed() {
  auto due = std::chrono::steady_clock::now();
  for (std::size_t i = 0; !stop_; i = (i + 1) % pictures_.size()) {
    const auto& picture = pictures_[i];
    if (::write(fd_, picture.data(), picture.size()) < 0) return;
    due += std::chrono::nanoseconds(33'333'333);
    std::this_thread::sleep_until(due);
  }
}

}  // namespace marey::guest
